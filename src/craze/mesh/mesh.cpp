#include "craze/mesh/mesh.hpp"

#include "craze/core/errors.hpp"
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
    schema.flag("stl", settings.stl, "also write cracks.stl");
    schema.flag("vtp", settings.vtp, "also write cracks.vtp: crack number and opening on each triangle, for ParaView");
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

}  // namespace craze::mesh
