// Where a loaded lattice comes to rest: small displacements, cracks that close, no friction.

#pragma once

#include "craze/mechanics/constraints.hpp"
#include "craze/mechanics/forces.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/state.hpp"

#include <memory>
#include <optional>

namespace craze::mechanics {

struct EquilibriumOptions {
    double tolerance = 1e-6;          ///< on Equilibrium::residual
    std::int64_t iterations = 20000;  ///< most conjugate-gradient iterations in all
    int newton = 100;                 ///< most changes of the set of closed contacts
    bool free_contacts = true;        ///< let unbonded neighbours touch [Eq. 5]
    bool single = true;               ///< search in single precision, in double where that stalls; or in double only
};

struct Equilibrium {
    State state;
    Forces forces;                ///< at imposed degrees of freedom they are minus the reactions of what imposes
    double residual = 0.0;        ///< see EquilibriumSolver
    std::int64_t iterations = 0;  ///< conjugate gradients
    int newton = 0;               ///< linear systems solved: 1 where nothing opens or closes
    std::int64_t in_double = 0;   ///< those of the iterations that needed double precision
};

/// Finds equilibria of one lattice; keeps what can be reused from one load to the next.
///
/// With unilateral contact, without friction and in small displacements, equilibrium is the minimum of a convex,
/// piecewise quadratic energy: semi-smooth Newton with exact line search, each linear system by preconditioned
/// conjugate gradients. Elements without bonds and fragments that nothing holds stay where they are.
///
/// The residual is the norm of what is out of balance at the free degrees of freedom over the norm of the forces that
/// bonds and contacts exert on their ends (moments counted over R_DE), or over a millionth of the largest such norm met
/// on the way where a specimen bears next to nothing. Where the tolerance asks for less than the last digit of the
/// displacements weighs, that digit is what is reached.
class EquilibriumSolver {
public:
    explicit EquilibriumSolver(const Lattice& lattice, EquilibriumOptions options = {});
    ~EquilibriumSolver();
    EquilibriumSolver(EquilibriumSolver&&) noexcept;
    EquilibriumSolver& operator=(EquilibriumSolver&&) noexcept;

    /// @param start  where to begin, with the kind each bond has now: the previous equilibrium, an affine state or rest
    /// @param tolerance  none: that of the options
    /// @throws InvalidInput       when a number is not finite or shapes disagree
    /// @throws ComputationFailed  when the tolerance is not reached, with the residual that was and what to try
    Equilibrium solve(const Constraints& constraints, State start, std::optional<double> tolerance = {});

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

/// One equilibrium from one start.
Equilibrium equilibrate(const Lattice& lattice, const Constraints& constraints, State start,
                        const EquilibriumOptions& options = {});

}  // namespace craze::mechanics
