// How much of each voxel is void: exact for a flat face through the voxel, so a crack far thinner than a voxel leaves
// the right partial gray.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/core/volume.hpp"
#include "craze/synth/coating.hpp"

#include <span>

namespace craze::synth {

/// Share of the cube [-1/2, 1/2]^3 where normal . x < distance; `normal` has unit length.
double share_below_plane(const Vec3& normal, double distance);

/// Grid of voxels of one slice: voxel (x, y) has its centre at origin + (x, y, 0) h.
struct SliceGrid {
    std::int64_t nx = 0, ny = 0;
    double h = 0.0;  ///< m
    Vec3 origin;     ///< centre of voxel (0, 0), m
};

/// Void shares of one slice, [0, 1] each, shape (nx ny), x fastest: of pores, and of cracks outside pores.
/// Where several defects meet in a voxel they are taken as independent: 1 - (1 - f)(1 - g).
void render_slice(const Coating& coating, const SliceGrid& grid, std::span<float> pore, std::span<float> crack);

/// Porosities as shares of the whole volume.
struct Porosity {
    double total = 0.0, pores = 0.0, cracks = 0.0;
};

/// Void shares summed over a grid of voxels of edge `h` that fills the box (edges are cut to whole voxels).
Porosity porosity(const Coating& coating, double h);

}  // namespace craze::synth
