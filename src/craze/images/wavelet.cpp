#include "craze/images/wavelet.hpp"

#include "craze/images/fourier.hpp"
#include "craze/images/non_local_means.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace craze::images {

namespace {

// Daubechies 1988, Table 1, N = 4: scaling filter; the wavelet filter is its alternating mirror.
constexpr std::array<float, 8> smooth{0.2303778133F,  0.7148465706F, 0.6308807679F, -0.0279837694F,
                                      -0.1870348117F, 0.0308413818F, 0.0328830117F, -0.0105974018F};
constexpr std::int64_t taps = 8;

constexpr float rough(std::int64_t i)
{
    return (i % 2 == 0 ? 1.0F : -1.0F) * smooth[static_cast<std::size_t>(taps - 1 - i)];
}

// One level along a line of n values `step` apart, n even, periodic: smooth half first, then rough half.
void split(float* line, std::int64_t n, std::int64_t step, std::vector<float>& scratch)
{
    scratch.resize(static_cast<std::size_t>(n));
    for (std::int64_t i = 0; i < n / 2; ++i) {
        float s = 0.0F, r = 0.0F;
        for (std::int64_t t = 0; t < taps; ++t) {
            const float v = line[(2 * i + t) % n * step];
            s += smooth[static_cast<std::size_t>(t)] * v, r += rough(t) * v;
        }
        scratch[static_cast<std::size_t>(i)] = s, scratch[static_cast<std::size_t>(i + n / 2)] = r;
    }
    for (std::int64_t i = 0; i < n; ++i) line[i * step] = scratch[static_cast<std::size_t>(i)];
}

void join(float* line, std::int64_t n, std::int64_t step, std::vector<float>& scratch)
{
    scratch.assign(static_cast<std::size_t>(n), 0.0F);
    for (std::int64_t i = 0; i < n / 2; ++i) {
        const float s = line[i * step], r = line[(i + n / 2) * step];
        for (std::int64_t t = 0; t < taps; ++t)
            scratch[static_cast<std::size_t>((2 * i + t) % n)] +=
                smooth[static_cast<std::size_t>(t)] * s + rough(t) * r;
    }
    for (std::int64_t i = 0; i < n; ++i) line[i * step] = scratch[static_cast<std::size_t>(i)];
}

// Slow waves along a row of coefficients, seen as mirrored at its ends.
void damp_row(float* row, const Cosine& cosine, const std::vector<float>& kept)
{
    const std::span<float> line(row, kept.size());
    cosine.forward(line);
    for (std::size_t k = 0; k < kept.size(); ++k) line[k] *= kept[k];
    cosine.backward(line);
}

// Of each cosine term; with what forward and backward multiply by taken out.
std::vector<float> kept_of(std::int64_t n, double damping)
{
    std::vector<float> kept;
    for (std::int64_t k = 0; k < n; ++k) {
        const double waves = static_cast<double>(k) / 2.0;  // a cosine term holds half waves
        kept.push_back(static_cast<float>((1.0 - std::exp(-waves * waves / (2.0 * damping * damping))) /
                                          (2.0 * static_cast<double>(n))));
    }
    return kept;
}

}  // namespace

void damp_stripes(std::span<float> picture, std::int64_t nx, std::int64_t ny, std::int64_t levels, double damping)
{
    std::int64_t deep = 0;
    while (deep < levels && std::min(nx, ny) >> (deep + 1) >= 16) ++deep;
    // Mirrored borders around the picture: the wrap-around of periodic wavelets happens out there.
    const std::int64_t unit = std::int64_t{1} << deep, margin = taps * unit / 2;
    const auto padded = [&](std::int64_t n) { return (n + 2 * margin + unit - 1) / unit * unit; };
    const std::int64_t width = padded(nx), height = padded(ny);
    std::vector<float> field(static_cast<std::size_t>(width * height)), scratch;
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x)
            field[static_cast<std::size_t>(x + width * y)] =
                picture[static_cast<std::size_t>(mirrored(x - margin, nx) + nx * mirrored(y - margin, ny))];
    const auto at = [&](std::int64_t x, std::int64_t y) { return &field[static_cast<std::size_t>(x + width * y)]; };
    for (std::int64_t level = 0, w = width, h = height; level < deep; ++level, w /= 2, h /= 2) {
        for (std::int64_t y = 0; y < h; ++y) split(at(0, y), w, 1, scratch);
        for (std::int64_t x = 0; x < w; ++x) split(at(x, 0), h, width, scratch);
        const Cosine cosine(w / 2);
        const std::vector<float> kept = kept_of(w / 2, damping);
        for (std::int64_t y = h / 2; y < h; ++y) damp_row(at(0, y), cosine, kept);
    }
    for (std::int64_t level = deep - 1; level >= 0; --level) {
        const std::int64_t w = width >> level, h = height >> level;
        for (std::int64_t x = 0; x < w; ++x) join(at(x, 0), h, width, scratch);
        for (std::int64_t y = 0; y < h; ++y) join(at(0, y), w, 1, scratch);
    }
    for (std::int64_t y = 0; y < ny; ++y)
        for (std::int64_t x = 0; x < nx; ++x)
            picture[static_cast<std::size_t>(x + nx * y)] = *at(x + margin, y + margin);
}

}  // namespace craze::images
