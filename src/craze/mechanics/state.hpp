// What changes while a lattice is loaded.

#pragma once

#include "craze/mechanics/lattice.hpp"

#include <cstdint>
#include <vector>

namespace craze::mechanics {

/// Six numbers per element, one after the other: displacement x, y, z (m), then rotation about x, y, z (rad).
/// Number c of element e is at 6 e + c.
struct State {
    std::vector<double> u;               ///< shape (n, 6)
    std::vector<domain::BondKind> kind;  ///< of each bond now: a beam that broke is a contact beam of T = 0, shape (m,)

    Vec3 displacement(std::int32_t e) const
    {
        const auto k = 6 * static_cast<std::size_t>(e);
        return {u[k], u[k + 1], u[k + 2]};
    }
    Vec3 rotation(std::int32_t e) const
    {
        const auto k = 6 * static_cast<std::size_t>(e) + 3;
        return {u[k], u[k + 1], u[k + 2]};
    }
};

/// Nothing has moved.
State rest_state(const Lattice& lattice);

/// Displacement strain_k (x_k - origin_k) along each axis k, no rotation: a good start for a solver.
State affine_state(const Lattice& lattice, const Vec3& strain, const Vec3& origin = {});

}  // namespace craze::mechanics
