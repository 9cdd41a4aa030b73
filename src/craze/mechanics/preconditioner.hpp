// An approximate inverse of the stiffness, which makes conjugate gradients converge in few iterations.

#pragma once

#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Inverse 6x6 block of each element. Blocks that are singular (elements held by contacts alone, or by nothing) are
/// regularised here, so that the system itself need not be.
class BlockJacobi {
public:
    /// @param imposed  degrees of freedom that do not move, ascending
    void set_up(const Stiffness& stiffness, std::span<const std::int64_t> imposed);
    /// z = D^-1 r; zero at imposed degrees of freedom.
    void apply(std::span<const double> r, std::span<double> z) const;

private:
    std::vector<float> inverse_;  ///< (n, 6, 6); an approximate inverse needs no more digits
};

}  // namespace craze::mechanics
