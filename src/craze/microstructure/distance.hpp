// Exact Euclidean distance transform.

#pragma once

#include "craze/core/mask.hpp"

#include <cstdint>

namespace craze::microstructure {

/// Squared distance where the set has no voxel at all.
inline constexpr std::int32_t no_distance = std::int32_t{1} << 30;

/// Squared distance of each voxel to the nearest voxel of the set, centre to centre, px^2: 0 inside the set. Exact.
/// The outside of the volume is not part of the set. 4 bytes per voxel.
/// @throws InvalidInput  when nx^2 + ny^2 + nz^2 is 2^30 or more
Volume<std::int32_t> squared_distance(const Mask& set);

}  // namespace craze::microstructure
