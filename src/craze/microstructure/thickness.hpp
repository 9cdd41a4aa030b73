// Local thickness: how wide is the void here?

#pragma once

#include "craze/microstructure/labels.hpp"

#include <cstdint>
#include <vector>

namespace craze::microstructure {

/// For each voxel the diameter of the largest lattice ball that lies in the set and covers it (Hildebrand and
/// Rueegsegger, J. Microsc. 185 (1997) 67), in steps.
struct Thickness {
    Volume<std::uint8_t> level;  ///< 0 outside the set, else index into `diameter`
    std::vector<double>
        diameter;  ///< px, ascending; diameter[0] = 0. A plate of n voxels
                   ///< has diameter n for odd n and n - 1 for even n: balls have their centre in a voxel.
};

/// @param squared  squared distance of each voxel to the outside of the set, px^2 (0: outside)
/// @param step     px, at least 0.25: between the radii tried; widened so that no more than 255 are
Thickness local_thickness(const Volume<std::int32_t>& squared, double step);

/// Voxels of `part` at each level of the thickness, shape of `diameter`.
std::vector<std::int64_t> thickness_histogram(const Thickness& thickness, const Mask& part);

/// Mean over the voxels of each component, px, shape (count,).
std::vector<double> mean_thickness(const Thickness& thickness, const Components& components);

/// The diameter that a share q of the voxels does not exceed; 0 for an empty histogram.
double thickness_quantile(const Thickness& thickness, const std::vector<std::int64_t>& histogram, double q);

}  // namespace craze::microstructure
