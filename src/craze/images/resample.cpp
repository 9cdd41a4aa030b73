#include "craze/images/resample.hpp"

#include "craze/core/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace craze::images {

namespace {

// The four values that a point between two of n lies among, and their weights.
struct Taps {
    std::array<std::int64_t, 4> at{};
    std::array<float, 4> weight{};
};

Taps taps_at(double position, std::int64_t n)
{
    const double base = std::floor(position), t = position - base;
    Taps taps;
    for (std::int64_t i = 0; i < 4; ++i)
        taps.at[static_cast<std::size_t>(i)] =
            std::clamp<std::int64_t>(static_cast<std::int64_t>(base) - 1 + i, 0, n - 1);
    taps.weight = {static_cast<float>(0.5 * t * (-1.0 + t * (2.0 - t))),
                   static_cast<float>(0.5 * (2.0 + t * t * (-5.0 + 3.0 * t))),
                   static_cast<float>(0.5 * t * (1.0 + t * (4.0 - 3.0 * t))),
                   static_cast<float>(0.5 * t * t * (t - 1.0))};
    return taps;
}

double position_of(std::int64_t i, double edge, double size)
{
    return (static_cast<double>(i) + 0.5) * edge / size - 0.5;
}

}  // namespace

CubicVoxels::CubicVoxels(Shape shape, const Vec3& voxel_size, SliceReader read)
    : source_(shape),
      voxel_size_(voxel_size),
      edge_(std::min({voxel_size.x, voxel_size.y, voxel_size.z})),
      read_(std::move(read))
{
    const auto count = [&](int axis) {
        const double ratio = voxel_size_[axis] / edge_;
        if (ratio < 1.0 + 1e-4) {
            voxel_size_[axis == 0 ? 0 : axis] = edge_;
            return source_[axis];
        }
        return std::max<std::int64_t>(1, std::llround(static_cast<double>(source_[axis]) * ratio));
    };
    target_ = {count(0), count(1), count(2)};
}

const std::vector<float>& CubicVoxels::source_slice(std::int64_t z)
{
    auto& slice = resampled_[z];
    if (!slice.empty()) return slice;
    std::vector<std::uint8_t> raw(static_cast<std::size_t>(source_.nx * source_.ny));
    read_(z, raw);
    slice.resize(static_cast<std::size_t>(target_.nx * target_.ny));
    std::vector<Taps> along(static_cast<std::size_t>(target_.nx));
    for (std::int64_t x = 0; x < target_.nx; ++x)
        along[static_cast<std::size_t>(x)] = taps_at(position_of(x, edge_, voxel_size_.x), source_.nx);
    parallel_ranges(target_.ny, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
            const Taps rows = taps_at(position_of(y, edge_, voxel_size_.y), source_.ny);
            for (std::int64_t x = 0; x < target_.nx; ++x) {
                const Taps& columns = along[static_cast<std::size_t>(x)];
                float sum = 0.0F;
                for (std::size_t j = 0; j < 4; ++j) {
                    float line = 0.0F;
                    for (std::size_t i = 0; i < 4; ++i)
                        line +=
                            columns.weight[i] *
                            static_cast<float>(raw[static_cast<std::size_t>(columns.at[i] + source_.nx * rows.at[j])]);
                    sum += rows.weight[j] * line;
                }
                slice[static_cast<std::size_t>(x + target_.nx * y)] = sum;
            }
        }
    });
    return slice;
}

void CubicVoxels::read(std::int64_t z, std::span<std::uint8_t> to)
{
    const Taps taps = taps_at(position_of(z, edge_, voxel_size_.z), source_.nz);
    for (auto it = resampled_.begin(); it != resampled_.end();)
        it = it->first < taps.at[0] ? resampled_.erase(it) : std::next(it);
    std::array<const float*, 4> slices{};
    for (std::size_t i = 0; i < 4; ++i) slices[i] = source_slice(taps.at[i]).data();
    for (std::size_t i = 0; i < to.size(); ++i) {
        float sum = 0.0F;
        for (std::size_t k = 0; k < 4; ++k) sum += taps.weight[k] * slices[k][i];
        to[i] = static_cast<std::uint8_t>(std::clamp(sum + 0.5F, 0.0F, 255.0F));
    }
}

}  // namespace craze::images
