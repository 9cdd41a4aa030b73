// Small masks to test with.

#pragma once

#include "craze/core/mask.hpp"
#include "support/random_masks.hpp"

#include <string>
#include <vector>

namespace craze::support {

/// Voxels where in(x, y, z) says so.
template <class In>
Mask mask_of(Shape shape, In&& in)
{
    Mask mask(shape);
    for (std::int64_t z = 0; z < shape.nz; ++z)
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x)
                if (in(x, y, z)) mask.set(x, y, z, true);
    return mask;
}

/// One slice drawn with '#'.
inline Mask drawing(const std::vector<std::string>& rows)
{
    return mask_of(
        Shape{static_cast<std::int64_t>(rows[0].size()), static_cast<std::int64_t>(rows.size()), 1},
        [&](auto x, auto y, auto) { return rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] == '#'; });
}

}  // namespace craze::support
