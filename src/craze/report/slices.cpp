#include "craze/report/slices.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/units.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/report/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace craze::report {

namespace fs = std::filesystem;

namespace {

using io::Picture;

constexpr std::size_t budget = 6'500'000;  // bytes of PNG that slices may take in the page

/// Where to cut: `positions` along each axis.
using Positions = std::array<std::vector<std::int64_t>, 3>;

Positions positions_of(const Shape& shape, std::int64_t along_z)
{
    Positions out;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t n = std::min(shape[axis], axis == 2 ? along_z : std::max<std::int64_t>(1, along_z / 4));
        for (std::int64_t k = 0; k < n; ++k)
            out[static_cast<std::size_t>(axis)].push_back((2 * k + 1) * shape[axis] / (2 * n));
    }
    return out;
}

/// First voxel of the part of a stack that is shown.
using Corner = std::array<std::int64_t, 3>;

/// Cuts at `positions` across each axis; across x: y to the right, z down; across y: x, z; across z: x, y.
/// of the part of the volume that begins at `corner` and has the given shape.
std::array<std::vector<Picture>, 3> cuts_of(io::VolumeReader& volume, const Positions& positions, const Shape& shape,
                                            const Corner& corner)
{
    const Shape whole = volume.info().shape;
    std::array<std::vector<Picture>, 3> cuts;
    for (std::size_t k = 0; k < positions[0].size(); ++k) cuts[0].emplace_back(shape.ny, shape.nz);
    for (std::size_t k = 0; k < positions[1].size(); ++k) cuts[1].emplace_back(shape.nx, shape.nz);
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(whole.nx * whole.ny));
    for (std::int64_t z = 0; z < shape.nz; ++z) {
        volume.read_slice<std::uint8_t>(z + corner[2], slice);
        const auto value = [&](std::int64_t x, std::int64_t y) {
            return slice[static_cast<std::size_t>(x + corner[0] + whole.nx * (y + corner[1]))];
        };
        for (std::size_t k = 0; k < positions[0].size(); ++k)
            for (std::int64_t y = 0; y < shape.ny; ++y) *cuts[0][k].at(y, z) = value(positions[0][k], y);
        for (std::size_t k = 0; k < positions[1].size(); ++k)
            for (std::int64_t x = 0; x < shape.nx; ++x) *cuts[1][k].at(x, z) = value(x, positions[1][k]);
        if (std::find(positions[2].begin(), positions[2].end(), z) != positions[2].end()) {
            cuts[2].emplace_back(shape.nx, shape.ny);
            for (std::int64_t y = 0; y < shape.ny; ++y)
                for (std::int64_t x = 0; x < shape.nx; ++x) *cuts[2].back().at(x, y) = value(x, y);
        }
    }
    return cuts;
}

struct Layer {
    std::string name;
    std::array<std::vector<Picture>, 3> cuts;
    bool phases = false;
};

/// Nothing (with a notice) where the file is missing, of another shape, or not 8-bit.
std::optional<Layer> read_layer(const std::string& name, const fs::path& file, Shape& shape, double& voxel,
                                std::int64_t slices, const Corner& corner = {})
{
    if (file.empty() || !fs::exists(file)) return std::nullopt;
    try {
        const auto volume = io::open_volume(file);
        volume->require(io::Sample::u8);
        if (shape.voxels() == 0) shape = volume->info().shape;
        bool fits = true;
        for (int axis = 0; axis < 3; ++axis)
            fits = fits && corner[static_cast<std::size_t>(axis)] + shape[axis] <= volume->info().shape[axis];
        const bool cropped = name == "raw" && corner != Corner{};
        if (!fits || (!cropped && !(volume->info().shape == shape))) {
            notice(fmt::format("report: {} has another shape than the cleaned stack and is not shown", file.string()));
            return std::nullopt;
        }
        if (voxel == 0.0) voxel = volume->info().voxel_size.x;
        return Layer{name, cuts_of(*volume, positions_of(shape, slices), shape, corner), name == "phase"};
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        notice(fmt::format("report: {} is not shown: {}", file.string(), error.what()));
        return std::nullopt;
    }
}

/// Where the cleaned stack begins in the recorded one: the crop of the settings, then what every aligned slice covers.
Corner corner_of(const OutputFolder& folder)
{
    Corner corner{};
    const Json &asked = find(folder.run(), "settings.images.crop"),
               &common = find(folder.summary("images"), "alignment.common_crop");
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const Json* box : {&asked, &common})
            if (box->is_array() && box->size() > 2 * axis && (*box)[2 * axis].is_number())
                corner[axis] += (*box)[2 * axis].get<std::int64_t>();
    return corner;
}

fs::path raw_stack(const OutputFolder& folder)
{
    for (const auto key : {"settings.images.source", "settings.images.path"})
        if (const Json& value = find(folder.run(), key); value.is_string() && !value.get<std::string>().empty())
            return value.get<std::string>();
    return folder.room("synth") / "stack.tif";
}

}  // namespace

Picture overlaid(const Picture& gray, const Picture& phase, double strength)
{
    Picture out(gray.width, gray.height, 3);
    const Colour pore = colour_of(pore_colour), crack = colour_of(crack_colour);
    for (std::int64_t y = 0; y < gray.height; ++y)
        for (std::int64_t x = 0; x < gray.width; ++x) {
            const double level = *gray.at(x, y);
            const int p = *phase.at(x, y);
            const Colour tint = p == 128 ? crack : pore;
            const double w = p == 255 ? 0.0 : strength;
            auto* pixel = out.at(x, y);
            const auto mix = [&](std::uint8_t c) { return static_cast<std::uint8_t>((1.0 - w) * level + w * c + 0.5); };
            pixel[0] = mix(tint.r), pixel[1] = mix(tint.g), pixel[2] = mix(tint.b);
        }
    return out;
}

namespace {

template <class Fold>
Picture folded(const Picture& picture, std::int64_t factor, Fold fold)
{
    if (factor <= 1) return picture;
    Picture out((picture.width + factor - 1) / factor, (picture.height + factor - 1) / factor);
    std::vector<std::uint8_t> cell;
    for (std::int64_t y = 0; y < out.height; ++y)
        for (std::int64_t x = 0; x < out.width; ++x) {
            cell.clear();
            for (auto v = y * factor; v < std::min(picture.height, (y + 1) * factor); ++v)
                for (auto u = x * factor; u < std::min(picture.width, (x + 1) * factor); ++u)
                    cell.push_back(*picture.at(u, v));
            *out.at(x, y) = fold(cell);
        }
    return out;
}

}  // namespace

Picture averaged_down(const Picture& gray, std::int64_t factor)
{
    return folded(gray, factor, [](const std::vector<std::uint8_t>& cell) {
        std::size_t sum = cell.size() / 2;
        for (const auto v : cell) sum += v;
        return static_cast<std::uint8_t>(sum / cell.size());
    });
}

Picture phases_down(const Picture& phase, std::int64_t factor)
{
    return folded(phase, factor, [](const std::vector<std::uint8_t>& cell) {
        if (std::find(cell.begin(), cell.end(), 128) != cell.end()) return std::uint8_t{128};
        const auto pores = static_cast<std::size_t>(std::count(cell.begin(), cell.end(), 0));
        return static_cast<std::uint8_t>(2 * pores >= cell.size() ? 0 : 255);
    });
}

Picture beside(const std::vector<Picture>& pictures)
{
    constexpr std::int64_t gap = 8;
    std::int64_t width = -gap, height = 0;
    for (const auto& p : pictures) width += p.width + gap, height = std::max(height, p.height);
    Picture out(width, height, 3, 255);
    std::int64_t at = 0;
    for (const auto& p : pictures) {
        for (std::int64_t y = 0; y < p.height; ++y)
            for (std::int64_t x = 0; x < p.width; ++x)
                for (std::int64_t c = 0; c < 3; ++c) out.at(at + x, y)[c] = p.at(x, y)[p.channels == 3 ? c : 0];
        at += p.width + gap;
    }
    return out;
}

void draw_scale_bar(Picture& picture, std::int64_t length)
{
    const std::int64_t thick = std::max<std::int64_t>(3, picture.height / 90), edge = 2, margin = 3 * thick;
    const std::int64_t bottom = picture.height - margin;
    for (auto y = bottom - thick - edge; y < bottom + edge; ++y)
        for (auto x = margin - edge; x < margin + length + edge; ++x) {
            if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) continue;
            const bool inside = y >= bottom - thick && y < bottom && x >= margin && x < margin + length;
            for (std::int64_t c = 0; c < picture.channels; ++c) picture.at(x, y)[c] = inside ? 255 : 0;
        }
}

double scale_bar_length(double width)
{
    const double most = 0.4 * width, base = std::pow(10.0, std::floor(std::log10(most)));
    return most >= 5.0 * base ? 5.0 * base : most >= 2.0 * base ? 2.0 * base : base;
}

void write_slices(Work& work)
{
    Shape shape;
    double voxel = 0.0;
    const auto wanted = work.settings.slices;
    std::vector<Layer> layers;
    const auto take = [&](const std::string& name, const fs::path& file, const Corner& corner = {}) {
        if (auto layer = read_layer(name, file, shape, voxel, wanted, corner)) layers.push_back(std::move(*layer));
    };
    take("gray", work.folder.room("images") / "gray.mhd");
    if (layers.empty()) return;
    take("phase", work.folder.room("microstructure") / "phase.mhd");
    take("raw", raw_stack(work.folder), corner_of(work.folder));

    const auto positions = positions_of(shape, wanted);
    std::int64_t factor = (shape.nx + work.settings.picture_width - 1) / work.settings.picture_width;
    Json planes;
    for (std::size_t bytes = budget + 1; bytes > budget; ++factor) {
        planes = Json::array(), bytes = 0;
        constexpr std::array<int, 3> order{2, 1, 0};
        for (const int axis : order) {
            const auto a = static_cast<std::size_t>(axis);
            Json plane{{"axis", std::string(1, "xyz"[axis])},
                       {"across", axis == 0 ? "y" : "x"},
                       {"down", axis == 2 ? "y" : "z"},
                       {"positions", positions[a]},
                       {"layers", Json::object()}};
            for (const auto& layer : layers) {
                Json pictures = Json::array();
                for (const auto& cut : layer.cuts[a]) {
                    const auto small = layer.phases ? phases_down(cut, factor) : averaged_down(cut, factor);
                    const auto png = io::png_bytes(small);
                    plane["width"] = small.width, plane["height"] = small.height;
                    pictures.push_back(base64(png)), bytes += png.size();
                }
                plane["layers"][layer.name] = std::move(pictures);
            }
            planes.push_back(std::move(plane));
        }
    }
    --factor;

    // The still picture: the middle slice, full size.
    const auto middle = positions[2].size() / 2;
    const auto named = [&](std::string_view name) -> const Picture* {
        for (const auto& layer : layers)
            if (layer.name == name) return &layer.cuts[2][middle];
        return nullptr;
    };
    const Picture &gray = *named("gray"), *phase = named("phase"), *raw = named("raw");
    std::vector<Picture> panes;
    std::string names;
    if (raw) panes.push_back(*raw), names += "as recorded, ";
    panes.push_back(gray), names += "cleaned, ";
    if (phase) panes.push_back(overlaid(gray, *phase, 0.75)), names += "pores (blue) and cracks (orange) over gray, ";
    double bar = 0.0;
    if (voxel > 0.0) {
        bar = scale_bar_length(static_cast<double>(shape.nx) * voxel);
        draw_scale_bar(panes.front(), std::llround(bar / voxel));
    }
    const auto still = io::png_bytes(beside(panes));
    Json data{{"planes", std::move(planes)},
              {"pixel", voxel * static_cast<double>(factor) * 1e6},
              {"unit", "µm"},
              {"pore", pore_colour},
              {"crack", crack_colour},
              {"voxel", voxel * 1e6}};
    const auto caption =
        fmt::format("Slice z = {} of {}: {}{}", positions[2][middle], shape.nz, names,
                    bar > 0.0 ? "bar: " + format_quantity(bar, Dimension::length) + "." : "voxel size unknown.");
    work.page.viewer("slices", "slices", data, caption, still, work.paper ? "Figs. 3, 6" : "");
}

}  // namespace craze::report
