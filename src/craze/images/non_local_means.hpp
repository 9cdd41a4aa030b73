// Non-local means: each voxel becomes the mean of those whose surroundings look like its own [2.3 (3)].
//
//     v'(p) = sum_s w_s(p) v(p + s) / sum_s w_s(p),   w = exp(-max(0, d^2 - 2 sigma^2) / h^2)
//
// d^2 is the mean squared difference of the neighbourhoods of p and p + s, s runs over the search window.
// Beyond its faces the volume is mirrored. All sums are of integers, so that results have no order.

#pragma once

#include "craze/core/volume.hpp"

#include <cstdint>
#include <functional>
#include <span>

namespace craze::images {

struct NonLocalMeans {
    std::int64_t search = 21;        ///< px, odd
    std::int64_t neighbourhood = 5;  ///< px, odd, 3 to 11
    bool in_volume = true;           ///< false: each slice by itself
    double sigma = 0.0;              ///< noise, gray levels
    double h = 1.0;                  ///< strength, gray levels, > 0

    /// Slices needed before and after those that are filtered.
    std::int64_t halo() const { return in_volume ? search / 2 + neighbourhood / 2 : 0; }
};

/// Filters slices [z0, z1) of a volume of shape `shape`. `read(z, to)` gives slice z of [0, nz), `write(z, from)`
/// takes the result; both are called in ascending z from the calling thread. `done(tiles, of)` is called between.
void filter_slab(const NonLocalMeans& filter, Shape shape, std::int64_t z0, std::int64_t z1,
                 const std::function<void(std::int64_t, std::span<std::uint8_t>)>& read,
                 const std::function<void(std::int64_t, std::span<const std::uint8_t>)>& write,
                 const std::function<void(double)>& advance = {});

/// A whole volume in memory.
Volume<std::uint8_t> non_local_means(const Volume<std::uint8_t>& gray, const NonLocalMeans& filter);

/// Bytes that filter_slab fills for so many slices.
std::int64_t memory_of_slab(const NonLocalMeans& filter, Shape shape, std::int64_t slices);

/// Where index i of a mirrored line of n values is read: ... 1 0 | 0 1 ... n-1 | n-1 n-2 ...
constexpr std::int64_t mirrored(std::int64_t i, std::int64_t n)
{
    i %= 2 * n;
    if (i < 0) i += 2 * n;
    return i < n ? i : 2 * n - 1 - i;
}

}  // namespace craze::images
