// Masks to try algorithms on.

#pragma once

#include "craze/core/mask.hpp"
#include "craze/core/random.hpp"

namespace craze::support {

/// Each voxel in with the given probability.
inline Mask random_mask(Shape shape, double share, std::uint64_t seed)
{
    Mask mask(shape);
    Random random(seed);
    for (std::int64_t z = 0; z < shape.nz; ++z)
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x) mask.set(x, y, z, random.uniform() < share);
    return mask;
}

/// Union of balls of radius up to `most` px at random places.
inline Mask random_balls(Shape shape, int balls, double most, std::uint64_t seed)
{
    Mask mask(shape);
    Random random(seed);
    for (int b = 0; b < balls; ++b) {
        const double cx = random.uniform(0, static_cast<double>(shape.nx)),
                     cy = random.uniform(0, static_cast<double>(shape.ny)),
                     cz = random.uniform(0, static_cast<double>(shape.nz)), r = random.uniform(0.5, most);
        for (std::int64_t z = 0; z < shape.nz; ++z)
            for (std::int64_t y = 0; y < shape.ny; ++y)
                for (std::int64_t x = 0; x < shape.nx; ++x) {
                    const double dx = static_cast<double>(x) - cx, dy = static_cast<double>(y) - cy,
                                 dz = static_cast<double>(z) - cz;
                    if (dx * dx + dy * dy + dz * dz <= r * r) mask.set(x, y, z, true);
                }
    }
    return mask;
}

}  // namespace craze::support
