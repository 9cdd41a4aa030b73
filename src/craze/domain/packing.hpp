// A dense random packing of spheres: the compact material before it is bonded [3.1.1].

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/domain/domain.hpp"

#include <cstdint>

namespace craze::domain {

/// What makes two packings the same material, whatever their box.
struct Recipe {
    double mean_radius = 200e-9;  ///< R_DE, m, > 0
    double half_width = 0.125;    ///< radii are uniform in R_DE (1 -+ half_width); [0, 0.9]
    double density = 0.0;         ///< elements per R_DE^3 away from walls; 0: the paper's 92 000 in its box
    bool periodic = false;        ///< opposite faces touch; else six rigid walls
    std::uint64_t seed = 1;
};

/// How the minimisation ended.
struct PackingReport {
    std::int64_t iterations = 0;
    double residual = 0.0;  ///< RMS net force over mean contact force
    double overlap = 0.0;   ///< mean of the overlaps over 2 R_DE
    bool settled = false;   ///< false: stopped at the greatest number of steps
    double seconds = 0.0;
};

/// Elements of the recipe that fill the box: N = density (V - 0.25 S R_DE) / R_DE^3 for volume V and wall area S, since
/// elements pack more loosely at walls.
/// @throws InvalidInput  when the box is not positive and finite, or makes no element or more than 2e9
std::int64_t element_count(const Vec3& box, const Recipe& recipe);

/// Packs the box: random centres, then FIRE minimisation (Bitzek et al. 2006) of the harmonic energy of overlaps
/// with each other and the walls. Sorted along a Morton curve. The same bits on any number of threads.
/// In a periodic packing all centres lie in the box, spheres reach through its faces.
/// @param report  out, if given: how the minimisation ended
Elements pack_elements(const Vec3& box, const Recipe& recipe, PackingReport* report = nullptr);

}  // namespace craze::domain
