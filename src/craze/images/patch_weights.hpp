// The inner loops of non-local means, on rows of 16-bit integers so that one instruction serves many voxels.
//
// Squared differences are scaled so that a neighbourhood whose weight is zero sums to `cap`; partial sums are held
// at cap, hence nothing overflows and sums may slide (add the new row, take away the old) without error.

#pragma once

#include "craze/images/non_local_means.hpp"

#include <array>
#include <cstdint>

namespace craze::images {

constexpr std::int64_t lanes = 16;                            // rows come in multiples of this many voxels
constexpr std::int64_t longest_row = 16 * lanes;              // voxels in a row of weights
constexpr std::int64_t longest_column = longest_row + lanes;  // the same with what the neighbourhood needs beside it
constexpr std::int64_t chunk = 7;                             // rows of weights summed in 16 bits: 7 x 8191 < 2^16
constexpr std::int32_t weight_of_one = 8191;

/// How differences become weights, in integers.
struct PatchScale {
    explicit PatchScale(const NonLocalMeans& filter);

    bool exact = false;                      ///< squares of whole gray levels; else of scaled ones, over 2^15
    std::array<std::int16_t, 256> scaled{};  ///< of each gray level
    std::uint16_t cap = 0;                   ///< sum at which the weight is zero, or more
    struct Weights {
        std::uint16_t free = 0;     ///< sum that noise alone explains: weight one
        std::uint16_t most = 0;     ///< sum beyond `free` at which the weight is zero
        std::uint16_t stretch = 1;  ///< power of two: x = most stretch 2^-15 lies in [1/2, 1)
        /// exp(-10 t / most) = (sum_i cubic[i] x^i)^8 with x = t stretch 2^-15; in 2^-13
        std::array<std::int16_t, 4> cubic{};
    } weights;
};

/// One row of voxels p against the rows of p + s, for `count` shifts s that follow each other along x: the pointers are
/// those of the first shift, the others lie one value further (levels) or one stride further (sums).
struct PatchRow {
    std::int64_t length = 0, count = 0, neighbourhood = 0;
    const std::int16_t *p_new, *p_old;    ///< scaled levels around p, in the plane that enters and the one that leaves
    const std::int16_t *ps_new, *ps_old;  ///< the same around p + s
    std::int64_t column_stride, weight_stride;
    std::uint16_t* column;            ///< length + lanes squares summed along z
    const std::uint16_t* column_old;  ///< those of the row that leaves the neighbourhood
    std::uint16_t* band;              ///< columns summed along y
    std::uint16_t* weight;
};

/// column += squares of the plane that enters, for the first planes of a tile.
void start_columns(const PatchRow& r, const PatchScale& scale);
/// Brings columns (unless `columns_done`) and bands up to date; if `weigh`, sums the bands along x and makes weights.
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh);

struct Accumulators {
    std::int32_t* weighted;  ///< sum of weight x level, in 2^-8
    std::int32_t* weights;
};
/// `count` rows of weights and of levels, each one stride further than the row before it.
struct WeightedRows {
    const std::uint16_t* weight;
    const std::int16_t* level;  ///< << 7
    std::int64_t weight_stride, level_stride, count;
};
/// Adds the weights and weighted levels of all rows to n voxels, n a multiple of lanes.
void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n);

/// Whether the loops written out for AVX2 run here; they give the bits of the plain ones.
bool spelled_out();
namespace plain {
void start_columns(const PatchRow& r, const PatchScale& scale);
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh);
void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n);
}  // namespace plain
namespace avx2 {
void start_columns(const PatchRow& r, const PatchScale& scale);
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh);
void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n);
}  // namespace avx2

/// The mean, with the voxel itself, whose weight is one.
inline std::uint8_t level_of(std::uint8_t own, std::int32_t weighted, std::int32_t weights)
{
    const std::int64_t sum = std::int64_t{256} * weighted + std::int64_t{weight_of_one} * own;
    const std::int64_t count = std::int64_t{weights} + weight_of_one;
    return static_cast<std::uint8_t>(std::min<std::int64_t>(255, (sum + count / 2) / count));
}

}  // namespace craze::images
