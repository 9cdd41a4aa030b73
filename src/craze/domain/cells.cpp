#include "craze/domain/cells.hpp"

#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace craze::domain {

Cells::Cells(const Vec3& box, double edge, std::span<const double> x, std::span<const double> y,
             std::span<const double> z)
{
    // No more cells than twice the points: a sparse box must not cost memory.
    const auto points = static_cast<std::int64_t>(x.size());
    const double most = 2.0 * static_cast<double>(points) + 64.0;
    edge = std::max(edge, std::cbrt(box.x * box.y * box.z / most));
    for (int axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<std::int32_t>(std::clamp(box[axis] / edge, 1.0, 1e6));
        count_[static_cast<std::size_t>(axis)] = n;
        inverse_edge_[axis] = n / box[axis];
    }

    std::vector<std::int32_t> cell(x.size());
    parallel_ranges(points, [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            cell[k] = static_cast<std::int32_t>(index(along(0, x[k]), along(1, y[k]), along(2, z[k])));
    });
    start_.assign(static_cast<std::size_t>(index(0, 0, count_[2])) + 1, 0);
    for (const std::int32_t c : cell) ++start_[static_cast<std::size_t>(c) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    members_.resize(x.size());
    std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t k = 0; k < cell.size(); ++k)
        members_[static_cast<std::size_t>(next[static_cast<std::size_t>(cell[k])]++)] = static_cast<std::int32_t>(k);
}

namespace {

/// Bits of v at every third place.
std::uint64_t spread(std::uint64_t v)
{
    v &= 0x1fffffU;
    v = (v | v << 32U) & 0x1f00000000ffffU;
    v = (v | v << 16U) & 0x1f0000ff0000ffU;
    v = (v | v << 8U) & 0x100f00f00f00f00fU;
    v = (v | v << 4U) & 0x10c30c30c30c30c3U;
    v = (v | v << 2U) & 0x1249249249249249U;
    return v;
}

}  // namespace

std::uint64_t morton_code(const Vec3& point, const Vec3& box)
{
    // One scale for all axes, so that the curve's blocks are cubes.
    const double scale = 0x1p21 / std::max({box.x, box.y, box.z});
    const auto part = [&](double p) {
        return spread(static_cast<std::uint64_t>(std::clamp(p * scale, 0.0, 0x1.fffffp20)));
    };
    return part(point.x) | part(point.y) << 1U | part(point.z) << 2U;
}

std::vector<std::int32_t> morton_order(const Vec3& box, std::span<const double> x, std::span<const double> y,
                                       std::span<const double> z)
{
    std::vector<std::pair<std::uint64_t, std::int32_t>> keys(x.size());
    parallel_ranges(static_cast<std::int64_t>(x.size()), [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            keys[k] = {morton_code({x[k], y[k], z[k]}, box), static_cast<std::int32_t>(k)};
    });
    std::ranges::sort(keys);
    std::vector<std::int32_t> order(x.size());
    std::ranges::transform(keys, order.begin(), [](const auto& key) { return key.second; });
    return order;
}

}  // namespace craze::domain
