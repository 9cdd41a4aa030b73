// One loading of one specimen: which sides move, how far, how fast, and when to stop.

#pragma once

#include "craze/domain/discretisation.hpp"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace craze::loading {

/// What happens to the two sides across one axis. A driven pair is moved apart symmetrically or from one side only
/// (no difference but a rigid motion); tangential motion is free, so sides slide as on rollers [Figs. 17, 20].
struct Drive {
    bool free = true;     ///< both sides unloaded; else the axis has strain `factor` times the program's
    double factor = 0.0;  ///< 0: held at its length

    friend bool operator==(const Drive&, const Drive&) = default;
};

enum class Solver {
    equilibrium,  ///< states of rest, one per point: elastic, closing of cracks
    motion,       ///< Newton's law, slowly driven and damped: cracking
};

/// A loading: the program's strain goes along `path` from 0, the three axes follow as `drive` says.
struct Loading {
    enum class Kind { modulus, uniaxial, triaxial, fracture, cycles, program };

    Kind kind = Kind::uniaxial;
    std::string name;  ///< unique: "both, uniaxial z, compression"
    domain::Defects specimen;
    std::array<Drive, 3> drive;
    int axis = 2;              ///< axial direction of uniaxial loadings: 0, 1, 2
    std::vector<double> path;  ///< program strain of each point, positive in tension; the start 0 is implied
    Solver solver = Solver::equilibrium;

    double strength =
        std::numeric_limits<double>::infinity();  ///< sigma_failure, Pa; infinite: bonds never break [Eq. 24]
    double bending_share = 1.0;  ///< of the bending stress that counts towards the strength; 1 as printed [Eq. 24]
    /// Motion, wave crossings of the axial edge, > 0: duration of the whole path or, where bonds can break, of a strain
    /// of sigma_failure / E_B.
    double crossings = 40.0;
    double local_damping = 0.1;  ///< motion: beta, share of the force out of balance that opposes motion, [0, 1)
    double damping = 0.0;        ///< motion: mass damping, times the reference 0.4 (2 pi c / L)
    double stop_drop = 1.0;      ///< ends after the axial stress has fallen by this share of its peak; 1: never
    double stop_damage = 1.0;    ///< ends when this share of the beams has broken; 1: never
};

/// @throws InvalidInput  when nothing is driven, a number is not finite or an edge would lose or gain half of its
/// length; says
///                       which loading and what would do
void check(const Loading& loading);

/// The name of the twin of a fracture loading that is run at half its rate: "... 1/2 rate", then "... 1/4 rate".
std::string half_rate_name(const std::string& name);

/// Strain s of the program at which a triaxial drive has compacted the box to density eta = (V0 - V)/V [Eqs. 20, 21].
/// @throws InvalidInput  when no shortening of the driven axes gives this density
double strain_at_density(const std::array<Drive, 3>& drive, double eta);

}  // namespace craze::loading
