// The inner loops of non-local means, on rows of 16-bit integers so that one instruction serves many voxels.
//
// Squared differences are scaled so that a neighbourhood whose weight is zero sums to `cap`; partial sums are held
// at cap, hence nothing overflows and sums may slide (add the new row, take away the old) without error.

#pragma once

#include "craze/images/non_local_means.hpp"

#include <array>
#include <cstdint>

namespace craze::images {

constexpr std::int64_t row_length = 208;              // voxels in a row of weights
constexpr std::int64_t padded_row = row_length + 16;  // the same with what the neighbourhood needs beside it
constexpr std::int64_t chunk = 7;                     // rows of weights summed in 16 bits: 7 x 8191 < 2^16
constexpr std::int32_t weight_of_one = 8191;

/// Voxels along x of a tile whose shifts reach R: the rest of the row of weights is for p - s.
constexpr std::int64_t tile_nx(std::int64_t R) { return row_length - (R + 15) / 16 * 16; }

/// How differences become weights, in integers.
struct PatchScale {
    explicit PatchScale(const NonLocalMeans& filter);

    bool exact = false;                      ///< squares of whole gray levels; else of scaled ones, over 2^15
    std::array<std::int16_t, 256> scaled{};  ///< of each gray level
    std::uint16_t cap = 0;                   ///< sum at which the weight is zero, or more
    struct Weights {
        std::uint16_t free = 0;     ///< sum that noise alone explains: weight one
        std::uint16_t most = 0;     ///< sum beyond `free` at which the weight is zero
        std::uint16_t stretch = 1;  ///< most stretch fills 15 bits
        std::int16_t slope = 0;     ///< most stretch slope 2^-15 is 10/8 in 2^-13
        /// exp(-u) = sum_i cubic[i] u^i; 1 and u in 2^-13, u^2 in 2^-15, u^3 in 2^-17
        std::array<std::int16_t, 4> cubic{8186, -8060, 14423, -11467};
        std::int16_t quarter = 8192, four = 4;
    } weights;
};

/// column[i] += (a[i] - b[i])^2 over padded_row values, capped.
void add_squares(const std::int16_t* a, const std::int16_t* b, std::uint16_t* column, const PatchScale& scale);
/// The same, and the squares of `old` taken away.
void slide_squares(const std::int16_t* a, const std::int16_t* b, const std::int16_t* old_a, const std::int16_t* old_b,
                   std::uint16_t* column, const PatchScale& scale);

/// Sums a row of columns over n neighbours along x into `row`, which holds the row that leaves the running sum
/// `patch`, and makes weights of the latter unless `weight` is null.
void sum_patch(const std::uint16_t* column, std::uint16_t* row, std::uint16_t* patch, std::uint16_t* weight,
               std::int64_t n, const PatchScale& scale);

struct Accumulators {
    std::int32_t* weighted;  ///< sum of weight x level, in 2^-8
    std::int32_t* weights;
};
struct WeightedRow {
    const std::uint16_t* weight;
    const std::int16_t* level;  ///< << 7
};
/// Adds `chunk` rows of weights and weighted levels to n voxels.
void add_chunk(const WeightedRow* terms, Accumulators to, std::int64_t n);
/// The voxel itself, whose weight is one.
void start_row(const std::int16_t* level, Accumulators to, std::int64_t n);

inline std::uint8_t level_of(std::int32_t weighted, std::int32_t weights)
{
    return static_cast<std::uint8_t>(
        std::min<std::int64_t>(255, (std::int64_t{256} * weighted + weights / 2) / weights));
}

}  // namespace craze::images
