// Bytes at positions of a file, with errors for people.

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace craze::io {

/// An open file. read_at and write_at may be called from several threads.
class RawFile {
public:
    enum class Mode {
        read,
        create,
        update
    };  ///< create: empty it first; update: keep what is there, make it if absent

    RawFile() = default;
    /// @throws InvalidInput  naming the file and the reason
    RawFile(const std::filesystem::path& file, Mode mode);
    ~RawFile();
    RawFile(RawFile&& other) noexcept;
    RawFile& operator=(RawFile&& other) noexcept;

    const std::filesystem::path& path() const { return path_; }
    std::int64_t size() const;
    /// @throws InvalidInput  when the file ends before, or the disk fails
    void read_at(std::int64_t offset, std::span<std::byte> to) const;
    /// @throws InvalidInput  when the disk is full or fails
    void write_at(std::int64_t offset, std::span<const std::byte> from);
    /// What was written is on the disk when this returns.
    void sync();
    void close();

private:
    std::filesystem::path path_;
    int handle_ = -1;
};

}  // namespace craze::io
