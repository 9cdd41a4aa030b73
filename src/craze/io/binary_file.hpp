// A file written in large pieces: failures are noticed once, at close().

#pragma once

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>
#include <vector>

namespace craze::io {

static_assert(std::endian::native == std::endian::little, "binary formats are written as they lie in memory");

class BinaryFile {
public:
    explicit BinaryFile(const std::filesystem::path& file) : file_(file), out_(file, std::ios::binary)
    {
        buffer_.reserve(capacity + 256);
    }

    template <class T>
    void put(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes(&value, sizeof value);
    }
    template <class T>
    void put(std::span<const T> values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes(values.data(), values.size_bytes());
    }
    void text(std::string_view characters) { bytes(characters.data(), characters.size()); }

    /// @throws InvalidInput  when anything could not be written
    void close()
    {
        flush();
        out_.close();
        if (!out_)
            throw InvalidInput(
                fmt::format("{}: cannot be written; is the disk full or the folder read-only?", file_.string()));
    }

private:
    static constexpr std::size_t capacity = std::size_t{1} << 20U;

    void bytes(const void* data, std::size_t size)
    {
        if (size == 0) return;
        if (buffer_.size() + size > capacity) flush();
        if (size > capacity) {
            out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
            return;
        }
        const std::size_t old = buffer_.size();
        buffer_.resize(old + size);
        std::memcpy(buffer_.data() + old, data, size);
    }
    void flush()
    {
        out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        buffer_.clear();
    }

    std::filesystem::path file_;
    std::ofstream out_;
    std::vector<char> buffer_;
};

}  // namespace craze::io
