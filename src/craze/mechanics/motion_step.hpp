// One step of a few elements: kick, drift, turn.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/mechanics/motion.hpp"

#include <cstdint>
#include <vector>

namespace craze::mechanics {

/// Elements are handled in chunks of this many rows; arrays are padded to whole chunks.
inline constexpr std::int64_t chunk_rows = 64;

/// Per element, padded: masses (0 and inverse 0 in the pad) and places at rest relative to the centre of the box.
struct Rows6 {
    std::vector<double> mass, inv_mass, moment, inv_moment;
    std::vector<double> x, y, z;
};

struct StepConstants {
    Geometry geometry = Geometry::corotational;
    double dt = 0.0, damping = 0.0;  ///< s, 1/s
    double local_damping = 0.0;
    Vec3 rate;  ///< of the affine velocity, 1/s
};

struct StepSums {
    double damping = 0.0;     ///< energy taken, J
    double speed_2 = 0.0;     ///< largest squared speed off the affine velocity, m2/s2
    double all_speeds = 0.0;  ///< their sum: not finite where one is not
};

/// Half a step ago -> half a step ahead for velocities (n, 6), now -> next for poses (n, 8), rows [begin, end), whole
/// fours.
/// @param force  shape (n, 8), the last two unused
StepSums step_rows(const StepConstants& c, const Rows6& rows, std::int64_t begin, std::int64_t end, const double* force,
                   double* velocity, const double* pose, double* pose_next);

/// The pose of one element after dt at a given velocity (row of six).
void move_row(const StepConstants& c, const double* velocity, const double* pose, double* pose_next);

}  // namespace craze::mechanics
