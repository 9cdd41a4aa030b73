// Masses, and the longest step they allow.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/motion.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <span>
#include <vector>

namespace craze::mechanics {

struct Inertia {
    std::vector<double> mass;    ///< kg, shape (n,)
    std::vector<double> moment;  ///< moment of inertia, kg m2, shape (n,)
};
Inertia inertia(const Lattice& lattice, Mass mass);

/// Largest eigenvalue of M^-1 K, 1/s2: an upper bound, not more than one in a thousand too high, by Lanczos iterations.
/// @throws ComputationFailed  when they do not converge
double largest_eigenvalue(const Stiffness& stiffness, const Inertia& inertia);

}  // namespace craze::mechanics
