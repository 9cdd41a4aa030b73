// A loading in motion: slowly driven, damped, with bonds that break [4.3]. Can be stopped at any moment and go on.

#pragma once

#include "craze/loading/rig.hpp"
#include "craze/mechanics/motion.hpp"

#include <filesystem>
#include <limits>

namespace craze::loading {

struct MovingOptions {
    mechanics::Geometry geometry = mechanics::Geometry::corotational;
    double kinetic_limit = 0.02;    ///< drive slows down while kinetic energy is above this share of the elastic energy
    double slowest = 1.0 / 32.0;    ///< share of the full rate that slowing down keeps
    std::filesystem::path restart;  ///< file to go on from if it is there, and to write; empty: none
    double checkpoint = 60.0;       ///< seconds between restart files; 0: only when interrupted
    std::int64_t stop_after = std::numeric_limits<std::int64_t>::max();  ///< steps, then as if interrupted: for tests
};

/// Drives the sides along the path of a loading, at the rate that `loading.crossings` states in crossings of a bar wave
/// sqrt(E_D / rho_D) along the axial edge. Where bonds can break, the motion starts from a state of rest at 0.9 of the
/// strain at which the first one does, with the velocities of rest at the full rate: no wave disturbs it. Elsewhere,
/// and after each turn of the path, the rate is reached gradually. The drive slows down when cracking runs away. Both
/// dampings act on the deviation from the affine velocity.
/// @throws ComputationFailed  when the motion cannot be followed
/// @throws InvalidInput       when the restart file belongs to another loading or specimen
/// @throws Interrupted        after writing the restart file, when asked to stop
Curve move(Rig& rig, const Loading& loading, const MovingOptions& options = {}, const Watcher& watch = {});

/// UTS or UCS of a curve: the largest axial stress in the direction of its first push. [Table 4]
Strength strength_of(const Curve& curve);

}  // namespace craze::loading
