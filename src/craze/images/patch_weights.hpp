// The inner loops of non-local means, on vectors of 16-bit integers so that one instruction serves many voxels.
//
// The voxels of a vector lie far apart, each in a strip of its own, so that neighbours along x are whole vectors: sums
// over a neighbourhood slide along x as they do along y and z (add what enters, take away what leaves), and no read
// straddles two vectors. Squared differences are scaled so that a neighbourhood whose weight is not zero sums to less
// than `cap`; partial sums are held at cap, hence nothing overflows and sums slide without error.

#pragma once

#include "craze/images/non_local_means.hpp"

#include <array>
#include <cstdint>

namespace craze::images {

constexpr std::int64_t lanes = 16;  // voxels of a vector
constexpr std::int64_t chunk = 11;  // rows of weights summed in 16 bits

/// How differences become weights, in integers.
struct PatchScale {
    explicit PatchScale(const NonLocalMeans& filter);

    std::array<std::int16_t, 256> scaled{};  ///< of each gray level
    bool exact = false;                      ///< squares of whole gray levels; else of scaled ones, over 2^15
    bool narrow = false;                     ///< no square exceeds cap
    std::uint16_t cap = 0;                   ///< sum at which the weight is zero
    /// Of t = max(0, sum - free), with z = max(0, reach - t) stretch: weight = (base + z^2 factor)^32.
    struct Weights {
        std::uint16_t free = 0;  ///< sum that noise alone explains: weight one
        std::uint16_t reach = 0;
        std::uint16_t stretch = 1;
        std::int16_t factor = 0;  ///< in 2^-15
        bool plain = false;       ///< stretch and factor are one
        std::int16_t base = 0;    ///< in 2^-15
    } weights;
    std::int32_t one = 0;  ///< the weight of what is alike; the largest there is
};

/// One row of voxels p against the rows of p + s, for `count` shifts s that follow each other along x: the pointers are
/// those of the first shift, the others lie one vector further (levels) or one stride further (sums).
struct PatchRow {
    std::int64_t length = 0;  ///< vectors of voxels p
    std::int64_t count = 0, neighbourhood = 0;
    const std::int16_t *p_new, *p_old;    ///< scaled levels around p, in the plane that enters and the one that leaves
    const std::int16_t *ps_new, *ps_old;  ///< the same around p + s
    std::int64_t column_stride, weight_stride;  ///< in values
    std::uint16_t* column;                      ///< length + neighbourhood - 1 vectors of squares summed along z
    const std::uint16_t* column_old;            ///< those of the row that leaves the neighbourhood
    std::uint16_t* band;                        ///< columns summed along y
    std::uint16_t* weight;                      ///< length vectors

    std::int64_t columns() const { return (length + neighbourhood - 1) * lanes; }
};

/// Columns of a tile's first plane: squares of so many planes, the first at p_new and ps_new, the next `step` further.
void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step);
/// Brings columns (unless `columns_done`) and bands up to date; if `weigh`, sums the bands along x and makes weights.
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh);

/// Rows of weights for shifts along x from `first` on, and the row of levels (<< 7) that they weigh.
struct WeightedRows {
    const std::uint16_t* weight;
    std::int64_t weight_stride, count, length;
    std::int64_t first;
    const std::int16_t* level;  ///< of the first voxel of the row, before any shift
};
/// Sums of each vector of voxels: of weight x level, in 2^-8, its even voxels, then its odd ones; of weights likewise.
constexpr std::int64_t sums_of_vector = 4 * lanes / 2;
/// To each p the weights and the levels of p + s; `to` belongs to the first p.
void add_here(const WeightedRows& rows, std::int32_t* to);
/// To each p + s the weights and the levels of p; `to` belongs to the first p, and those before it are reached, too.
void add_there(const WeightedRows& rows, std::int32_t* to);

/// Whether the loops written out for AVX2 run here; they give the bits of the plain ones.
bool spelled_out();
namespace plain {
void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step);
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh);
void add_here(const WeightedRows& rows, std::int32_t* to);
void add_there(const WeightedRows& rows, std::int32_t* to);
}  // namespace plain
namespace avx2 {
void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step);
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh);
void add_here(const WeightedRows& rows, std::int32_t* to);
void add_there(const WeightedRows& rows, std::int32_t* to);
}  // namespace avx2

/// The mean, with the voxel itself, whose weight is one.
inline std::uint8_t level_of(std::uint8_t own, std::int32_t weighted, std::int32_t weights, std::int32_t one)
{
    const std::int64_t sum = std::int64_t{256} * weighted + std::int64_t{one} * own;
    const std::int64_t count = std::int64_t{weights} + one;
    return static_cast<std::uint8_t>(std::min<std::int64_t>(255, (sum + count / 2) / count));
}

}  // namespace craze::images
