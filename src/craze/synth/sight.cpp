#include "craze/synth/sight.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::synth {

Sight::Sight(const Microscope& m, double voxel_size, double threshold)
{
    if (!(threshold > m.void_level && threshold <= m.matter && voxel_size > 0.0))
        throw InvalidInput(fmt::format("sight: the threshold must lie between void ({:g}) and matter ({:g}), got {:g}",
                                       m.void_level, m.matter, threshold));
    constexpr double step = 0.02;
    constexpr int positions = 100;
    const auto beam = beam_kernel(m.blur);
    const auto reach = static_cast<int>(beam.size() / 2);
    // Beyond a few voxels both walls are seen apart, and both measures grow straight on.
    const auto entries = static_cast<int>(std::ceil((2.0 + 2.0 * reach) / step)) + 1;
    const int n = entries / static_cast<int>(1.0 / step) + 4 * reach + 6;
    std::vector<double> share(static_cast<std::size_t>(n));
    for (int e = 0; e < entries; ++e) {
        const double t = e * step;
        double width = 0.0, intensity = 0.0;
        for (int p = 0; p < positions; ++p) {
            const double middle = 0.5 * n + (p + 0.5) / positions;
            for (int x = 0; x < n; ++x)
                share[static_cast<std::size_t>(x)] =
                    std::max(0.0, std::min(x + 1.0, middle + 0.5 * t) - std::max<double>(x, middle - 0.5 * t));
            for (int x = reach; x < n - reach; ++x) {
                double seen = 0.0;
                for (int k = -reach; k <= reach; ++k)
                    seen += beam[static_cast<std::size_t>(k + reach)] * share[static_cast<std::size_t>(x + k)];
                const double level = std::floor(m.matter - (m.matter - m.void_level) * seen + 0.5);  // 8 bits
                if (level >= threshold) continue;
                width += 1.0 / positions;
                intensity += (1.0 - level / threshold) / positions;
            }
        }
        if (width < 0.5) least_ = t * voxel_size;
        width_.push_back(width * voxel_size);
        intensity_.push_back(intensity * voxel_size);
    }
    step_ = step * voxel_size;
    deepest_ = 1.0 - m.void_level / threshold;
}

double Sight::look_up(const std::vector<double>& table, double slope, double opening) const
{
    if (table.empty()) return opening;
    const double at = opening / step_;
    const auto last = static_cast<double>(table.size() - 1);
    if (at >= last) return table.back() + slope * (opening - last * step_);
    const auto i = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(i);
    return (1.0 - part) * table[i] + part * table[i + 1];
}

double Sight::width(double opening) const { return look_up(width_, 1.0, opening); }
double Sight::intensity(double opening) const { return look_up(intensity_, deepest_, opening); }

}  // namespace craze::synth
