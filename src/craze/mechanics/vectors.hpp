// Long vectors: sums whose bits do not depend on the number of threads.

#pragma once

#include <cstdint>
#include <span>

namespace craze::mechanics {

/// a . b
double dot(std::span<const double> a, std::span<const double> b);
/// y += s x
void add_scaled(std::span<double> y, double s, std::span<const double> x);
/// y = x + s y
void scale_and_add(std::span<double> y, double s, std::span<const double> x);
/// u += s p and r -= s q in one go; gives the weighted square of the new r: forces^2 + (inv_radius moments)^2.
double step_and_measure(double s, std::span<const double> p, std::span<const double> q, double inv_radius,
                        std::span<double> u, std::span<double> r);
/// forces^2 + (inv_radius moments)^2 of rows of six.
double weighted_square(std::span<const double> r, double inv_radius);

}  // namespace craze::mechanics
