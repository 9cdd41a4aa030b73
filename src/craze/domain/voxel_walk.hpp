// The voxels that a segment passes, one after the other.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/core/volume.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace craze::domain {

/// Calls visit(x, y, z) for every voxel of the stack on the segment p-q (m), in order (Amanatides, Woo 1987).
/// A segment along a face or edge of voxels visits one side of it.
template <class Visit>
void walk_voxels(const Vec3& p, const Vec3& q, double voxel_size, const Shape& shape, Visit&& visit)
{
    std::int64_t at[3], end[3], step[3];
    double next[3], every[3];
    std::int64_t steps = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double from = p[axis] / voxel_size, to = q[axis] / voxel_size;
        at[axis] = static_cast<std::int64_t>(std::floor(from));
        end[axis] = static_cast<std::int64_t>(std::floor(to));
        step[axis] = end[axis] >= at[axis] ? 1 : -1;
        steps += (end[axis] - at[axis]) * step[axis];
        const double length = std::abs(to - from);
        every[axis] = length > 0.0 ? 1.0 / length : std::numeric_limits<double>::infinity();
        const double first =
            step[axis] > 0 ? static_cast<double>(at[axis]) + 1.0 - from : from - static_cast<double>(at[axis]);
        next[axis] = length > 0.0 ? first / length : std::numeric_limits<double>::infinity();
    }
    for (;; --steps) {
        if (at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < shape.nx && at[1] < shape.ny && at[2] < shape.nz)
            visit(at[0], at[1], at[2]);
        if (steps == 0) return;
        int axis = next[0] <= next[1] ? 0 : 1;
        if (next[2] < next[axis]) axis = 2;
        // Rounding must not lead past the last voxel of an axis.
        if (at[axis] == end[axis]) axis = at[0] != end[0] ? 0 : at[1] != end[1] ? 1 : 2;
        at[axis] += step[axis];
        next[axis] += every[axis];
    }
}

}  // namespace craze::domain
