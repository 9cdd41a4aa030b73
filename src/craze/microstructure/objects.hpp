// Single pores and single cracks: size, shape, orientation, the largest ball inside [2.4.3, Fig. 7].

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/microstructure/labels.hpp"

#include <array>
#include <vector>

namespace craze::microstructure {

/// One connected component of a mask. Lengths in px; a point is in continuous coordinates, voxel centres at x + 1/2.
struct Object {
    std::int64_t volume = 0;  ///< voxels
    /// Area towards the outside, px^2, without the sections by the border of the volume: Cauchy-Crofton over the 13
    /// directions of the lattice (Ohser, Muecklich 2000). A plane counts 0.927 (across an axis) to 1.023 of itself, by
    /// its orientation; that averages out on round bodies of some ten voxels (within 2 %), not on flat ones along an
    /// axis (up to 10 % low). Of bodies of a few voxels it says little: a single one has a sphericity of 1.6.
    double surface = 0.0;
    double equivalent_radius = 0.0;  ///< of the ball of this volume
    double sphericity = 0.0;         ///< surface of the ball of this volume / surface; meant for objects off the border
    double inscribed_radius = 0.0;   ///< largest distance of a voxel of it to matter, centre to centre [Fig. 7b]
    double mean_thickness = 0.0;     ///< mean local thickness of its voxels; set by `analyse`
    Vec3 centroid;
    Vec3 major, minor;                  ///< unit vectors of the longest and shortest axis, z >= 0
    std::array<double, 3> semi_axes{};  ///< of the ellipsoid with these second moments, longest first
    std::array<std::int32_t, 6> box{};  ///< first and last voxel along x, y, z
    bool at_border = false;             ///< cut by the border of the volume

    /// Goes through the volume along the axis (0 x, 1 y, 2 z).
    bool spans(int axis, const Shape& shape) const
    {
        const auto k = static_cast<std::size_t>(2 * axis);
        return box[k] == 0 && box[k + 1] == shape[axis] - 1;
    }
};

/// The components of a mask, in the order of their labels.
///
/// @param found     components(mask, ...)
/// @param squared   squared distance of each voxel to matter, px^2; shape of the mask
std::vector<Object> measured(const Mask& mask, const Components& found, const Volume<std::int32_t>& squared);

}  // namespace craze::microstructure
