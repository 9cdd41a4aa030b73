#include "craze/mesh/mesh.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/triangles.hpp"
#include "craze/mesh/alpha_shape.hpp"
#include "craze/mesh/medial_surface.hpp"
#include "craze/mesh/skeleton.hpp"

#include <fmt/format.h>

namespace craze::mesh {

namespace {

constexpr double smallest_alpha = 0.87;  // sqrt(3) / 2: voxels that share a corner are joined

}  // namespace

void describe(Schema& schema, Settings& settings)
{
    schema.option(
        "skeleton", settings.skeleton, {"per_slice", "medial_surface"},
        "per_slice thins each slice (the paper); medial_surface thins in space: for cracks that lie in the slices");
    schema.choice("slice_axis", settings.slice_axis, {"x", "y", "z"},
                  "per_slice: the slices are perpendicular to this axis");
    schema.quantity("alpha", settings.alpha, Dimension::pixel, {smallest_alpha, largest_alpha},
                    "radius of the alpha shape: gaps in a crack up to twice as wide are bridged");
}

void check(const Settings& settings)
{
    if (!(settings.alpha >= smallest_alpha && settings.alpha <= largest_alpha))
        throw InvalidInput(
            fmt::format("mesh.alpha: needs {} px to {} px, got {} px", smallest_alpha, largest_alpha, settings.alpha));
    if (!(settings.slice_axis >= 0 && settings.slice_axis <= 2))
        throw InvalidInput(fmt::format("mesh.slice_axis: needs x, y or z, got axis {}", settings.slice_axis));
}

CrackSurface mesh_cracks(const Mask& crack, double voxel_size, const Settings& settings)
{
    check(settings);
    if (!(voxel_size > 0.0))
        throw InvalidInput(fmt::format("mesh: the voxel size must be positive, got {} m", voxel_size));
    LatticeSurface lattice =
        alpha_shape(settings.skeleton == SkeletonKind::per_slice ? skeleton_of_slices(crack, settings.slice_axis)
                                                                 : medial_surface(crack),
                    settings.alpha);
    CrackSurface surface;
    surface.vertices.reserve(lattice.vertices.size());
    for (const auto& v : lattice.vertices)
        surface.vertices.push_back({(v[0] + 0.5) * voxel_size, (v[1] + 0.5) * voxel_size, (v[2] + 0.5) * voxel_size});
    surface.triangles = std::move(lattice.triangles);
    surface.sides = std::move(lattice.sides);
    return surface;
}

void save(const CrackSurface& surface, const std::filesystem::path& folder)
{
    io::TriangleView view{surface.vertices, surface.triangles};
    if (!surface.sides.empty()) view.fields.push_back({"sides", std::span(surface.sides)});
    io::write_ply(folder / "cracks.ply", view);
}

CrackSurface load_surface(const std::filesystem::path& folder)
{
    io::TriangleMesh mesh = io::read_ply(folder / "cracks.ply", "sides");
    // A surface drawn or edited elsewhere has no such property: its triangles are the sheet.
    if (mesh.tags.size() != mesh.triangles.size()) mesh.tags.assign(mesh.triangles.size(), 2);
    return {std::move(mesh.vertices), std::move(mesh.triangles), std::move(mesh.tags)};
}

Json summary(const CrackSurface& surface, double volume)
{
    const double area = parallel_sum(static_cast<std::int64_t>(surface.triangles.size()), [&](std::int64_t i) {
        const auto t = static_cast<std::size_t>(i);
        const auto corner = [&](std::size_t k) {
            return surface.vertices[static_cast<std::size_t>(surface.triangles[t][k])];
        };
        return 0.25 * surface.sides[t] * norm(cross(corner(1) - corner(0), corner(2) - corner(0)));
    });
    Json json;
    json["vertices"] = surface.vertices.size();
    json["triangles"] = surface.triangles.size();
    json["triangles_per_vertex"] = surface.vertices.empty() ? 0.0
                                                            : static_cast<double>(surface.triangles.size()) /
                                                                  static_cast<double>(surface.vertices.size());
    json["area_m2"] = area;
    json["area_per_volume_1_per_m"] = area / volume;
    return json;
}

}  // namespace craze::mesh
