#include "craze/synth/sight.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace craze::synth {

namespace {

/// Void share seen at distance x from the middle of a crack of opening t: a box seen through a voxel of width 1 and a
/// Gaussian beam. All in voxels.
double seen_share(double x, double t, double blur)
{
    const auto ramp = [blur](double s) {  // integral of the (blurred) step function
        if (blur <= 0.0) return s > 0.0 ? s : 0.0;
        const double q = s / blur;
        return blur * (0.5 * q * std::erfc(-q / std::numbers::sqrt2) +
                       std::exp(-0.5 * q * q) / std::sqrt(2.0 * std::numbers::pi));
    };
    const double outer = 0.5 * (t + 1.0), inner = 0.5 * (t - 1.0);
    return ramp(x + outer) - ramp(x + inner) - ramp(x - inner) + ramp(x - outer);
}

}  // namespace

Sight::Sight(const Microscope& m, double voxel_size, double threshold)
{
    if (!(threshold > m.void_level && threshold <= m.matter && voxel_size > 0.0))
        throw InvalidInput(fmt::format("sight: the threshold must lie between void ({:g}) and matter ({:g}), got {:g}",
                                       m.void_level, m.matter, threshold));
    const double contrast = m.matter - m.void_level;
    const double least_share = (m.matter - threshold) / contrast;
    double low = 0.0, high = 3.0 + 8.0 * m.blur;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (seen_share(0.0, middle, m.blur) > least_share ? high : low) = middle;
    }
    least_ = high * voxel_size;
    // Beyond a few voxels both walls are seen apart, and both measures grow straight on.
    constexpr double step = 0.02, dx = 0.005;
    const auto entries = static_cast<int>(std::ceil((3.0 + 8.0 * m.blur) / step)) + 1;
    for (int e = 0; e < entries; ++e) {
        const double t = e * step, reach = 0.5 * t + 0.5 + 5.0 * m.blur;
        double width = 0.0, intensity = 0.0;
        for (double x = 0.5 * dx; x < reach; x += dx) {
            const double level = m.matter - contrast * seen_share(x, t, m.blur);
            if (level >= threshold) break;
            width += 2.0 * dx;
            intensity += 2.0 * dx * (1.0 - level / threshold);
        }
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
