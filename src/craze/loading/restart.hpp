// Files from which a loading in motion goes on to the same bits.

#pragma once

#include "craze/loading/rig.hpp"
#include "craze/mechanics/motion.hpp"

#include <filesystem>

namespace craze::loading {

/// Where the drive is on its path.
struct DriveProgress {
    std::int64_t waypoint = 0;      ///< index of the next point of the path
    double s = 0.0;                 ///< program strain now
    double share = 1.0;             ///< of the full rate
    double peak = 0.0;              ///< largest axial stress so far, Pa
    double calm_energy = 0.0;       ///< J, below which kinetic energy is never called a run-away
    std::int64_t steps_before = 0;  ///< steps at the last point
    double energy_before = 0.0;     ///< J, held when the motion began
};

struct Restart {
    DriveProgress progress;
    Curve curve;  ///< up to now
    mechanics::MotionState motion;
};

/// What a restart file belongs to: lattice and loading, hashed.
std::string restart_key(const Rig& rig, const Loading& loading);

void write_restart(const std::filesystem::path& file, const Rig& rig, const Loading& loading, const Restart& restart);
/// @throws InvalidInput  when the file is damaged or belongs to something else
Restart read_restart(const std::filesystem::path& file, const Rig& rig, const Loading& loading);

}  // namespace craze::loading
