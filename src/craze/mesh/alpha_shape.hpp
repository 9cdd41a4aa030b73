// The alpha shape of voxel centres, without a Delaunay triangulation of them all.

#pragma once

#include "craze/core/mask.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace craze::mesh {

/// Triangles between voxels. Coordinates are those of voxels, edge 1.
struct LatticeSurface {
    std::vector<std::array<std::int32_t, 3>> vertices;   ///< (x, y, z), sorted by z, y, x; only those in a triangle
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< indices into vertices, no duplicates
    std::vector<std::uint8_t> sides;  ///< one per triangle: 2 a sheet seen from both sides, 1 the skin of a solid part
};

/// Largest alpha that alpha_shape takes, px.
inline constexpr double largest_alpha = 4.0;

/// The triangles of the alpha shape (Edelsbrunner and Muecke 1992) of the voxel centres in `points`: the triangles of
/// their Delaunay triangulation that some ball of radius `alpha` (px) or smaller touches at its three corners with no
/// point inside, less those with a tetrahedron of circumradius <= alpha on both sides. What is left bounds tetrahedra
/// on one side (`sides` 1, turned outwards) or on none (`sides` 2). Fixed_alpha_shape_3 of CGAL calls them regular and
/// singular.
///
/// Exact: integers and correctly rounded quotients of small integers. Where more than four points lie on one empty
/// sphere, as on a lattice most do, flat faces are cut into fans from their first corner in the order z, y, x; the
/// union of the triangles does not depend on it. Ball and alpha are compared with <=, exactly where alpha^2 is a
/// multiple of 1/4. Slices are spread over threads.
/// @param alpha  px, in [0.5, largest_alpha]
/// @throws InvalidInput  for more than 2^31 - 1 points
/// @throws Interrupted  when asked to stop
LatticeSurface alpha_shape(const Mask& points, double alpha);

}  // namespace craze::mesh
