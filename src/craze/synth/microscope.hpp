// The faults of a FIB-SEM, each with its strength; zero switches one off.

#pragma once

#include "craze/core/schema.hpp"
#include "craze/core/vec3.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::synth {

struct Microscope {
    double matter = 165.0, void_level = 45.0;  ///< gray of full matter and of full void
    double blur = 0.5;                         ///< standard deviation of the beam in the slice, voxels
    double noise = 12.0;                       ///< standard deviation, gray levels
    double stripes = 4.0;                      ///< standard deviation of the curtains along x, gray levels
    double stripe_width = 2.0;                 ///< correlation length across the curtains, voxels
    double shading_x = 0.0, shading_y = 10.0;  ///< gray levels gained from one side of the slice to the other
    double shading_z = 0.0;                    ///< and from the first slice to the last
    double drift = 0.0;             ///< standard deviation of the step from slice to slice, voxels, along x and y
    double thickness_jitter = 0.0;  ///< standard deviation of a slice's thickness, voxels
};

void describe(Schema& schema, Microscope& microscope);

/// Weights of the blur along one axis, from -reach to +reach: the discrete Gaussian exp(-s) I_k(s), s = sigma^2, whose
/// variance is sigma^2 for narrow beams too (Lindeberg 1990). {1} for sigma = 0.
std::vector<float> beam_kernel(double sigma);

/// Where each of n slices is taken: (drift x, drift y, depth), voxels. Both walks start and end on the straight line.
std::vector<Vec3> slice_positions(const Microscope& microscope, std::int64_t n, std::uint64_t seed);

/// The recorded slice z of nz: void shares of nx x ny voxels in, gray levels out. `work` has the size of the slice.
void record_slice(const Microscope& microscope, std::span<const float> share, std::int64_t nx, std::int64_t ny,
                  std::int64_t z, std::int64_t nz, std::uint64_t seed, std::span<float> work,
                  std::span<std::uint8_t> gray);

}  // namespace craze::synth
