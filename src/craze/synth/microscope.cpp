#include "craze/synth/microscope.hpp"

#include "craze/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::synth {

namespace {

// One stream of random numbers for each purpose, slice and row.
enum class Purpose : std::uint64_t { positions = 1, stripes, noise };
std::uint64_t stream(Purpose purpose, std::int64_t z, std::int64_t y)
{
    return mixed(static_cast<std::uint64_t>(purpose) << 56U ^ static_cast<std::uint64_t>(z) << 24U ^
                 static_cast<std::uint64_t>(y));
}

/// A random walk of n steps pinned to zero at both ends.
std::vector<double> bridge(Random& random, std::int64_t n, double step)
{
    std::vector<double> walk(static_cast<std::size_t>(n), 0.0);
    for (std::size_t k = 1; k < walk.size(); ++k) walk[k] = walk[k - 1] + step * random.normal();
    const double end = walk.back();
    for (std::size_t k = 1; k < walk.size(); ++k)
        walk[k] -= end * static_cast<double>(k) / static_cast<double>(walk.size() - 1);
    return walk;
}

/// Blurs along y from `from` into `to`, then along x in place; the slice's edge repeats outwards.
void blur(std::span<const float> from, std::span<float> to, std::int64_t nx, std::int64_t ny, double sigma)
{
    const auto weight = beam_kernel(sigma);
    const auto reach = static_cast<std::int64_t>(weight.size() / 2);
    for (std::int64_t y = 0; y < ny; ++y) {
        float* out = to.data() + y * nx;
        std::fill_n(out, nx, 0.0F);
        for (std::int64_t k = -reach; k <= reach; ++k) {
            const float* in = from.data() + std::clamp<std::int64_t>(y + k, 0, ny - 1) * nx;
            const float w = weight[static_cast<std::size_t>(k + reach)];
            for (std::int64_t x = 0; x < nx; ++x) out[x] += w * in[x];
        }
    }
    std::vector<float> row(static_cast<std::size_t>(nx + 2 * reach));
    for (std::int64_t y = 0; y < ny; ++y) {
        float* out = to.data() + y * nx;
        for (std::int64_t x = -reach; x < nx + reach; ++x)
            row[static_cast<std::size_t>(x + reach)] = out[std::clamp<std::int64_t>(x, 0, nx - 1)];
        std::fill_n(out, nx, 0.0F);
        for (std::int64_t k = 0; k <= 2 * reach; ++k)
            for (std::int64_t x = 0; x < nx; ++x)
                out[x] += weight[static_cast<std::size_t>(k)] * row[static_cast<std::size_t>(x + k)];
    }
}

/// Noise by table: the middles of 2^14 equally likely slices of the normal distribution, scaled to unit variance. Four
/// draws from one 64-bit number, twenty times faster than logarithms and cosines; gray levels are rounded anyway.
class NoiseTable {
public:
    NoiseTable() : value_(size)
    {
        double sum2 = 0.0, z = -4.5;
        for (std::size_t i = 0; i < size; ++i) {
            const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
            for (int newton = 0; newton < 30; ++newton) {
                const double excess = 0.5 * std::erfc(-z / std::numbers::sqrt2) - share;
                const double slope = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
                const double step = std::clamp(excess / slope, -0.5, 0.5);
                z -= step;
                if (std::abs(step) < 1e-12) break;
            }
            value_[i] = static_cast<float>(z);
            sum2 += z * z;
        }
        const auto scale = static_cast<float>(1.0 / std::sqrt(sum2 / static_cast<double>(size)));
        for (auto& v : value_) v *= scale;
    }
    float operator()(std::uint64_t bits) const { return value_[bits & (size - 1)]; }

private:
    static constexpr std::size_t size = 1U << 14U;
    std::vector<float> value_;
};

/// Curtains of one slice: one value for each row, of unit variance, correlated over `width` rows.
std::vector<double> curtains(Random& random, std::int64_t ny, double width)
{
    const double keep = width > 0.0 ? std::exp(-1.0 / width) : 0.0;
    std::vector<double> value(static_cast<std::size_t>(ny));
    double last = random.normal();
    for (auto& v : value) v = last = keep * last + std::sqrt(1.0 - keep * keep) * random.normal();
    return value;
}

}  // namespace

void describe(Schema& schema, Microscope& m)
{
    schema.number("matter", m.matter, {0, 255}, "gray level of matter");
    schema.number("void", m.void_level, {0, 255}, "gray level of voids");
    schema.quantity("blur", m.blur, Dimension::pixel, {0, 20}, "standard deviation of the beam in the slice");
    schema.number("noise", m.noise, {0, 100}, "standard deviation of the noise, gray levels");
    schema.number("stripes", m.stripes, {0, 100}, "standard deviation of the curtains along x, gray levels");
    schema.quantity("stripe_width", m.stripe_width, Dimension::pixel, {0, 100},
                    "correlation length across the curtains");
    schema.number("shading_x", m.shading_x, {-200, 200}, "gray levels gained along x over the slice");
    schema.number("shading_y", m.shading_y, {-200, 200}, "gray levels gained along y over the slice");
    schema.number("shading_z", m.shading_z, {-200, 200}, "gray levels gained from the first slice to the last");
    schema.quantity("drift", m.drift, Dimension::pixel, {0, 10}, "standard deviation of the shift from slice to slice");
    schema.quantity("thickness_jitter", m.thickness_jitter, Dimension::pixel, {0, 0.3},
                    "standard deviation of the thickness of a slice");
}

std::vector<float> beam_kernel(double sigma)
{
    if (!(sigma > 0.0)) return {1.0F};
    const double s = sigma * sigma;
    const auto reach = static_cast<std::int64_t>(std::ceil(3.5 * sigma)) + 1;
    std::vector<double> half(static_cast<std::size_t>(reach + 1));
    double sum = 0.0;
    for (std::size_t k = 0; k < half.size(); ++k) {
        // Wide beams: the sampled Gaussian, the same to 1e-3, where I_k would overflow.
        half[k] = s < 100.0 ? std::exp(-s) * std::cyl_bessel_i(static_cast<double>(k), s)
                            : std::exp(-0.5 * static_cast<double>(k * k) / s);
        sum += (k == 0 ? 1.0 : 2.0) * half[k];
    }
    std::vector<float> weight(static_cast<std::size_t>(2 * reach + 1));
    for (std::int64_t k = -reach; k <= reach; ++k)
        weight[static_cast<std::size_t>(k + reach)] =
            static_cast<float>(half[static_cast<std::size_t>(std::abs(k))] / sum);
    return weight;
}

std::vector<Vec3> slice_positions(const Microscope& microscope, std::int64_t n, std::uint64_t seed)
{
    std::vector<Vec3> positions(static_cast<std::size_t>(n));
    for (int axis = 0; axis < 3; ++axis) {
        Random random(seed, stream(Purpose::positions, axis, 0));
        const auto walk = bridge(random, n, axis < 2 ? microscope.drift : microscope.thickness_jitter);
        for (std::size_t k = 0; k < walk.size(); ++k)
            positions[k][axis] = walk[k] + (axis == 2 ? static_cast<double>(k) : 0.0);
    }
    return positions;
}

void record_slice(const Microscope& m, std::span<const float> share, std::int64_t nx, std::int64_t ny, std::int64_t z,
                  std::int64_t nz, std::uint64_t seed, std::span<float> work, std::span<std::uint8_t> gray)
{
    blur(share, work, nx, ny, m.blur);

    Random curtain(seed, stream(Purpose::stripes, z, 0));
    const auto stripe = curtains(curtain, ny, m.stripe_width);
    const double phase = curtain.uniform(0.0, 2.0 * std::numbers::pi);
    const auto centred = [](std::int64_t i, std::int64_t n) {
        return n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) - 0.5 : 0.0;
    };
    // Curtains fade in and out along the beam by a fifth, as they do below a step of the surface.
    std::vector<float> fade(static_cast<std::size_t>(nx)), slope(fade.size());
    for (std::int64_t x = 0; x < nx; ++x) {
        fade[static_cast<std::size_t>(x)] =
            static_cast<float>(1.0 + 0.2 * std::sin(2.0 * std::numbers::pi * centred(x, nx) + phase));
        slope[static_cast<std::size_t>(x)] = static_cast<float>(m.shading_x * centred(x, nx));
    }
    static const NoiseTable noise;
    const auto contrast = static_cast<float>(m.matter - m.void_level), sigma = static_cast<float>(m.noise);
    for (std::int64_t y = 0; y < ny; ++y) {
        const auto row = static_cast<float>(m.matter + m.shading_y * centred(y, ny) + m.shading_z * centred(z, nz));
        const auto curtain_here = static_cast<float>(m.stripes * stripe[static_cast<std::size_t>(y)]);
        Random random(seed, stream(Purpose::noise, z, y));
        std::uint64_t bits = 0;
        for (std::int64_t x = 0; x < nx; ++x) {
            const auto i = static_cast<std::size_t>(x + nx * y), c = static_cast<std::size_t>(x);
            bits = x % 4 == 0 ? random.bits() : bits >> 16U;
            const float level = row + slope[c] - contrast * work[i] + curtain_here * fade[c] + sigma * noise(bits);
            gray[i] = static_cast<std::uint8_t>(std::clamp(level + 0.5F, 0.0F, 255.0F));
        }
    }
}

}  // namespace craze::synth
