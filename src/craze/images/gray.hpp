// What the microscope saw, cleaned: the value that `images` gives.

#pragma once

#include "craze/core/volume.hpp"

#include <cstdint>

namespace craze::images {

/// Gray levels of an isotropic stack. x and y lie in the slices, z runs along the stack.
struct Gray {
    Volume<std::uint8_t> level;  ///< 0 black (void) ... 255 white (matter)
    double voxel_size = 0.0;     ///< h, m: voxel (x, y, z) has its centre at (x + 1/2, y + 1/2, z + 1/2) h
};

}  // namespace craze::images
