// Fewer triangles that still show the same sheets.

#pragma once

#include "craze/mesh/crack_surface.hpp"

#include <cstdint>

namespace craze::report {

/// The surface with vertices of each cell of a cubic grid drawn together in their mean; triangles that vanish or repeat
/// are dropped, vertices without triangles too. The cell is the smallest found (within a few per cent) that leaves at
/// most `most` triangles; a surface with few enough is returned as it is, but for unused vertices.
mesh::CrackSurface decimated(const mesh::CrackSurface& surface, std::int64_t most);

}  // namespace craze::report
