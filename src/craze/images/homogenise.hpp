// Shading removed: resample along the gradient, bring each layer to the same level (Taillon) [2.3 (4)].

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/core/volume.hpp"
#include "craze/images/settings.hpp"
#include "craze/images/solid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::images {

/// Learns the shading from the slices of a volume, in any order, then removes it from each.
/// Pass 1: fit(z, slice) for all slices (needed for axis gradient only). Pass 2: learn(z, slice). Then settle(), then
/// remove(z, slice). Each call uses all threads; the order of the calls does not matter.
class Homogeniser {
public:
    /// @param histogram  of the whole volume
    Homogeniser(Shape shape, const Homogenise& settings, const Histogram& histogram);

    void fit(std::int64_t z, std::span<const std::uint8_t> slice);
    void learn(std::int64_t z, std::span<const std::uint8_t> slice);
    void settle();
    void remove(std::int64_t z, std::span<const std::uint8_t> slice, std::span<std::uint8_t> to) const;

    /// Gray levels per voxel, as fitted.
    Vec3 gradient() const { return gradient_; }
    /// Direction of the layers, a unit vector.
    Vec3 direction() const { return direction_; }
    /// Level of each layer, one voxel thick, from the first corner on.
    const std::vector<double>& profile() const { return profile_; }

private:
    void choose_direction();
    double position(double x, double y, double z) const;  // in layers
    void gather_counts();
    float correction_at(double layer) const;
    void corrections_of_row(double start, std::span<float> to) const;

    Shape shape_;
    Homogenise settings_;
    Solid solid_;
    std::vector<double> moments_;  // sums for the plane fit
    Vec3 gradient_, direction_;
    double start_ = 0.0;
    std::int64_t layers_ = 0;
    std::vector<Histogram> layer_;
    std::vector<double> profile_;
    std::vector<float> correction_;                   // at each layer, the last one twice
    static constexpr double least_step = 0.01;        // layers per voxel
    std::vector<float> steps_;                        // correction at multiples of the step of a row, if long enough
    std::vector<std::vector<std::uint32_t>> counts_;  // of each thread
};

}  // namespace craze::images
