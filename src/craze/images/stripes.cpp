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

// What is masked or lies further than `reach` from the model is replaced by the model.
CRAZE_MULTIVERSION void fill_voids(float* __restrict filled, const float* __restrict row, const float* __restrict model,
                                   const std::uint8_t* __restrict masked, float reach, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) {
        const float d = row[x] - model[x];
        filled[x] = masked[x] == 0 && d >= -reach && d <= reach ? row[x] : model[x];
    }
}

// Marks what lies further than `reach` from the model.
CRAZE_MULTIVERSION void mark_voids(std::uint8_t* __restrict mark, const float* __restrict row,
                                   const float* __restrict model, float reach, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) {
        const float d = row[x] - model[x];
        mark[x] = d >= -reach && d <= reach ? 0 : 1;
    }
}

CRAZE_MULTIVERSION void either(std::uint8_t* __restrict to, const std::uint8_t* __restrict a,
                               const std::uint8_t* __restrict b, const std::uint8_t* __restrict c, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) to[x] = static_cast<std::uint8_t>(a[x] | b[x] | c[x]);
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
        if (share < 0.05 || k >= nx_) break;
        share_.push_back(static_cast<float>(share));
        const double norm =
            k == 0 ? std::sqrt(1.0 / static_cast<double>(nx_)) : std::sqrt(2.0 / static_cast<double>(nx_));
        for (std::int64_t x = 0; x < nx_; ++x)
            waves_.push_back(
                static_cast<float>(norm * std::cos(std::numbers::pi * static_cast<double>(k) *
                                                   (static_cast<double>(x) + 0.5) / static_cast<double>(nx_))));
    }
    // In a small slice the slowest waves are kept all the same.
    const double protect = std::min(settings.protect, 0.5 * static_cast<double>(ny_));
    for (std::int64_t m = 0; m < ny_; ++m) {
        const double waves = static_cast<double>(m) * protect / (2.0 * static_cast<double>(ny_));
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
    // First against the mode of the slice, then closer, against the row's own model. What is far from that is void, and
    // its neighbours are its rim: but a little darker than the solid, they would pull the model down, above all in rows
    // beside a crack that runs along them.
    const bool known = solid.low > 0.0 || solid.high < 255.0;
    const auto wide = known ? static_cast<float>(3.0 * solid.spread) : 1e9F;
    const auto close = known ? static_cast<float>(2.0 * solid.spread) : 1e9F;
    // The power that noise alone would have. Of what lies above it, the share is taken from the mean over neighbouring
    // m: single coefficients of noise scatter by as much as their mean.
    const double noise = known ? solid.spread * solid.spread : 0.0;
    constexpr std::size_t around = 16;
    const auto terms = static_cast<std::int64_t>(share_.size());
    const auto nx = static_cast<std::size_t>(nx_), ny = static_cast<std::size_t>(ny_);
    const auto wave = [&](std::int64_t k) { return &waves_[static_cast<std::size_t>(k) * nx]; };
    std::vector<float> coefficient(static_cast<std::size_t>(terms) * ny);  // of wave k in row y at [k ny + y]
    std::vector<float> filled(nx), model(nx);
    std::vector<std::uint8_t> marks(nx * ny), mask(nx + 2), near(nx);
    const auto fit = [&](std::size_t y, float reach) {
        fill_voids(filled.data(), &slice[y * nx], model.data(), near.data(), reach, nx_);
        std::fill(model.begin(), model.end(), 0.0F);
        for (std::int64_t k = 0; k < terms; ++k) {
            const float c = product(filled.data(), wave(k), nx_);
            coefficient[static_cast<std::size_t>(k) * ny + y] = c;
            add_scaled(model.data(), wave(k), c, nx_);
        }
    };
    for (std::size_t y = 0; y < ny; ++y) {
        std::fill(model.begin(), model.end(), static_cast<float>(solid.mode));
        fit(y, wide);
        fit(y, close);
        mark_voids(&marks[y * nx], &slice[y * nx], model.data(), wide, nx_);
    }
    for (std::size_t y = 0; y < ny; ++y) {
        const std::uint8_t* mark = &marks[y * nx];
        either(mask.data() + 1, mark, y > 0 ? mark - nx : mark, y + 1 < ny ? mark + nx : mark, nx_);
        either(near.data(), mask.data(), mask.data() + 1, mask.data() + 2, nx_);
        std::fill(model.begin(), model.end(), 0.0F);
        for (std::int64_t k = 0; k < terms; ++k)
            add_scaled(model.data(), wave(k), coefficient[static_cast<std::size_t>(k) * ny + y], nx_);
        for (int round = 0; round < 3; ++round) fit(y, close);
    }
    std::vector<double> power(ny + 1);  // up to m
    for (std::int64_t k = 0; k < terms; ++k) {
        const std::span<float> line(&coefficient[static_cast<std::size_t>(k) * ny], ny);
        across_->forward(line);
        for (std::size_t m = 0; m < ny; ++m) {
            const double c = m == 0 ? 0.0 : static_cast<double>(line[m]);
            power[m + 1] = power[m] + c * c / (2.0 * static_cast<double>(ny_));
        }
        for (std::size_t m = 0; m < ny; ++m) {
            const std::size_t from = m > around ? m - around : 1, to = std::min(ny, m + around + 1);
            const double mean = to > from ? (power[to] - power[from]) / static_cast<double>(to - from) : 0.0;
            const auto stripe = static_cast<float>(mean > noise ? 1.0 - noise / mean : 0.0);
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
