// Voxels of unequal edges become cubes.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/core/volume.hpp"
#include "craze/images/quality.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace craze::images {

/// Resamples slices to cubes whose edge is the shortest of the three, by cubic (Catmull-Rom) interpolation along each
/// axis; at the faces the last value counts. Voxel centres: output i reads the source at (i + 1/2) edge / size - 1/2.
class CubicVoxels {
public:
    CubicVoxels(Shape shape, const Vec3& voxel_size, SliceReader read);

    bool needed() const { return !(target_ == source_); }
    const Shape& shape() const { return target_; }
    double edge() const { return edge_; }
    /// Output slice z; ascending z reads each source slice once.
    void read(std::int64_t z, std::span<std::uint8_t> to);

private:
    const std::vector<float>& source_slice(std::int64_t z);

    Shape source_, target_;
    Vec3 voxel_size_;
    double edge_;
    SliceReader read_;
    std::map<std::int64_t, std::vector<float>> resampled_;  // source slices, already resampled along x and y
};

}  // namespace craze::images
