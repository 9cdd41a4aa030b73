// Forces of a lattice in a given state, small displacements.

#pragma once

#include "craze/mechanics/contacts.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/state.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <vector>

namespace craze::mechanics {

struct Forces {
    std::vector<double> force;  ///< of the lattice on each element, shape (n, 6), N and N m
    double energy = 0.0;        ///< elastic, J
    double scale = 0.0;         ///< root of the summed squares of what bonds and contacts exert on their ends, moments
                                ///< over R_DE, N: the measure of what out-of-balance forces are small against
    std::int64_t closed = 0;    ///< contact beams that push
    std::int64_t open = 0;      ///< contact beams that do not
    std::int64_t touching = 0;  ///< free contacts that push
};

/// Forces of all bonds, and of unbonded neighbours if `free_contacts` [Eq. 5].
/// @throws InvalidInput  when the state does not belong to the lattice
Forces forces(const Lattice& lattice, const State& state, bool free_contacts = true);

/// The same with what the kinds of the state's bonds make at hand.
Forces forces(const Lattice& lattice, const State& state, const Stiffness& stiffness,
              const UnilateralContacts& contacts);

/// Square of Forces::scale that beams bring.
double beam_force_square(const Lattice& lattice, const State& state);

/// What each bond bears, shape (m,). A contact beam bears N <= 0 alone.
struct BondLoads {
    std::vector<double> N;        ///< normal force, N, positive in tension
    std::vector<double> T;        ///< torque, N m
    std::vector<double> bending;  ///< larger of the end bending moments, N m
    std::vector<double> rankine;  ///< Pa [Eq. 24]; that of a contact beam is 0
};
BondLoads bond_loads(const Lattice& lattice, const State& state);

}  // namespace craze::mechanics
