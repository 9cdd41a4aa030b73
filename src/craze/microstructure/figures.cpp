#include "craze/microstructure/figures.hpp"

#include "craze/io/volume_file.hpp"
#include "craze/microstructure/threshold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace craze::microstructure {

namespace {

using io::Picture;

// Mean over blocks of factor x factor pixels.
Picture shrunk(const Picture& from, std::int64_t most)
{
    const std::int64_t factor = (from.width + most - 1) / most;
    if (factor <= 1) return from;
    Picture to(from.width / factor, std::max<std::int64_t>(1, from.height / factor), from.channels);
    for (std::int64_t y = 0; y < to.height; ++y)
        for (std::int64_t x = 0; x < to.width; ++x)
            for (std::int64_t c = 0; c < to.channels; ++c) {
                std::int64_t sum = 0, n = 0;
                for (std::int64_t j = y * factor; j < std::min(from.height, (y + 1) * factor); ++j)
                    for (std::int64_t i = x * factor; i < (x + 1) * factor; ++i, ++n) sum += from.at(i, j)[c];
                to.at(x, y)[c] = static_cast<std::uint8_t>(sum / n);
            }
    return to;
}

// Letters of 3 x 5 dots, rows from the top, three bits each.
constexpr std::string_view letters = "0123456789.RCEMOTSNAPUYDG=KF";
constexpr std::array<std::uint16_t, 28> glyphs{
    0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111, 0b101'101'111'001'001,
    0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'010'010'010, 0b111'101'111'101'111, 0b111'101'111'001'111,
    0b000'000'000'000'010, 0b110'101'110'101'101, 0b011'100'100'100'011, 0b111'100'110'100'111, 0b101'111'111'101'101,
    0b010'101'101'101'010, 0b111'010'010'010'010, 0b011'100'010'001'110, 0b110'101'101'101'101, 0b010'101'111'101'101,
    0b110'101'110'100'100, 0b101'101'101'101'111, 0b101'101'010'010'010, 0b110'101'101'101'110, 0b011'100'101'101'011,
    0b000'111'000'111'000, 0b101'101'110'101'101, 0b111'100'110'100'100};

void write_word(Picture& picture, std::int64_t x, std::int64_t y, std::string_view word)
{
    constexpr std::int64_t scale = 3;
    for (const char c : word) {
        const auto which = letters.find(c);
        if (which != std::string_view::npos)
            for (std::int64_t j = 0; j < 5 * scale; ++j)
                for (std::int64_t i = 0; i < 3 * scale; ++i) {
                    const auto bit = static_cast<unsigned>(14 - 3 * (j / scale) - i / scale);
                    if (((glyphs[which] >> bit) & 1U) == 0 || x + i >= picture.width) continue;
                    std::fill_n(picture.at(x + i, y + j), picture.channels, std::uint8_t{0});
                }
        x += 4 * scale;
    }
}

std::array<std::int64_t, 3> slices_of(const Shape& s) { return {s.nz / 9, (s.nz * 5) / 18, (s.nz * 25) / 36}; }

}  // namespace

Picture phases_over_gray(const Volume<std::uint8_t>& gray, const Mask& pore, const Mask& crack, std::int64_t z,
                         std::int64_t most)
{
    const Shape& s = gray.shape();
    Picture picture(s.nx, s.ny, 3);
    for (std::int64_t y = 0; y < s.ny; ++y)
        for (std::int64_t x = 0; x < s.nx; ++x) {
            const std::uint8_t g = gray(x, y, z);
            const auto half = static_cast<std::uint8_t>(g / 2);
            const std::array<std::uint8_t, 3> colour = pore(x, y, z)    ? std::array<std::uint8_t, 3>{half, half, 255}
                                                       : crack(x, y, z) ? std::array<std::uint8_t, 3>{255, half, half}
                                                                        : std::array<std::uint8_t, 3>{g, g, g};
            std::copy(colour.begin(), colour.end(), picture.at(x, y));
        }
    return shrunk(picture, most);
}

Picture binary_slice(const Mask& matter, std::int64_t z, std::int64_t most)
{
    const Shape& s = matter.shape();
    Picture picture(s.nx, s.ny);
    for (std::int64_t y = 0; y < s.ny; ++y)
        for (std::int64_t x = 0; x < s.nx; ++x) *picture.at(x, y) = matter(x, y, z) ? 255 : 0;
    return shrunk(picture, most);
}

Picture gray_slice(const Volume<std::uint8_t>& gray, std::int64_t z, std::int64_t most)
{
    Picture picture(gray.shape().nx, gray.shape().ny);
    const auto slice = gray.slice(z);
    std::copy(slice.begin(), slice.end(), picture.pixels.begin());
    return shrunk(picture, most);
}

Picture montage(const std::vector<Tile>& tiles, std::int64_t columns)
{
    constexpr std::int64_t gap = 6, line = 22;
    std::int64_t width = 0, height = 0;
    for (const Tile& tile : tiles) {
        width = std::max(width, tile.picture.width);
        height = std::max(height, tile.picture.height);
    }
    const auto n = static_cast<std::int64_t>(tiles.size());
    const std::int64_t rows = (n + columns - 1) / columns;
    Picture all(columns * (width + gap) + gap, rows * (height + line + gap) + gap, 3, 255);
    for (std::int64_t k = 0; k < n; ++k) {
        const Tile& tile = tiles[static_cast<std::size_t>(k)];
        const std::int64_t x0 = gap + (k % columns) * (width + gap),
                           y0 = gap + line + (k / columns) * (height + line + gap);
        if (tile.framed)
            for (std::int64_t y = y0 - 4; y < y0 + tile.picture.height + 4; ++y)
                for (std::int64_t x = x0 - 4; x < x0 + tile.picture.width + 4; ++x) {
                    const std::array<std::uint8_t, 3> green{0, 160, 0};
                    std::copy(green.begin(), green.end(), all.at(x, y));
                }
        for (std::int64_t y = 0; y < tile.picture.height; ++y)
            for (std::int64_t x = 0; x < tile.picture.width; ++x)
                for (std::int64_t c = 0; c < 3; ++c)
                    all.at(x0 + x, y0 + y)[c] = tile.picture.at(x, y)[tile.picture.channels == 3 ? c : 0];
        write_word(all, x0, y0 - line + 1, tile.word);
    }
    return all;
}

void save_figures(const Microstructure& micro, const std::filesystem::path& folder)
{
    const auto& gray = micro.gray.level;
    const Histogram levels = histogram(gray);
    std::vector<Tile> thresholds, phases;
    for (const std::int64_t z : slices_of(gray.shape())) {
        thresholds.push_back({gray_slice(gray, z), "GRAY"});
        for (const auto& [name, S] : {std::pair{"OTSU", otsu_threshold(levels)},
                                      {"MOMENTS", moments_threshold(levels)},
                                      {"ENTROPY", entropy_threshold(levels)}}) {
            if (!S) continue;
            Picture binary = gray_slice(gray, z, gray.shape().nx);
            for (auto& g : binary.pixels) g = g < *S ? 0 : 255;
            thresholds.push_back({shrunk(binary, 480), fmt::format("{} S={}", name, *S), *S == micro.threshold});
        }
        phases.push_back({gray_slice(gray, z), "GRAY"});
        phases.push_back({binary_slice(micro.matter, z), fmt::format("S={}", micro.threshold)});
        phases.push_back({phases_over_gray(gray, micro.pore, micro.crack, z), "PORES AND CRACKS"});
    }
    io::write_png(folder / "thresholds.png", montage(thresholds, static_cast<std::int64_t>(thresholds.size() / 3)));
    io::write_png(folder / "phases.png", montage(phases, 3));
}

namespace {

template <class Number>
void save_labels(const Components& found, double h, const std::filesystem::path& file)
{
    Volume<Number> label(found.shape, Number{0});
    for (std::int64_t r = 0; r < found.shape.ny * found.shape.nz; ++r) {
        const auto row = label.row(r % found.shape.ny, r / found.shape.ny);
        for (auto i = found.row_begin[static_cast<std::size_t>(r)];
             i < found.row_begin[static_cast<std::size_t>(r) + 1]; ++i) {
            const Run& run = found.runs[static_cast<std::size_t>(i)];
            std::fill(row.begin() + run.first, row.begin() + run.last + 1, static_cast<Number>(run.label + 1));
        }
    }
    io::write_volume(file, label, h);
}

void save_labels(const Mask& mask, Connectivity connectivity, double h, const std::filesystem::path& file)
{
    const Components found = components(mask, connectivity);
    if (found.count <= 65535)
        save_labels<std::uint16_t>(found, h, file);
    else
        save_labels<float>(found, h, file);
}

}  // namespace

void save_intermediates(const Microstructure& micro, const Settings& settings, const std::filesystem::path& folder)
{
    const Classification c = classified(micro.matter, settings.R_C, settings.R_E, settings.border);
    save(complement(c.closed), micro.gray.voxel_size, folder / "closed.mhd");
    save(complement(c.enlarged), micro.gray.voxel_size, folder / "enlarged.mhd");
    save_labels(micro.pore, settings.connectivity, micro.gray.voxel_size, folder / "pore_labels.mhd");
    save_labels(micro.crack, settings.connectivity, micro.gray.voxel_size, folder / "crack_labels.mhd");
}

}  // namespace craze::microstructure
