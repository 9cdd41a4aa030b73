// A dense packing together with what pores and cracks do to it: every virtual specimen of one microstructure.

#pragma once

#include "craze/domain/domain.hpp"

#include <cstdint>
#include <vector>

namespace craze::domain {

/// Cracks seen by pairs of elements (bonds or near pairs), one entry per pair in every array, shape (n,).
struct PairCracks {
    std::vector<std::uint8_t> cut;  ///< crack triangles that the line of centres meets, 255 = 255 or more; 0: not cut
    std::vector<double> T1;         ///< binary thickness [Eq. 14], m, in [0, L_0]; 0 where not cut
    std::vector<double> T2;         ///< intensity thickness [Eq. 15], m, in [0, L_0]; 0 where not cut
};

/// The dense domain, and for each of its parts whether a defect takes it.
struct Discretisation {
    Domain dense;                       ///< all elements, all bonds beams, all near pairs without thickness
    std::vector<std::uint8_t> in_pore;  ///< 1: the element's centre lies in a pore [3.3]; shape (elements,)
    PairCracks bonds;                   ///< of dense.bonds
    PairCracks near;                    ///< of dense.near
    double p_vx = 0.0;                  ///< porosity of the pores in the voxels, to set beside p_DE
};

/// Which defects a specimen has, and how thick its cracks are.
struct Defects {
    enum class Thickness {
        T1,        ///< binary [Eq. 14]
        T2,        ///< intensity [Eq. 15]: "open" in [Fig. 21]
        constant,  ///< `constant` for every crack [Fig. 22]
        closed,    ///< zero: "closed" in [Fig. 21]
    };

    bool pores = true;
    bool cracks = true;
    Thickness thickness = Thickness::T2;
    double constant = 0.0;  ///< m, >= 0; for Thickness::constant only
};

/// The specimen with these defects: elements in pores removed with their bonds and near pairs, the rest renumbered
/// in the same order; cut bonds made contact beams and cut near pairs given a thickness. {false, false} is dense.
/// A thickness above a bond's L_0 is bounded to it, with a notice [Eq. 9].
/// @throws InvalidInput  when the arrays do not fit the domain or `constant` is negative or not finite
Domain with_defects(const Discretisation& discretisation, const Defects& defects);

/// Discrete porosity p_DE = 1 - M_P / M_D: the share of sphere volume whose centres lie in pores [Eq. 12].
double discrete_porosity(const Discretisation& discretisation);

}  // namespace craze::domain
