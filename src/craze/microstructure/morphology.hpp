// Dilation, erosion and closing of masks by balls [2.4.2, Fig. 5].
//
// Nothing outside the volume counts, neither as matter nor as void: a pore cut by the border of the stack is taken to
// go on behind it.

#pragma once

#include "craze/core/mask.hpp"

#include <cstdint>

namespace craze::microstructure {

/// All offsets (i, j, k) with i^2 + j^2 + k^2 <= squared.
struct Ball {
    std::int64_t squared = 0;

    Ball() = default;
    /// Ball of radius r, px: squared = floor(r^2), so that 8.5 gives 72.
    /// @throws InvalidInput  when r is not in [0, 500]
    explicit Ball(double radius);
};

/// The set grown by the ball: voxels with a voxel of `a` within reach.
Mask dilated(const Mask& a, Ball ball);
/// The set shrunk by the ball: voxels with no voxel outside `a` (and inside the volume) within reach.
Mask eroded(const Mask& a, Ball ball);
/// Dilation, then erosion: closing matter removes the voids that hold no ball.
Mask closed(const Mask& a, Ball ball);

}  // namespace craze::microstructure
