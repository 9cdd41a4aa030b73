// Single pictures as PNG, gray or in colour.

#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace craze::io {

/// 8-bit pixels, row after row from the top, channels interleaved.
struct Picture {
    std::int64_t width = 0, height = 0;
    std::int64_t channels = 1;  ///< 1 gray, 3 red, green, blue
    std::vector<std::uint8_t> pixels;

    Picture() = default;
    Picture(std::int64_t w, std::int64_t h, std::int64_t c = 1, std::uint8_t value = 0)
        : width(w), height(h), channels(c), pixels(static_cast<std::size_t>(w * h * c), value)
    {
    }
    std::uint8_t* at(std::int64_t x, std::int64_t y)
    {
        return &pixels[static_cast<std::size_t>((x + width * y) * channels)];
    }
    const std::uint8_t* at(std::int64_t x, std::int64_t y) const
    {
        return &pixels[static_cast<std::size_t>((x + width * y) * channels)];
    }
};

/// The bytes of a PNG file, for a page that carries its pictures.
std::string png_bytes(const Picture& picture);
/// @throws InvalidInput  when it cannot be written
void write_png(const std::filesystem::path& file, const Picture& picture);
/// One 8-bit gray slice, width x height, row after row.
void write_png(const std::filesystem::path& file, std::int64_t width, std::int64_t height,
               std::span<const std::uint8_t> gray);
/// An 8-bit PNG as it is: gray or colour.
/// @throws InvalidInput  naming the file
Picture read_png(const std::filesystem::path& file);

}  // namespace craze::io
