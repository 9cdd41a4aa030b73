// How much void there is, and where [2.6] [Eq. 1] [Eq. 2].

#pragma once

#include "craze/microstructure/microstructure.hpp"

#include <array>
#include <vector>

namespace craze::microstructure {

/// Porosity from densities, p = 1 - rho / rho_D [Eq. 1].
/// @throws InvalidInput  unless 0 < rho <= rho_D
double apparent_porosity(double rho, double rho_D);

/// Fraction of voxels in the set, p_vx = N_black / N_tot [Eq. 2].
double porosity(const Mask& void_mask);

/// Porosity of pores and of cracks; total is their sum.
struct Porosity {
    double pores = 0.0, cracks = 0.0;
    double total() const { return pores + cracks; }
};

Porosity porosity(const Microstructure& micro);

/// Porosity of each slice of voxels across an axis.
struct PorosityProfiles {
    std::array<std::vector<Porosity>, 3> along;  ///< along x, y, z: shape (nx,), (ny,), (nz,)
};

PorosityProfiles porosity_profiles(const Microstructure& micro);

/// How the porosity of cubic sub-volumes scatters: is the volume representative?
struct Scatter {
    std::int64_t edge = 0;   ///< px
    std::int64_t cubes = 0;  ///< disjoint cubes that fit, centred in the volume
    Porosity mean;
    double pores_deviation = 0.0, cracks_deviation = 0.0, total_deviation = 0.0;  ///< standard deviations (n - 1)
};

/// Cubes of edge 16, 32, 64, ... px as long as at least two fit.
std::vector<Scatter> porosity_scatter(const Microstructure& micro);

/// Edge from which the total porosity of a cube would scatter by less than `share` of its mean, px, by the power law
/// that fits the scatter of the measured sizes with at least 8 cubes; 0 where fewer than two sizes can tell.
double representative_edge(const std::vector<Scatter>& scatter, double share);

}  // namespace craze::microstructure
