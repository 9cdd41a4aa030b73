// Spheres that push each other apart: the mechanics of packing. Lengths in R_DE, stiffness and mass 1.

#pragma once

#include "craze/core/vec3.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::domain {

/// Harmonic spheres between six rigid walls or in a periodic box. Every result has the same bits on any number of
/// threads. Positions are whole numbers of 2^-30 (walls) or 2^-32 (periodic) of the box edge: differences are exact
/// and a periodic box needs no wrapping.
class Spheres {
public:
    /// Sums over all spheres.
    struct Sums {
        double power = 0.0, force2 = 0.0, speed2 = 0.0;  ///< F.v, F.F, v.v
        double overlap = 0.0;                            ///< of all contacts, each counted from both sides
        double most = 0.0;                               ///< greatest overlap over the sum of the two radii
        std::int64_t contacts = 0;                       ///< each counted from both sides
    };

    /// @param stiffening  a contact whose overlap is 2 % of the radii or more is 1 + stiffening times as stiff
    Spheres(const Vec3& box, bool periodic, std::span<const Vec3> centres, std::span<const double> radii,
            double stiffening);

    std::int64_t size() const { return size_; }
    Vec3 centre(std::int64_t k) const;

    /// Finds the neighbours of every sphere up to `skin` beyond touching. They stay valid until a sphere has moved by
    /// half of it.
    void list_neighbours(double skin);

    /// Forces from where the spheres are. Spheres that nothing touches stop.
    Sums push();

    /// v <- keep v + steer F, x <- x + dt v, no sphere by more than 0.25 along an axis; what left a periodic box comes
    /// back in, walls give way. The greatest distance from where neighbours were last listed.
    double advance(double keep, double steer, double dt);

private:
    // One register's worth of memory: a whole sphere.
    struct alignas(16) Sphere {
        std::int32_t x, y, z;
        float r;
    };
    struct Kernels;

    Vec3 box_, unit_;  // R_DE per step of a coordinate
    bool periodic_;
    double r_most_ = 0.0;
    float stiffening_;
    std::int64_t size_, slices_;
    std::vector<Sphere> at_;                       // whole slices, then one that touches nothing
    std::vector<float> velocity_, force_;          // of each slice: 8 x, 8 y, 8 z
    std::vector<std::int32_t> listed_at_;          // likewise
    std::vector<std::vector<std::int32_t>> near_;  // of each block: by slice, neighbour, lane
    std::vector<std::uint32_t> begin_;             // within the block's list, of each slice; one more a block
};

}  // namespace craze::domain
