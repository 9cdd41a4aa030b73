// Which levels are those of the solid: what pores and cracks must not bias is measured on them alone.

#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace craze::images {

using Histogram = std::array<std::int64_t, 256>;

/// The levels of the solid: the highest peak of the histogram and its spread, from the bright side of the peak,
/// where there is no void.
struct Solid {
    double mode = 0.0;               ///< gray level
    double spread = 1.0;             ///< standard deviation, gray levels, at least 1
    double low = 0.0, high = 255.0;  ///< mode -+ 3 spreads; everything, where that holds less than half of the voxels
};
Solid solid_of(const Histogram& histogram);

/// The centre of the solid's peak to a fraction of a level: mean of the levels within 1.5 spreads of it.
double centre_of_solid(const Histogram& histogram, const Solid& start);

Histogram histogram_of(std::span<const std::uint8_t> levels);

}  // namespace craze::images
