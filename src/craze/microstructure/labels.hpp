// Which voxels hang together: connected components of a mask, kept as runs along x.

#pragma once

#include "craze/core/mask.hpp"

#include <cstdint>
#include <vector>

namespace craze::microstructure {

/// Neighbours of a voxel: 26 that share a corner, 18 that share an edge, 6 that share a face.
enum class Connectivity { corners = 0, edges = 1, faces = 2 };

/// Voxels first ... last (inclusive) of one row.
struct Run {
    std::int32_t first = 0, last = 0;
    std::int32_t label = 0;  ///< 0 ... count - 1

    std::int64_t length() const { return std::int64_t{last} - first + 1; }
};

/// Components, numbered from 0 in the order in which their first voxels come in memory.
struct Components {
    Shape shape;
    std::int32_t count = 0;
    std::vector<std::int64_t> row_begin;  ///< first run of row y + ny z, shape (ny nz + 1,)
    std::vector<Run> runs;                ///< in the order of memory
};

/// @throws ComputationFailed  beyond 2^31 runs
Components components(const Mask& mask, Connectivity connectivity = Connectivity::corners);

/// Voxels of each component, shape (count,).
std::vector<std::int64_t> volumes(const Components& components);

/// label + 1 of each voxel, 0 outside.
Volume<std::int32_t> painted(const Components& components);

/// The voxels of the components for which keep[label] is not 0.
Mask selected(const Components& components, const std::vector<std::uint8_t>& keep);

}  // namespace craze::microstructure
