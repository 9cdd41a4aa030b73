// Random numbers that depend on (seed, stream, counter) only: any thread can draw any of them.

#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace craze {

/// A finaliser of 64 bits with full avalanche (splitmix64; Steele, Lea, Flood 2014).
constexpr std::uint64_t mixed(std::uint64_t z)
{
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// A sequence of its own for each (seed, stream); a stream can be an element, a voxel row, a defect.
class Random {
public:
    constexpr explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
        : key_(mixed(seed ^ mixed(stream ^ 0x6a09e667f3bcc909U)))
    {
    }

    constexpr std::uint64_t bits() { return mixed(key_ + 0xd1342543de82ef95U * ++counter_); }
    /// Uniform in [0, 1).
    constexpr double uniform() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
    constexpr double uniform(double least, double most) { return least + (most - least) * uniform(); }
    /// Uniform in [0, n).
    constexpr std::int64_t below(std::int64_t n)
    {
        return static_cast<std::int64_t>(uniform() * static_cast<double>(n));
    }
    /// Mean 0, standard deviation 1.
    double normal()
    {
        const double u = 1.0 - uniform();
        return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
    }
    double lognormal(double median, double log_sigma) { return median * std::exp(log_sigma * normal()); }

private:
    std::uint64_t key_, counter_ = 0;
};

}  // namespace craze
