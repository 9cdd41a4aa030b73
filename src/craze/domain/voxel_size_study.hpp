// Does the thickness of cracks depend on the voxel size? The study of [Fig. 16].

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/domain/room.hpp"
#include "craze/mesh/mesh.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace craze::domain {

/// The stack as a coarser microscope would record it: means over blocks of factor^3 voxels. What does not fill a block
/// is cut off.
/// @throws InvalidInput  when factor is below 1 or larger than the stack
images::Gray coarsened(const images::Gray& gray, std::int64_t factor);

/// Thicknesses seen at one voxel size, m.
struct VoxelSizeResult {
    double voxel_size = 0.0;               ///< m
    int threshold = 0;                     ///< S found there
    std::vector<double> T1, T2;            ///< of the bonds that are cut there, in the order of bonds
    std::vector<double> same_T1, same_T2;  ///< of the bonds that are cut at the stack's own voxel size
};

/// The stack's own voxel size, then each of `factors` times it: the stack coarsened, threshold, classification (R_C and
/// R_E of the same length), crack surface and cut bonds all made again, in the same packing [Fig. 16].
/// @param d  what `discretise` made of `micro`
/// @throws InvalidInput  when a factor does not fit the stack
/// @throws ComputationFailed, InvalidInput  when no threshold parts a coarsened stack
std::vector<VoxelSizeResult> voxel_size_study(const Discretisation& d, const microstructure::Microstructure& micro,
                                              std::span<const std::int64_t> factors,
                                              const microstructure::Settings& classes, const mesh::Settings& sheets,
                                              const Settings& settings);

/// For each voxel size: medians, and histograms of 100 bars of 4 nm as [Fig. 16] draws them, or of a multiple where T1
/// needs more room; the last bar holds all above.
Json as_json(const std::vector<VoxelSizeResult>& study);

/// `voxel_sizes.json` in `folder`.
void save(const std::vector<VoxelSizeResult>& study, const std::filesystem::path& folder);

/// What Eq. 15 gives for a slab of thickness T (m), square to an axis of the voxels, at most one voxel thick, on
/// average over where it lies: matter has the gray level `matter`, void `empty`, and voxels mix them by volume. T2 is T
/// itself only where empty = 0 and matter = S: darker voids and an S near the matter mean less bias.
double expected_T2_of_slab(double T, double voxel_size, double matter, double empty, double threshold);

}  // namespace craze::domain
