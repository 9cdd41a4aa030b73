// How much crack there is, which way it faces, how far it gapes, and what the single cracks are.

#pragma once

#include "craze/core/mask.hpp"
#include "craze/mesh/crack_surface.hpp"
#include "craze/mesh/quality.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace craze::mesh {

/// Symmetric tensor, in the order xx, yy, zz, yz, xz, xy.
using Tensor = std::array<double, 6>;

/// A connected part of the surface.
struct SingleCrack {
    double area = 0.0;      ///< m2, one face, staircases of voxels smoothed out
    double radius = 0.0;    ///< a, m, of the disc of this area
    double opening = 0.0;   ///< mean over the area, m
    Tensor fabric{};        ///< mean of n n over its area; trace 1 (0 without area)
    double flatness = 0.0;  ///< share of `fabric` along `normal`: 1 flat, 1/3 facing everywhere
    Vec3 centre;            ///< m
    Vec3 normal;            ///< unit, z >= 0: principal direction of the normals
    Vec3 least, most;       ///< corners of its box, m
    std::int64_t triangles = 0;
    bool at_border = false;       ///< reaches the border of the volume: larger than it looks
    std::array<bool, 3> spans{};  ///< reaches both borders along x, y, z
};

/// Crack surface in classes of direction of its normal, z >= 0. Equal steps of the cosine of the angle to z times
/// equal steps of the azimuth (from x to y): every class is the same piece of the half sphere.
struct PoleFigure {
    static constexpr int rings = 18, sectors = 72;
    std::array<double, rings * sectors> share{};  ///< of the area, sum 1; index sector + sectors * ring, ring 0 at z

    /// 1 everywhere if cracks faced everywhere alike.
    double times_uniform(int ring, int sector) const
    {
        return share[static_cast<std::size_t>(sector + sectors * ring)] * rings * sectors;
    }
};

/// Directions of the lines that cracks draw on sections of the volume, by length.
struct Rose {
    static constexpr int bins = 36;
    /// Share of the length in [5 k, 5 (k + 1)) degrees, sum 1. [0]: on sections perpendicular to x, degrees from y to
    /// z; [1]: to y, from x to z; [2]: to z, from x to y.
    std::array<std::array<double, bins>, 3> share{};
};

/// Crack area in classes of opening.
struct Openings {
    static constexpr double step = 0.5;  ///< px
    std::vector<double> share;           ///< of the area, class k is [k, k + 1) steps; sum 1
    double mean = 0.0;                   ///< m
    /// m: the least openings that 10, 50 and 90 % of the area do not exceed; whole twelfths of a voxel
    std::array<double, 3> quantiles{};
};

struct CrackMeasures {
    double voxel_size = 0.0;     ///< h, m
    double volume = 0.0;         ///< of the stack, m3
    double triangle_area = 0.0;  ///< m2, of the triangles as they are (each sheet once): includes their staircases
    double area = 0.0;           ///< m2, one face, smoothed
    double crack_density = 0.0;  ///< sum of a^3 / V over the single cracks (Budiansky, O'Connell 1976, for discs)
    /// Sum of a^3 F / V, F the single crack's `fabric`: for discs F = n n (Kachanov 1980), and a network counts in all
    /// directions that it faces, by area. Its trace is crack_density.
    Tensor density_tensor{};
    Tensor fabric{};                  ///< mean of n n over the area; trace 1
    double largest_share = 0.0;       ///< of the area, in the largest single crack
    std::array<bool, 3> spans{};      ///< a single crack goes through the volume along x, y, z
    std::vector<SingleCrack> cracks;  ///< largest first
    PoleFigure poles;
    Rose rose;
    Openings openings;
    MeshQuality quality;
    std::vector<std::int32_t> crack_of;  ///< per triangle: index into cracks
    std::vector<float> opening_of;       ///< per triangle, m
};

/// @param crack       voxels of cracks that the surface was made of; the opening is their chord along the normal
/// @param voxel_size  h, m
CrackMeasures measure(const CrackSurface& surface, const Mask& crack, double voxel_size);

}  // namespace craze::mesh
