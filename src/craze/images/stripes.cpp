#include "craze/images/stripes.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/images/solid.hpp"
#include "craze/images/wavelet.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::images {

namespace {

// sum_x row[x] wave[x], in lanes whose order of summation does not depend on the machine.
CRAZE_MULTIVERSION float product(const float* __restrict row, const float* __restrict wave, std::int64_t n)
{
    constexpr std::int64_t lanes = 16;
    float sum[lanes] = {};
    std::int64_t x = 0;
    for (; x + lanes <= n; x += lanes)
        for (std::int64_t l = 0; l < lanes; ++l) sum[l] += row[x + l] * wave[x + l];
    for (; x < n; ++x) sum[x % lanes] += row[x] * wave[x];
    for (std::int64_t half = lanes / 2; half > 0; half /= 2)
        for (std::int64_t l = 0; l < half; ++l) sum[l] += sum[l + half];
    return sum[0];
}

CRAZE_MULTIVERSION void add_scaled(float* __restrict row, const float* __restrict wave, float factor, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) row[x] += factor * wave[x];
}

// What lies further than `below` under the model or `above` over it is replaced by the model.
CRAZE_MULTIVERSION void fill_voids(float* __restrict filled, const float* __restrict row, const float* __restrict model,
                                   float below, float above, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) {
        const float d = row[x] - model[x];
        filled[x] = d >= -below && d <= above ? row[x] : model[x];
    }
}

std::vector<float> turned(std::span<const float> slice, std::int64_t nx, std::int64_t ny)
{
    std::vector<float> to(slice.size());
    constexpr std::int64_t block = 32;
    for (std::int64_t y0 = 0; y0 < ny; y0 += block)
        for (std::int64_t x0 = 0; x0 < nx; x0 += block)
            for (std::int64_t y = y0; y < std::min(ny, y0 + block); ++y)
                for (std::int64_t x = x0; x < std::min(nx, x0 + block); ++x)
                    to[static_cast<std::size_t>(y + ny * x)] = slice[static_cast<std::size_t>(x + nx * y)];
    return to;
}

Solid solid_of_slice(std::span<const float> slice)
{
    Histogram histogram{};
    for (const float v : slice) ++histogram[static_cast<std::size_t>(std::clamp(v + 0.5F, 0.0F, 255.0F))];
    return solid_of(histogram);
}

}  // namespace

StripeFilter::StripeFilter(std::int64_t nx, std::int64_t ny, const Stripes& settings)
    : settings_(settings),
      nx_(settings.axis == 0 ? nx : ny),
      ny_(settings.axis == 0 ? ny : nx),
      turned_(settings.axis == 1),
      across_(std::make_unique<Cosine>(ny_))
{
    for (std::int64_t k = 0;; ++k) {
        const double waves = static_cast<double>(k) * settings.length;
        const double share = std::exp(-0.5 * waves * waves);
        if (share < 0.01 || k >= nx_) break;
        share_.push_back(static_cast<float>(share));
        const double norm =
            k == 0 ? std::sqrt(1.0 / static_cast<double>(nx_)) : std::sqrt(2.0 / static_cast<double>(nx_));
        for (std::int64_t x = 0; x < nx_; ++x)
            waves_.push_back(
                static_cast<float>(norm * std::cos(std::numbers::pi * static_cast<double>(k) *
                                                   (static_cast<double>(x) + 0.5) / static_cast<double>(nx_))));
    }
    for (std::int64_t m = 0; m < ny_; ++m) {
        const double waves = static_cast<double>(m) * settings.protect / (2.0 * static_cast<double>(ny_));
        keep_low_.push_back(static_cast<float>(1.0 - std::exp(-std::numbers::ln2 * waves * waves)));
    }
}

StripeFilter::~StripeFilter() = default;

void StripeFilter::remove(std::span<float> slice) const
{
    if (settings_.method == Stripes::Method::none) return;
    const auto run = [&](std::span<float> rows) {
        settings_.method == Stripes::Method::notch ? notch(rows) : wavelet(rows);
    };
    if (!turned_) return run(slice);
    std::vector<float> rows = turned(slice, ny_, nx_);
    run(rows);
    const std::vector<float> back = turned(rows, nx_, ny_);
    std::copy(back.begin(), back.end(), slice.begin());
}

void StripeFilter::notch(std::span<float> slice) const
{
    const Solid solid = solid_of_slice(slice);
    // First against the mode of the slice, then closer, against the row's own model: the rims of voids, which are but a
    // little darker than the solid, would pull the model down and be lifted with it.
    const bool known = solid.low > 0.0 || solid.high < 255.0;
    const auto wide = known ? static_cast<float>(3.0 * solid.spread) : 1e9F;
    const auto close = known ? static_cast<float>(2.0 * solid.spread) : 1e9F;
    // Coefficients that hold no more than noise may are left alone; the others lose Wiener's share.
    const auto noise = known ? static_cast<float>(2.0 * solid.spread * solid.spread) : 0.0F;
    const auto terms = static_cast<std::int64_t>(share_.size());
    const auto nx = static_cast<std::size_t>(nx_), ny = static_cast<std::size_t>(ny_);
    const auto wave = [&](std::int64_t k) { return &waves_[static_cast<std::size_t>(k) * nx]; };
    std::vector<float> coefficient(static_cast<std::size_t>(terms) * ny);  // of wave k in row y at [k ny + y]
    std::vector<float> filled(nx), model(nx);
    for (std::size_t y = 0; y < ny; ++y) {
        const float* row = &slice[y * nx];
        std::fill(model.begin(), model.end(), static_cast<float>(solid.mode));
        for (int round = 0; round < 5; ++round) {
            const float reach = round == 0 ? wide : close;
            fill_voids(filled.data(), row, model.data(), reach, reach, nx_);
            std::fill(model.begin(), model.end(), 0.0F);
            for (std::int64_t k = 0; k < terms; ++k) {
                const float c = product(filled.data(), wave(k), nx_);
                coefficient[static_cast<std::size_t>(k) * ny + y] = c;
                add_scaled(model.data(), wave(k), c, nx_);
            }
        }
    }
    for (std::int64_t k = 0; k < terms; ++k) {
        const std::span<float> line(&coefficient[static_cast<std::size_t>(k) * ny], ny);
        across_->forward(line);
        for (std::size_t m = 0; m < ny; ++m) {
            const float power = line[m] * line[m] / (2.0F * static_cast<float>(ny_));
            const float stripe = power > noise ? 1.0F - noise / power : 0.0F;
            line[m] *= stripe * keep_low_[m] * share_[static_cast<std::size_t>(k)] / (2.0F * static_cast<float>(ny_));
        }
        across_->backward(line);
    }
    for (std::size_t y = 0; y < ny; ++y)
        for (std::int64_t k = 0; k < terms; ++k)
            add_scaled(&slice[y * nx], wave(k), -coefficient[static_cast<std::size_t>(k) * ny + y], nx_);
}

void StripeFilter::wavelet(std::span<float> slice) const
{
    damp_stripes(slice, nx_, ny_, settings_.levels, settings_.damping);
}

}  // namespace craze::images
