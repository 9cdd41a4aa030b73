#include "craze/images/quality.hpp"

#include "craze/core/parallel.hpp"
#include "craze/images/fourier.hpp"
#include "craze/io/picture.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace craze::images {

namespace {

std::vector<std::int64_t> looked_at(std::int64_t nz)
{
    const std::int64_t count = std::min<std::int64_t>(nz, 24);
    std::vector<std::int64_t> slices;
    for (std::int64_t i = 0; i < count; ++i) slices.push_back((2 * i + 1) * nz / (2 * count));
    return slices;
}

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Power of what the lines of one slice differ by, slow variations included.
std::vector<double> spectrum_of(const std::vector<double>& lines)
{
    double mean = 0.0;
    for (const double v : lines) mean += v / static_cast<double>(lines.size());
    std::vector<float> values;
    for (const double v : lines) values.push_back(static_cast<float>(v - mean));
    const Cosine cosine(static_cast<std::int64_t>(values.size()));
    cosine.forward(values);
    std::vector<double> power;
    const auto n = static_cast<double>(values.size());
    for (const float c : values) power.push_back(static_cast<double>(c) * static_cast<double>(c) / (2.0 * n * n));
    return power;
}

}  // namespace

double noise_of_slice(std::span<const std::uint8_t> slice, std::int64_t nx, std::int64_t ny, std::int64_t apart,
                      const Solid& solid)
{
    if (nx <= 2 * apart || ny <= 2 * apart) return 0.0;
    const bool all = solid.low <= 0.0 && solid.high >= 255.0;
    const auto in = [&](int level) { return all || (level >= solid.low && level <= solid.high); };
    // |1 -2 1; -2 4 -2; 1 -2 1| reaches 4080.
    std::vector<std::int64_t> counts(4096);
    std::int64_t of = 0;
    for (std::int64_t y = apart; y + apart < ny; ++y) {
        const std::uint8_t *b = slice.data() + nx * y, *a = b - nx * apart, *c = b + nx * apart;
        for (std::int64_t x = apart; x + apart < nx; ++x) {
            const std::int64_t l = x - apart, r = x + apart;
            if (!all && !(in(b[x]) && in(a[x]) && in(c[x]) && in(b[l]) && in(b[r]) && in(a[l]) && in(a[r]) &&
                          in(c[l]) && in(c[r])))
                continue;
            const int edges = a[x] + c[x] + b[l] + b[r], corners = a[l] + a[r] + c[l] + c[r];
            ++counts[static_cast<std::size_t>(std::abs(corners - 2 * edges + 4 * b[x]))];
            ++of;
        }
    }
    const std::int64_t half = of / 2;
    std::int64_t below = 0;
    for (std::size_t v = 0; v < counts.size(); ++v) {
        if (below + counts[v] > half) {
            // Between whole responses, the median is interpolated; |0| is only half as wide as the others.
            const double share = (static_cast<double>(half - below) + 0.5) / static_cast<double>(counts[v]);
            const double at = v == 0 ? 0.5 * share : static_cast<double>(v) - 0.5 + share;
            return at / (6.0 * 0.67449);
        }
        below += counts[v];
    }
    return 0.0;
}

std::vector<double> line_means(std::span<const std::uint8_t> slice, std::int64_t nx, std::int64_t ny, int axis,
                               const Solid& solid)
{
    const std::int64_t lines = axis == 0 ? ny : nx;
    std::vector<double> sum(static_cast<std::size_t>(lines)), count(sum.size());
    for (std::int64_t y = 0; y < ny; ++y)
        for (std::int64_t x = 0; x < nx; ++x) {
            const double v = slice[static_cast<std::size_t>(x + nx * y)];
            if (!(v >= solid.low && v <= solid.high)) continue;
            const auto line = static_cast<std::size_t>(axis == 0 ? y : x);
            sum[line] += v, count[line] += 1.0;
        }
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = count[i] > 0.0 ? sum[i] / count[i] : solid.mode;
    return sum;
}

double noise_of(Shape shape, const SliceReader& read)
{
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(shape.nx * shape.ny));
    std::vector<double> all;
    for (const std::int64_t z : looked_at(shape.nz)) {
        read(z, slice);
        all.push_back(noise_of_slice(slice, shape.nx, shape.ny));
    }
    return median(all);
}

Quality quality_of(const std::string& step, Shape shape, const SliceReader& read, int stripe_axis, double protect)
{
    Quality q;
    q.step = step;
    const auto at = looked_at(shape.nz);
    std::vector<std::vector<std::uint8_t>> slices(at.size());
    Histogram histogram{};
    for (std::size_t i = 0; i < at.size(); ++i) {
        slices[i].resize(static_cast<std::size_t>(shape.nx * shape.ny));
        read(at[i], slices[i]);
        const Histogram h = histogram_of(slices[i]);
        for (std::size_t v = 0; v < 256; ++v) histogram[v] += h[v];
    }
    const Solid solid = solid_of(histogram);
    q.solid = centre_of_solid(histogram, solid);
    double dark = 0.0, darker = 0.0;
    for (int v = 0; v < 256 && v < solid.low; ++v)
        darker += static_cast<double>(histogram[static_cast<std::size_t>(v)]),
            dark += v * static_cast<double>(histogram[static_cast<std::size_t>(v)]);
    q.dark = darker > 0.0 ? dark / darker : solid.low;

    std::vector<double> noise(at.size()), apart(at.size()), farther(at.size());
    std::vector<std::vector<double>> spectra(at.size());
    parallel_tasks(static_cast<std::int64_t>(at.size()), [&](std::int64_t i) {
        const auto& slice = slices[static_cast<std::size_t>(i)];
        noise[static_cast<std::size_t>(i)] = noise_of_slice(slice, shape.nx, shape.ny);
        apart[static_cast<std::size_t>(i)] = noise_of_slice(slice, shape.nx, shape.ny, 4, solid);
        farther[static_cast<std::size_t>(i)] = noise_of_slice(slice, shape.nx, shape.ny, 8, solid);
        spectra[static_cast<std::size_t>(i)] = spectrum_of(line_means(slice, shape.nx, shape.ny, stripe_axis, solid));
    });
    q.noise = median(noise);
    q.noise_apart = median(apart);
    q.correlated = q.noise_apart > 1.3 * q.noise && median(farther) < 1.1 * q.noise_apart;
    q.contrast_to_noise = (q.solid - q.dark) / std::max(q.noise, 1e-3);
    const std::int64_t across = stripe_axis == 0 ? shape.ny : shape.nx;
    q.spectrum.assign(static_cast<std::size_t>(across), 0.0);
    for (const auto& s : spectra)
        for (std::size_t m = 0; m < s.size(); ++m) q.spectrum[m] += s[m] / static_cast<double>(at.size());
    double power = 0.0;
    for (std::size_t m = 1; m < q.spectrum.size(); ++m)
        if (static_cast<double>(m) * protect >= 2.0 * static_cast<double>(across)) power += q.spectrum[m];
    q.stripes = std::sqrt(power);

    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < at.size(); ++i)
        for (std::int64_t y = 0; y < shape.ny; y += 2)
            for (std::int64_t x = 0; x < shape.nx; x += 2) {
                const double v = slices[i][static_cast<std::size_t>(x + shape.nx * y)];
                if (!(v >= solid.low && v <= solid.high)) continue;
                const Eigen::Vector4d r(1.0, static_cast<double>(x), static_cast<double>(y),
                                        static_cast<double>(at[i]));
                a += r * r.transpose(), b += v * r;
            }
    const Eigen::Vector4d plane = a.completeOrthogonalDecomposition().solve(b);
    q.gradient = {plane[1], plane[2], plane[3]};
    q.shading = std::abs(plane[1]) * static_cast<double>(shape.nx) +
                std::abs(plane[2]) * static_cast<double>(shape.ny) + std::abs(plane[3]) * static_cast<double>(shape.nz);
    return q;
}

void write_strip(const std::filesystem::path& file, Shape shape, const SliceReader& read)
{
    constexpr std::array shares{0.11, 0.28, 0.70};
    constexpr std::int64_t gap = 6;
    io::Picture strip(3 * shape.nx + 2 * gap, shape.ny, 1, 255);
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(shape.nx * shape.ny));
    for (std::size_t i = 0; i < shares.size(); ++i) {
        read(std::min(shape.nz - 1, static_cast<std::int64_t>(shares[i] * static_cast<double>(shape.nz))), slice);
        for (std::int64_t y = 0; y < shape.ny; ++y)
            std::copy_n(slice.data() + shape.nx * y, shape.nx,
                        strip.at(static_cast<std::int64_t>(i) * (shape.nx + gap), y));
    }
    io::write_png(file, strip);
}

}  // namespace craze::images
