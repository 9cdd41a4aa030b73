// The sheet that each crack is, without thickness: the value that `mesh` gives.

#pragma once

#include "craze/core/vec3.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace craze::mesh {

/// Triangles of the crack surface [2.5]. Voxels have become metres: the stack fills [0, n h] along each axis.
struct CrackSurface {
    std::vector<Vec3> vertices;                          ///< m, shape (n,)
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< indices into vertices, shape (m,), no duplicates
    /// Faces of the crack that a triangle stands for, shape (m,): 2 where it is the sheet itself, 1 where the sheet is
    /// a flat shell of two skins around tetrahedra of the alpha shape. The crack's area is the sum of sides / 2 x area.
    std::vector<std::uint8_t> sides;
};

}  // namespace craze::mesh
