// A domain made ready for the bond kernel: who is bonded to whom, in which direction, how stiffly.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/domain/domain.hpp"
#include "craze/mechanics/laws.hpp"

#include <cstdint>
#include <vector>

namespace craze::mechanics {

/// Pairs that push along their line of centres when their gap is used up; structure of arrays, i < j, sorted by (i, j).
struct FreeContacts {
    std::vector<std::int32_t> i, j;
    std::vector<double> tx, ty, tz;  ///< unit vector i -> j at rest
    std::vector<double> distance;    ///< d_0, of the centres at rest, m
    std::vector<double> gap;         ///< d_0 - contact_distance(...), m, >= 0
    std::vector<std::uint8_t> cut;   ///< 1: a crack runs between them

    std::int32_t size() const { return static_cast<std::int32_t>(i.size()); }
};

/// Elements and bonds, structure of arrays; element e and bond b are those of the domain. Constant while it is loaded:
/// displacements, and beams that break, belong to the State.
struct Lattice {
    Vec3 box;                            ///< edges at rest, m
    std::vector<double> x, y, z, r;      ///< centres at rest and radii, m, shape (n,)
    std::vector<std::int32_t> i, j;      ///< ends of bonds, i < j, sorted by (i, j), shape (m,)
    std::vector<double> tx, ty, tz;      ///< unit vector i -> j at rest
    std::vector<double> length;          ///< L_0, m
    std::vector<double> inv_length;      ///< 1 / L_0, 1/m
    std::vector<double> thickness;       ///< T, m, 0 for beams
    std::vector<domain::BondKind> kind;  ///< at rest
    std::vector<std::int32_t> first;     ///< bonds with i = e are [first[e], first[e + 1]), shape (n + 1,)
    FreeContacts free;
    BeamMaterial material;
    BeamSection section;
    double mean_radius = 0.0;        ///< R_DE, m
    double contact_stiffness = 0.0;  ///< K_C of free contacts, N/m [Eq. 7]
    double density = 0.0;            ///< of the elements, kg/m3 (rho_D box / dense_volume)

    std::int32_t elements() const { return static_cast<std::int32_t>(r.size()); }
    std::int32_t bonds() const { return static_cast<std::int32_t>(i.size()); }
    Vec3 centre(std::int32_t e) const
    {
        const auto k = static_cast<std::size_t>(e);
        return {x[k], y[k], z[k]};
    }
};

/// @param rho_D  density of the dense ceramic, kg/m3; that of the elements follows from it [Eq. 12]
/// @throws InvalidInput  when there is no element or no bond, a number is not finite, bonds are not sorted with i < j,
///                       a T is not in [0, L_0], or the material makes no sense; it names the culprit
Lattice make_lattice(const domain::Domain& domain, const BeamMaterial& material, double rho_D = DenseMaterial{}.rho_D);

}  // namespace craze::mechanics
