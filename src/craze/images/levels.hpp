// The raw stack as 8-bit gray levels, cropped.

#pragma once

#include "craze/images/settings.hpp"
#include "craze/io/volume_file.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace craze::images {

/// Slices of the source as 8-bit levels. One thread at a time.
class LevelSource {
public:
    /// Opens the source and, for 16 bits and floats, reads it once to find the window.
    /// @throws InvalidInput  naming the file or key
    explicit LevelSource(const Settings& settings);

    /// After the crop.
    const Shape& shape() const { return shape_; }
    /// m, along x, y, z; as the settings say, else as the file says.
    const Vec3& voxel_size() const { return voxel_size_; }
    /// Levels of the source that become 0 and 255.
    double low() const { return low_; }
    double high() const { return high_; }
    void read(std::int64_t z, std::span<std::uint8_t> to);

private:
    void find_window(const Window& window);
    void crop(const std::vector<std::int64_t>& box);
    void find_voxel_size(const Settings& settings);

    std::unique_ptr<io::VolumeReader> reader_;
    Shape shape_;
    std::int64_t x0_ = 0, y0_ = 0, z0_ = 0;
    Vec3 voxel_size_;
    double low_ = 0.0, high_ = 255.0;
    std::vector<std::byte> raw_;
};

}  // namespace craze::images
