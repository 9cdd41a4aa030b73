// The sheet that each crack is, without thickness: the value that `mesh` gives.

#pragma once

#include "craze/core/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace craze::mesh {

/// Triangles of the crack surface [2.5]. Voxels have become metres: the stack fills [0, n h] along each axis.
struct CrackSurface {
    std::vector<Vec3> vertices;                          ///< m, shape (n,)
    std::vector<std::array<std::int32_t, 3>> triangles;  ///< indices into vertices, shape (m,), no duplicates
    /// Faces of the crack that a triangle stands for, shape (m,) or empty (all 2): 2 where it is the sheet itself, 1
    /// where the sheet is a flat shell of two skins around tetrahedra of the alpha shape.
    std::vector<std::uint8_t> sides;
};

/// Entry t of `sides`. The crack's area is half the sum of faces x area.
inline int faces_of(const CrackSurface& surface, std::size_t t) { return surface.sides.empty() ? 2 : surface.sides[t]; }

}  // namespace craze::mesh
