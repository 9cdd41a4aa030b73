#include "craze/images/alignment.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

namespace craze::images {

namespace {

std::vector<float> hann(std::int64_t n)
{
    std::vector<float> fade(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < fade.size(); ++i)
        fade[i] = static_cast<float>(
            0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n)));
    return fade;
}

// The top of the paraboloid through nine values, least squares; stays within one pixel.
Shift top_of(const std::array<std::array<double, 3>, 3>& c)
{
    double gx = 0, gy = 0, hxx = 0, hyy = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        gx += (c[i][2] - c[i][0]) / 6.0, gy += (c[2][i] - c[0][i]) / 6.0;
        hxx += (c[i][0] - 2 * c[i][1] + c[i][2]) / 3.0, hyy += (c[0][i] - 2 * c[1][i] + c[2][i]) / 3.0;
    }
    const double hxy = (c[2][2] + c[0][0] - c[0][2] - c[2][0]) / 4.0, det = hxx * hyy - hxy * hxy;
    if (!(det > 0.0) || !(hxx < 0.0)) return {};
    return {std::clamp((hxy * gy - hyy * gx) / det, -1.0, 1.0), std::clamp((hxy * gx - hxx * gy) / det, -1.0, 1.0)};
}

CRAZE_MULTIVERSION void multiply(const std::complex<float>* a, const std::complex<float>* b, std::complex<float>* to,
                                 std::int64_t n)
{
    const float* __restrict p = reinterpret_cast<const float*>(a);
    const float* __restrict q = reinterpret_cast<const float*>(b);
    float* __restrict r = reinterpret_cast<float*>(to);
    for (std::int64_t i = 0; i < 2 * n; i += 2) {
        r[i] = p[i] * q[i] + p[i + 1] * q[i + 1];
        r[i + 1] = p[i] * q[i + 1] - p[i + 1] * q[i];
    }
}

// to[x] = sum_i weights[i] from[x + i step]
CRAZE_MULTIVERSION void blend(const float* from, std::int64_t step, const std::array<float, 6>& weights, std::int64_t n,
                              float* __restrict to)
{
    const float w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3], w4 = weights[4], w5 = weights[5];
    const float *a = from, *b = a + step, *c = b + step, *d = c + step, *e = d + step, *f = e + step;
    for (std::int64_t x = 0; x < n; ++x) to[x] = w0 * a[x] + w1 * b[x] + w2 * c[x] + w3 * d[x] + w4 * e[x] + w5 * f[x];
}

}  // namespace

ShiftMeter::ShiftMeter(std::int64_t nx, std::int64_t ny, const Alignment& settings)
    : nx_(nx),
      ny_(ny),
      width_(fast_size(nx)),
      height_(fast_size(ny)),
      neighbours_(settings.neighbours),
      max_shift_(settings.max_shift),
      fourier_(width_, height_),
      fade_x_(hann(width_)),
      fade_y_(hann(height_))
{
}

ShiftMeter::Spectrum ShiftMeter::spectrum_of(std::span<const std::uint8_t> slice) const
{
    const std::int64_t left = (nx_ - width_) / 2, top = (ny_ - height_) / 2;
    std::vector<float> values(static_cast<std::size_t>(width_ * height_));
    double sum = 0.0, weight = 0.0;
    for (std::int64_t y = 0; y < height_; ++y) {
        const std::uint8_t* row = slice.data() + left + nx_ * (y + top);
        float along = 0.0F, fades = 0.0F;
        for (std::int64_t x = 0; x < width_; ++x) {
            const float fade = fade_x_[static_cast<std::size_t>(x)];
            along += fade * static_cast<float>(row[x]), fades += fade;
        }
        sum += static_cast<double>(fade_y_[static_cast<std::size_t>(y)] * along);
        weight += static_cast<double>(fade_y_[static_cast<std::size_t>(y)] * fades);
    }
    const auto mean = static_cast<float>(sum / weight);
    for (std::int64_t y = 0; y < height_; ++y) {
        const std::uint8_t* row = slice.data() + left + nx_ * (y + top);
        float* to = &values[static_cast<std::size_t>(width_ * y)];
        const float fade = fade_y_[static_cast<std::size_t>(y)];
        for (std::int64_t x = 0; x < width_; ++x)
            to[x] = fade * fade_x_[static_cast<std::size_t>(x)] * (static_cast<float>(row[x]) - mean);
    }
    Spectrum spectrum(static_cast<std::size_t>(fourier_.spectrum_size()));
    fourier_.forward(values, spectrum);
    return spectrum;
}

// Sum of squares of the faded slice, times the number of its pixels (Parseval, over half a spectrum).
double ShiftMeter::power_of(const Spectrum& spectrum) const
{
    const std::int64_t across = width_ / 2 + 1;
    double sum = 0.0;
    for (std::int64_t i = 0; i < std::ssize(spectrum); ++i) {
        const std::int64_t x = i % across;
        const bool alone = x == 0 || 2 * x == width_;
        sum += (alone ? 1.0 : 2.0) * static_cast<double>(std::norm(spectrum[static_cast<std::size_t>(i)]));
    }
    return sum;
}

ShiftMeter::Measured ShiftMeter::displacement(const Spectrum& a, const Spectrum& b) const
{
    const double power = std::sqrt(power_of(a) * power_of(b));
    Spectrum product(a.size());
    multiply(a.data(), b.data(), product.data(), static_cast<std::int64_t>(a.size()));
    std::vector<float> correlation(static_cast<std::size_t>(width_ * height_));
    fourier_.backward(product, correlation);
    const auto at = [&](std::int64_t x, std::int64_t y) {
        x = (x % width_ + width_) % width_, y = (y % height_ + height_) % height_;
        return correlation[static_cast<std::size_t>(x + width_ * y)];
    };
    const auto reach_x = std::min<std::int64_t>(static_cast<std::int64_t>(max_shift_), (width_ - 1) / 2);
    const auto reach_y = std::min<std::int64_t>(static_cast<std::int64_t>(max_shift_), (height_ - 1) / 2);
    std::int64_t best_x = 0, best_y = 0;
    for (std::int64_t y = -reach_y; y <= reach_y; ++y)
        for (std::int64_t x = -reach_x; x <= reach_x; ++x)
            if (at(x, y) > at(best_x, best_y)) best_x = x, best_y = y;
    std::array<std::array<double, 3>, 3> around{};
    for (std::int64_t j = 0; j < 3; ++j)
        for (std::int64_t i = 0; i < 3; ++i)
            around[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
                static_cast<double>(at(best_x + i - 1, best_y + j - 1));
    const Shift within = top_of(around);
    return {{static_cast<double>(best_x) + within.x, static_cast<double>(best_y) + within.y},
            power > 0.0 ? static_cast<double>(at(best_x, best_y)) / power : 0.0};
}

std::vector<PairShift> ShiftMeter::add(const std::vector<std::vector<std::uint8_t>>& slices)
{
    const auto n = static_cast<std::int64_t>(slices.size());
    const auto old = static_cast<std::int64_t>(before_.size());
    before_.resize(static_cast<std::size_t>(old + n));
    parallel_tasks(n, [&](std::int64_t i) {
        before_[static_cast<std::size_t>(old + i)] = spectrum_of(slices[static_cast<std::size_t>(i)]);
    });
    std::vector<PairShift> pairs;
    for (std::int64_t i = 0; i < n; ++i)
        for (std::int64_t k = 1; k <= std::min(neighbours_, old + i); ++k)
            pairs.push_back({count_ + i - k, count_ + i, {}, 1.0});
    parallel_tasks(static_cast<std::int64_t>(pairs.size()), [&](std::int64_t p) {
        PairShift& pair = pairs[static_cast<std::size_t>(p)];
        const Measured found = displacement(before_[static_cast<std::size_t>(pair.a - count_ + old)],
                                            before_[static_cast<std::size_t>(pair.b - count_ + old)]);
        pair.by = found.by, pair.likeness = found.likeness;
    });
    count_ += n;
    while (static_cast<std::int64_t>(before_.size()) > neighbours_) before_.pop_front();
    return pairs;
}

void shift_slice(std::span<const std::uint8_t> raw, std::int64_t nx, std::int64_t ny, const Shift& shift,
                 const CommonCrop& crop, std::span<float> to)
{
    const std::int64_t width = crop.x1 - crop.x0, height = crop.y1 - crop.y0;
    assert(static_cast<std::int64_t>(to.size()) == width * height);
    if (shift.x == 0.0 && shift.y == 0.0) {
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x)
                to[static_cast<std::size_t>(x + width * y)] =
                    raw[static_cast<std::size_t>(x + crop.x0 + nx * (y + crop.y0))];
        return;
    }
    constexpr std::int64_t taps = 6, before = 2;
    const auto kernel = [](double at) {
        const double fraction = at - std::floor(at);
        std::array<float, taps> weights{};
        double sum = 0.0;
        std::array<double, taps> w{};
        for (std::int64_t i = 0; i < taps; ++i) {
            const double t = std::numbers::pi * (static_cast<double>(i - before) - fraction);
            w[static_cast<std::size_t>(i)] = std::abs(t) < 1e-9 ? 1.0 : 3.0 * std::sin(t) * std::sin(t / 3.0) / (t * t);
            sum += w[static_cast<std::size_t>(i)];
        }
        for (std::size_t i = 0; i < taps; ++i) weights[i] = static_cast<float>(w[i] / sum);
        return weights;
    };
    const auto wx = kernel(shift.x), wy = kernel(shift.y);
    const auto step_x = static_cast<std::int64_t>(std::floor(shift.x)),
               step_y = static_cast<std::int64_t>(std::floor(shift.y));
    std::vector<float> line(static_cast<std::size_t>(width + taps));
    std::vector<float> rows(static_cast<std::size_t>(width * (height + taps)));
    for (std::int64_t y = 0; y < height + taps - 1; ++y) {
        const std::int64_t from = std::clamp<std::int64_t>(y + crop.y0 + step_y - before, 0, ny - 1);
        for (std::int64_t x = 0; x < width + taps - 1; ++x)
            line[static_cast<std::size_t>(x)] = raw[static_cast<std::size_t>(
                std::clamp<std::int64_t>(x + crop.x0 + step_x - before, 0, nx - 1) + nx * from)];
        blend(line.data(), 1, wx, width, &rows[static_cast<std::size_t>(width * y)]);
    }
    for (std::int64_t y = 0; y < height; ++y)
        blend(&rows[static_cast<std::size_t>(width * y)], width, wy, width, &to[static_cast<std::size_t>(width * y)]);
}

}  // namespace craze::images
