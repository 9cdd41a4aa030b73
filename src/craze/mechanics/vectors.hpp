// Long vectors: sums whose bits do not depend on the number of threads.

#pragma once

#include <cstdint>
#include <span>

namespace craze::mechanics {

/// a . b
double dot(std::span<const double> a, std::span<const double> b);
/// y += s x
void add_scaled(std::span<double> y, double s, std::span<const double> x);
/// forces^2 + (inv_radius moments)^2 of rows of six.
double weighted_square(std::span<const double> r, double inv_radius);

}  // namespace craze::mechanics
