// The crack surface in space, and which way it faces [2.5, Fig. 8].

#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/report/decimate.hpp"
#include "craze/report/render.hpp"
#include "craze/report/scene_data.hpp"
#include "craze/report/sections.hpp"
#include "craze/report/slices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::report {

namespace {

/// The stack's edges in metres; from the surface itself where microstructure does not say.
Vec3 box_of(const OutputFolder& folder, const mesh::CrackSurface& surface)
{
    const Json& shape = find(folder.summary("microstructure"), "shape_px");
    const double h = find_number(folder.summary("microstructure"), {"voxel_size"});
    Vec3 box;
    if (shape.is_array() && shape.size() == 3 && h > 0.0) {
        for (std::size_t k = 0; k < 3; ++k) box[static_cast<int>(k)] = shape[k].get<double>() * h;
        return box;
    }
    for (const auto& v : surface.vertices)
        for (int axis = 0; axis < 3; ++axis) box[axis] = std::max(box[axis], v[axis]);
    return box;
}

/// Area over the angle between normal and z, beside what no preferred direction would give.
Figure inclination(const CsvColumns& poles)
{
    constexpr int bins = 18;
    const auto from = poles.numbers("cos_from"), to = poles.numbers("cos_to"), share = poles.numbers("share");
    const auto degrees = [](double cosine) {
        return std::acos(std::clamp(cosine, 0.0, 1.0)) * 180.0 / std::numbers::pi;
    };
    Series cracks{"cracks", {}, {}, Mark::bars, 1};
    // Rings of equal area on the sphere: without a preferred direction each holds the same share.
    for (std::size_t k = 0; k < share.size(); ++k) {
        if (k == 0 || from[k] != from[k - 1]) {
            if (cracks.x.empty()) cracks.x.push_back(degrees(to[k]));
            cracks.x.push_back(degrees(from[k])), cracks.y.push_back(0.0);
        }
        cracks.y.back() += 100.0 * share[k] / (cracks.x[cracks.x.size() - 1] - cracks.x[cracks.x.size() - 2]);
    }
    Series isotropic{"no preferred direction", {}, {}, Mark::dashed, 6};
    for (int k = 0; k <= bins; ++k) {
        isotropic.x.push_back(90.0 * k / bins);
        isotropic.y.push_back(100.0 * std::sin(isotropic.x.back() * std::numbers::pi / 180.0) * std::numbers::pi /
                              180.0);
    }
    Figure f;
    f.id = "crack_inclination";
    f.caption =
        "Crack area over the angle between its normal and z: near 0° cracks lie across z (between splats), near 90° "
        "they stand along z (through "
        "splats).";
    f.x = {"angle between normal and z [°]", false, 0.0, 90.0};
    f.y = {"crack area per degree [%]", false, 0.0};
    f.series = {std::move(cracks), std::move(isotropic)};
    return f;
}

void roses(Work& work)
{
    const auto csv = work.folder.csv("mesh", "rose.csv");
    if (!csv) return;
    for (int axis = 2; axis >= 0; --axis) {
        const char name = "xyz"[axis];
        Rose rose;
        rose.id = fmt::format("crack_rose_{}", name);
        rose.caption = fmt::format(
            "Directions of the lines that cracks draw on sections across {}; a petal's area is its share of their "
            "length.",
            name);
        rose.share = csv->numbers(fmt::format("section_{}", name));
        rose.first_degrees = 0.5 * rose.span_degrees / static_cast<double>(std::max<std::size_t>(1, rose.share.size()));
        rose.east = axis == 0 ? "y" : "x", rose.north = axis == 2 ? "y" : "z";
        work.page.figure(rose);
    }
}

void openings(Work& work)
{
    const auto csv = work.folder.csv("mesh", "openings.csv");
    if (!csv) return;
    auto edges = over(csv->numbers("opening_from_m"), 1e-9);
    edges.push_back(csv->numbers("opening_to_m").back() / 1e-9);
    Figure f;
    f.id = "crack_openings";
    f.caption = "Opening of the cracks in the voxels, by area: chords along the smoothed normal.";
    f.x.title = "opening [nm]";
    f.y.title = "share of crack area [%]";
    f.series = {{"", edges, over(csv->numbers("share"), 0.01), Mark::bars, 1}};
    work.page.figure(f);
}

void single_cracks(Work& work)
{
    const auto csv = work.folder.csv("mesh", "cracks.csv");
    if (!csv) return;
    const auto radii = csv->numbers("radius_m"), areas = csv->numbers("area_m2");
    double all = 0.0;
    for (const double a : areas) all += a;
    if (!(all > 0.0)) return;
    Figure f;
    f.id = "crack_sizes";
    f.caption =
        fmt::format("Single cracks by the radius of the disc of the same area: {} of them; bars weigh them by area.",
                    format_number(static_cast<double>(radii.size()), 9));
    f.x.title = "radius a [µm]";
    f.y.title = "share of crack area [%]";
    f.series = {histogram("", radii, over(areas, 0.01 * all), 1e-6)};
    f.series.front().colour = 1;
    work.page.figure(f);
}

}  // namespace

void write_mesh(Work& work)
{
    if (!begin_room(work, "mesh", "Crack surface")) return;
    const auto surface = mesh::load_surface(work.folder.room("mesh"));
    if (surface.triangles.empty()) {
        work.page.remark("There is no crack surface: no voxel was classified as crack.");
        end_room(work, "mesh");
        return;
    }
    if (work.settings.scenes) {
        const Vec3 box = box_of(work.folder, surface);
        const auto shown = decimated(surface, work.settings.triangles);
        Scene scene;
        scene.vertices = surface.vertices, scene.triangles = surface.triangles;
        scene.sheet = colour_of(crack_colour);
        scene.box = box;
        const auto still =
            io::png_bytes(render(scene, {work.settings.render_width, work.settings.render_width * 3 / 4}));
        const double extent = std::max({box.x, box.y, box.z});
        const auto count = [](std::size_t n) { return format_number(static_cast<double>(n), 9); };
        const auto caption = fmt::format(
            "Surface of the cracks, {} triangles{}; box {:.4g} × {:.4g} × {:.4g} µm.", count(surface.triangles.size()),
            shown.triangles.size() < surface.triangles.size()
                ? fmt::format(" (drawn with {} in the page)", count(shown.triangles.size()))
                : std::string(),
            box.x * 1e6, box.y * 1e6, box.z * 1e6);
        work.page.viewer("crack_surface", "scene", scene_json(box, {sheet_part("cracks", crack_colour, shown, extent)}),
                         caption, still, work.figure("Fig. 8"));
    }
    work.page.add("<div class=\"row\">");
    if (const auto poles = work.folder.csv("mesh", "pole_figure.csv")) work.page.figure(inclination(*poles));
    openings(work);
    single_cracks(work);
    roses(work);
    if (const auto file = work.folder.room("mesh") / "pole_figure.png"; std::filesystem::is_regular_file(file))
        work.page.picture("crack_poles", io::read_text(file),
                          "Normals of the crack surface seen along z, equal-area projection: z in the middle, x to the "
                          "right, y up; darker is more.");
    work.page.add("</div>");
    end_room(work, "mesh");
}

}  // namespace craze::report
