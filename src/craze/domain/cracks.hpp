// Which pairs of elements the cracks cut [3.4].

#pragma once

#include "craze/core/mask.hpp"
#include "craze/domain/domain.hpp"
#include "craze/mesh/crack_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::domain {

/// For each pair, the triangles that its closed segment of centres meets: 255 for 255 or more. Exact: what touches is
/// met, as `meets` says (orientation.hpp). Pairs are laid into a grid, triangles stream past it in any order.
/// @param i, j  elements of each pair, shape (n,)
std::vector<std::uint8_t> triangles_met(const Elements& elements, std::span<const std::int32_t> i,
                                        std::span<const std::int32_t> j, const mesh::CrackSurface& surface);

/// The same without a mesh: runs of crack voxels along each segment of centres, 255 for 255 or more.
/// @param voxel_size  h, m
std::vector<std::uint8_t> crack_voxel_runs_met(const Elements& elements, std::span<const std::int32_t> i,
                                               std::span<const std::int32_t> j, const Mask& crack, double voxel_size);

}  // namespace craze::domain
