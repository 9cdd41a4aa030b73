#include "craze/images/solid.hpp"

#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>

namespace craze::images {

Histogram histogram_of(std::span<const std::uint8_t> levels)
{
    Histogram sum{};
    std::mutex lock;
    parallel_ranges(std::ssize(levels), [&](std::int64_t begin, std::int64_t end) {
        std::array<Histogram, 4> parts{};  // equal neighbours would wait for each other in one table
        auto i = static_cast<std::size_t>(begin);
        for (; i + 4 <= static_cast<std::size_t>(end); i += 4)
            for (std::size_t k = 0; k < 4; ++k) ++parts[k][levels[i + k]];
        for (; i < static_cast<std::size_t>(end); ++i) ++parts[0][levels[i]];
        const std::lock_guard guard(lock);
        for (std::size_t v = 0; v < 256; ++v) sum[v] += parts[0][v] + parts[1][v] + parts[2][v] + parts[3][v];
    });
    return sum;
}

Solid solid_of(const Histogram& histogram)
{
    // The peak of the histogram smoothed over a few levels; saturated ends say nothing of it.
    std::array<double, 256> smooth{};
    for (int v = 0; v < 256; ++v)
        for (int d = -4; d <= 4; ++d)
            if (v + d > 0 && v + d < 255)
                smooth[static_cast<std::size_t>(v)] +=
                    (5 - std::abs(d)) * static_cast<double>(histogram[static_cast<std::size_t>(v + d)]);
    Solid solid;
    solid.mode = static_cast<double>(std::max_element(smooth.begin(), smooth.end()) - smooth.begin());
    double count = 0.0, square = 0.0;
    for (int v = static_cast<int>(solid.mode); v < 256; ++v) {
        const double d = v - solid.mode,
                     n = static_cast<double>(histogram[static_cast<std::size_t>(v)]) * (d > 0 ? 2.0 : 1.0);
        count += n, square += n * d * d;
    }
    solid.spread = count > 0.0 ? std::max(1.0, std::sqrt(square / count)) : 1.0;
    const double low = solid.mode - 3.0 * solid.spread, high = solid.mode + 3.0 * solid.spread;
    std::int64_t inside = 0;
    for (int v = 0; v < 256; ++v)
        if (v >= low && v <= high) inside += histogram[static_cast<std::size_t>(v)];
    const std::int64_t all = std::accumulate(histogram.begin(), histogram.end(), std::int64_t{0});
    if (2 * inside >= all) solid.low = low, solid.high = high;
    return solid;
}

double centre_of_solid(const Histogram& histogram, const Solid& start)
{
    double centre = start.mode;
    for (int round = 0; round < 8; ++round) {
        double count = 0.0, sum = 0.0;
        for (int v = 0; v < 256; ++v) {
            // Levels at the edge of the window count in part, or the centre would move in steps.
            const double inside = std::clamp(1.5 * start.spread + 0.5 - std::abs(v - centre), 0.0, 1.0);
            const double n = inside * static_cast<double>(histogram[static_cast<std::size_t>(v)]);
            count += n, sum += n * v;
        }
        if (count <= 0.0) return centre;
        centre = sum / count;
    }
    return centre;
}

}  // namespace craze::images
