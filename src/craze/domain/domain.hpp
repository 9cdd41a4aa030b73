// Spheres and bonds that stand for the matter: the value that `domain` gives.

#pragma once

#include "craze/core/vec3.hpp"

#include <cstdint>
#include <vector>

namespace craze::domain {

/// Discrete elements, structure of arrays, shape (n,). Sorted along a Morton curve of their centres, so that
/// elements near in space are near in memory.
struct Elements {
    std::vector<double> x, y, z;  ///< centre, m
    std::vector<double> r;        ///< radius, m, > 0

    std::int32_t size() const { return static_cast<std::int32_t>(r.size()); }
    Vec3 centre(std::int32_t e) const
    {
        const auto k = static_cast<std::size_t>(e);
        return {x[k], y[k], z[k]};
    }
};

enum class BondKind : std::uint8_t {
    beam = 0,          ///< cohesive Euler-Bernoulli beam [3.1]
    contact_beam = 1,  ///< cut by a crack: pushes below L_C = L_0 - T, never pulls [Eq. 13]
};

/// Bonds, shape (n,), i < j, sorted by (i, j), no pair twice.
struct Bonds {
    std::vector<std::int32_t> i, j;  ///< elements
    std::vector<BondKind> kind;
    std::vector<double> thickness;  ///< T, m, 0 <= T <= L_0; 0 for beams

    std::int32_t size() const { return static_cast<std::int32_t>(i.size()); }
};

/// Pairs without a bond that are near enough to touch under load, i < j, sorted: free contact [Eq. 5].
/// A pair that straddles a crack touches only when the crack's thickness is used up.
struct NearPairs {
    std::vector<std::int32_t> i, j;
    std::vector<double> thickness;  ///< T of the crack between them, m, 0 where there is none

    std::int32_t size() const { return static_cast<std::int32_t>(i.size()); }
};

/// A bonded discrete element model at rest in the box [0, size] along each axis. Constant while it is loaded.
struct Domain {
    Vec3 box;  ///< edges, m
    Elements elements;
    Bonds bonds;
    NearPairs near;
    double mean_radius = 0.0;   ///< R_DE of the dense packing, m: beams have R_B = r~ R_DE [Eq. 3]
    double dense_volume = 0.0;  ///< sum of sphere volumes of the dense packing, m3: the elements' density is
                                ///< rho_D box / dense_volume, before and after pores are carved [Eq. 12]
};

/// Rest length L_0 of bond b: the distance of its centres, m.
inline double rest_length(const Domain& domain, std::int32_t b)
{
    const auto k = static_cast<std::size_t>(b);
    return norm(domain.elements.centre(domain.bonds.j[k]) - domain.elements.centre(domain.bonds.i[k]));
}

}  // namespace craze::domain
