// The crack surface in space, and which way it faces [2.5, Fig. 8].

#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
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

struct Facet {
    Vec3 normal;  // unit
    double area;  // m2, of the crack it stands for
};

std::vector<Facet> facets_of(const mesh::CrackSurface& surface)
{
    std::vector<Facet> out;
    out.reserve(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto at = [&](std::size_t k) {
            return surface.vertices[static_cast<std::size_t>(surface.triangles[t][k])];
        };
        const Vec3 n = cross(at(1) - at(0), at(2) - at(0));
        const double twice = norm(n);
        if (!(twice > 0.0)) continue;
        const double sides = surface.sides.empty() ? 2.0 : static_cast<double>(surface.sides[t]);
        out.push_back({n / twice, 0.25 * sides * twice});
    }
    return out;
}

/// Area over the angle between normal and z, beside what no preferred direction would give.
Figure inclination(const std::vector<Facet>& facets)
{
    constexpr int bins = 18;
    std::vector<double> edges, share(bins, 0.0), centres, isotropic;
    double all = 0.0;
    for (const auto& f : facets) {
        const double angle = std::acos(std::min(1.0, std::abs(f.normal.z))) * 180.0 / std::numbers::pi;
        share[static_cast<std::size_t>(std::min(bins - 1, static_cast<int>(angle / 90.0 * bins)))] += f.area;
        all += f.area;
    }
    for (int k = 0; k <= bins; ++k) edges.push_back(90.0 * k / bins);
    for (int k = 0; k < bins; ++k) {
        share[static_cast<std::size_t>(k)] *= 100.0 / all;
        centres.push_back(90.0 * (k + 0.5) / bins);
        const auto cosine = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180.0); };
        isotropic.push_back(100.0 * (cosine(90.0 * k / bins) - cosine(90.0 * (k + 1) / bins)));
    }
    Figure f;
    f.id = "crack_inclination";
    f.caption =
        "Crack area over the angle between its normal and z: 0° cracks lie across z (between splats), 90° cracks stand "
        "along z (through "
        "splats).";
    f.x = {"angle between normal and z [°]", false, 0.0, 90.0};
    f.y = {"share of crack area [%]", false, 0.0};
    f.series = {{"cracks", edges, share, Mark::bars, 1},
                {"no preferred direction", centres, isotropic, Mark::dashed, 6}};
    return f;
}

/// Directions of the lines along which cracks cut a plane across `axis`, weighted by their length.
Rose trace_rose(const std::vector<Facet>& facets, int axis)
{
    constexpr std::size_t petals = 18;
    const int u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    Rose rose;
    rose.id = fmt::format("crack_rose_{}", "xyz"[axis]);
    rose.caption = fmt::format(
        "Directions of crack traces in planes across {}; petal area is the share of trace length.", "xyz"[axis]);
    rose.east = std::string(1, "xyz"[u]), rose.north = std::string(1, "xyz"[v]);
    rose.share.assign(petals, 0.0);
    for (const auto& f : facets) {
        const double length = std::hypot(f.normal[u], f.normal[v]);
        if (!(length > 0.0)) continue;
        double angle = std::atan2(f.normal[u], -f.normal[v]);  // of the trace, which is normal to the normal
        if (angle < 0.0) angle += std::numbers::pi;
        const auto petal =
            static_cast<std::size_t>(std::lround(angle / std::numbers::pi * static_cast<double>(petals))) % petals;
        rose.share[petal] += f.area * length;
    }
    return rose;
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
    const auto facets = facets_of(surface);
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
    work.page.figure(inclination(facets));
    for (int axis = 2; axis >= 0; --axis) work.page.figure(trace_rose(facets, axis));
    work.page.add("</div>");
    end_room(work, "mesh");
}

}  // namespace craze::report
