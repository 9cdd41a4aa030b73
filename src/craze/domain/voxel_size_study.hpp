// Does the thickness of cracks depend on the voxel size? The study of [Fig. 16].

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/domain/discretisation.hpp"
#include "craze/domain/thickness.hpp"
#include "craze/microstructure/microstructure.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::domain {

/// The microstructure as a coarser microscope would give it: gray levels are means over blocks of factor^3 voxels, void
/// is what lies below the same S, a block is pore where at least half of it is. What does not fill a block is cut off.
/// @throws InvalidInput  when factor is below 1 or larger than the stack
microstructure::Microstructure coarsened(const microstructure::Microstructure& micro, std::int64_t factor);

/// Thicknesses of the same cut bonds at one voxel size.
struct VoxelSizeResult {
    double voxel_size = 0.0;     ///< m
    std::vector<double> T1, T2;  ///< m, one per cut bond of the dense domain, in the order of bonds
};

/// T1 and T2 of the bonds that are cut, measured again at `factors` times the voxel size [Fig. 16].
std::vector<VoxelSizeResult> voxel_size_study(const Discretisation& discretisation,
                                              const microstructure::Microstructure& micro,
                                              std::span<const std::int64_t> factors, double r_tilde = 0.345,
                                              CountedVoid counted = CountedVoid::crack);

/// For each voxel size: medians, and histograms of bars of 4 nm up to 400 nm as [Fig. 16] draws them.
Json as_json(const std::vector<VoxelSizeResult>& study);

/// What Eq. 15 gives for a slab of thickness T (m), square to an axis of the voxels, at most one voxel thick, on
/// average over where it lies: matter has the gray level `matter`, void `empty`, and voxels mix them by volume. T2 is T
/// itself only where empty = 0 and matter = S: darker voids and an S near the matter mean less bias.
double expected_T2_of_slab(double T, double voxel_size, double matter, double empty, double threshold);

}  // namespace craze::domain
