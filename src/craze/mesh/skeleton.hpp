// Lines one pixel wide in the middle of each crack, slice by slice.

#pragma once

#include "craze/core/mask.hpp"

namespace craze::mesh {

/// Skeleton of every slice perpendicular to `axis` (0 x, 1 y, 2 z) [2.5, Fig. 8]: parallel thinning after Zhang and
/// Suen (Comm. ACM 27, 1984, 236), with what their rule breaks repaired: no component and no hole appears or vanishes
/// in any slice (8-connected set, 4-connected rest), and diagonal bands two pixels wide keep their length, for corners
/// of staircases are trimmed before each iteration.
/// The skeleton is a subset of `set`. Work on 64 pixels at a time; slices are spread over threads.
/// @throws Interrupted  when asked to stop
Mask skeleton_of_slices(const Mask& set, int axis);

}  // namespace craze::mesh
