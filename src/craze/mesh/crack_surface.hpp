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
};

}  // namespace craze::mesh
