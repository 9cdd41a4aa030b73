// Stripes along the rows, removed in wavelet space.

#pragma once

#include <cstdint>
#include <span>

namespace craze::images {

/// Takes the picture (ny rows of nx) apart by Daubechies wavelets with four vanishing moments, damps the waves
/// with k <= damping along the rows in each band that is smooth along the rows and rough across them, by
/// 1 - exp(-k^2 / (2 damping^2)), and puts it together again. The picture is mirrored at its borders.
/// Bands thinner than 16 values are left alone.
void damp_stripes(std::span<float> picture, std::int64_t nx, std::int64_t ny, std::int64_t levels, double damping);

}  // namespace craze::images
