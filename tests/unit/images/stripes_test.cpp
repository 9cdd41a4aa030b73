#include "craze/images/stripes.hpp"

#include "craze/core/random.hpp"
#include "craze/images/homogenise.hpp"
#include "craze/images/quality.hpp"
#include "craze/images/wavelet.hpp"
#include "craze/io/picture.hpp"
#include "craze/io/volume_file.hpp"
#include "support/data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::images {
namespace {

constexpr std::int64_t nx = 320, ny = 240;

// Matter with a pore, a thin crack across the stripes and one along them, noise 12.
std::vector<float> coating()
{
    std::vector<float> slice(nx * ny, 165.0F);
    for (std::int64_t y = 0; y < ny; ++y)
        for (std::int64_t x = 0; x < nx; ++x) {
            float& v = slice[static_cast<std::size_t>(x + nx * y)];
            if (std::hypot(x - 200, y - 60) < 30) v = 45.0F;
            if (x > 60 && x < 62 && y > 40 && y < 200) v = 45.0F;  // 1 px
            if (y == 150 && x > 100 && x < 250) v = 75.0F;
        }
    Random random(2);
    for (float& v : slice) v += static_cast<float>(12.0 * random.normal());
    return slice;
}

// One offset per line: waves from 2 px to `longest`; `deviation` rms.
std::vector<float> stripes_of(std::int64_t lines, double deviation, double longest, std::uint64_t seed)
{
    constexpr int waves = 16;
    std::vector<float> offset(static_cast<std::size_t>(lines));
    Random random(seed);
    for (int w = 0; w < waves; ++w) {
        const double length = random.uniform(2, longest), phase = random.uniform(0, 6.28);
        for (std::size_t i = 0; i < offset.size(); ++i)
            offset[i] += static_cast<float>(deviation * std::sqrt(2.0 / waves) *
                                            std::cos(6.283185307 * static_cast<double>(i) / length + phase));
    }
    return offset;
}

double rms(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>((a[i] - b[i]) * (a[i] - b[i]));
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(StripeNotch, RemovesPlantedStripesToOneLevelAndKeepsThinCracks)
{
    for (const int axis : {0, 1}) {
        const auto truth = coating();
        auto slice = truth;
        const auto offset = stripes_of(axis == 0 ? ny : nx, 4.0, 24.0, 3);
        for (std::int64_t y = 0; y < ny; ++y)
            for (std::int64_t x = 0; x < nx; ++x)
                slice[static_cast<std::size_t>(x + nx * y)] += offset[static_cast<std::size_t>(axis == 0 ? y : x)];
        Stripes how;
        how.axis = axis;
        how.length = 1.0;
        StripeFilter(nx, ny, how).remove(slice);
        std::printf("notch: %.3f gray levels of planted stripes left\n", rms(slice, truth));
        EXPECT_LE(rms(slice, truth), 1.0) << axis;
        // Contrast of the cracks: mean along them of what the filter changed, against 120 and 90 levels.
        const auto change = [&](std::int64_t x, std::int64_t y) {
            const auto i = static_cast<std::size_t>(x + nx * y);
            return static_cast<double>(slice[i] - truth[i]);
        };
        double upright = 0.0, lying = 0.0;
        for (std::int64_t y = 45; y < 195; ++y) upright += (change(61, y) - change(75, y)) / 150;
        for (std::int64_t x = 105; x < 245; ++x) lying += (change(x, 150) - change(x, 140)) / 140;
        std::printf("cracks change by %.2f of 120 and %.2f of 90\n", upright, lying);
        EXPECT_LE(std::abs(upright), 0.05 * 120);
        EXPECT_LE(std::abs(lying), 0.05 * 90);
    }
}

TEST(StripeNotch, LeavesASliceWithoutStripesAlone)
{
    const auto truth = coating();
    auto slice = truth;
    StripeFilter(nx, ny, {}).remove(slice);
    EXPECT_LE(rms(slice, truth), 1.0);
}

TEST(StripeWavelet, IsAnIdentityWithoutDampingAndRemovesStripesWithIt)
{
    std::vector<float> picture(nx * ny);
    Random random(8);
    for (float& v : picture) v = static_cast<float>(random.uniform(0, 255));
    auto same = picture;
    damp_stripes(same, nx, ny, 4, 1e-3);  // only the mean along the rows of each band
    EXPECT_LE(rms(same, picture), 10.0);
    auto none = picture;
    damp_stripes(none, nx, ny, 0, 1.0);
    EXPECT_LE(rms(none, picture), 1e-3);
    std::vector<float> flat(nx * ny, 100.0F);
    const auto offset = stripes_of(ny, 6.0, 8.0, 4);
    for (std::int64_t y = 0; y < ny; ++y)
        for (std::int64_t x = 0; x < nx; ++x)
            flat[static_cast<std::size_t>(x + nx * y)] += offset[static_cast<std::size_t>(y)];
    damp_stripes(flat, nx, ny, 5, 3.0);
    EXPECT_LE(rms(flat, std::vector<float>(nx * ny, 100.0F)), 2.0);
}

TEST(Homogeniser, FindsAndRemovesAPlantedGradient)
{
    const Shape shape{60, 50, 40};
    const Vec3 slope{0.1, -0.15, 0.3};
    for (const auto axis : {Homogenise::Axis::gradient, Homogenise::Axis::z}) {
        Volume<std::uint8_t> v(shape);
        for (std::int64_t z = 0; z < shape.nz; ++z)
            for (std::int64_t y = 0; y < shape.ny; ++y)
                for (std::int64_t x = 0; x < shape.nx; ++x) {
                    Random random(1, static_cast<std::uint64_t>(x + 60 * (y + 50 * z)));
                    const bool dark = (x * x + 3 * y + z * z) % 11 == 0;
                    const double shade = axis == Homogenise::Axis::gradient
                                             ? slope.x * static_cast<double>(x) + slope.y * static_cast<double>(y) +
                                                   slope.z * static_cast<double>(z)
                                             : slope.z * static_cast<double>(z);
                    v(x, y, z) = static_cast<std::uint8_t>(
                        std::clamp((dark ? 45.0 : 165.0) + shade + 2.0 * random.normal(), 0.0, 255.0));
                }
        Homogenise how;
        how.axis = axis;
        how.by = Homogenise::By::solid;
        Homogeniser homogeniser(shape, how, histogram_of(v.values()));
        for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.fit(z, v.slice(z));
        for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.learn(z, v.slice(z));
        homogeniser.settle();
        EXPECT_NEAR(homogeniser.gradient().z, slope.z, 0.02);
        std::vector<double> level(static_cast<std::size_t>(shape.nz));
        std::vector<std::uint8_t> slice(static_cast<std::size_t>(shape.nx * shape.ny));
        for (std::int64_t z = 0; z < shape.nz; ++z) {
            homogeniser.remove(z, v.slice(z), slice);
            level[static_cast<std::size_t>(z)] = centre_of_solid(histogram_of(slice), solid_of(histogram_of(slice)));
        }
        const auto [least, most] = std::minmax_element(level.begin(), level.end());
        EXPECT_LT(*most - *least, 1.0);
    }
}

// Rows that cross many layers, few, or next to none, either way: each part of the volume ends at the same level.
TEST(Homogeniser, LevelsEveryCornerWhateverTheDirection)
{
    const Shape shape{80, 60, 40};
    for (const Vec3& slope : {Vec3{0.2, 0.05, 0.05}, Vec3{-0.3, 0.02, 0.1}, Vec3{-0.004, 0.3, 0.2}, Vec3{0, 0, -0.4}})
        for (const auto correction : {Homogenise::Correction::offset, Homogenise::Correction::gain}) {
            Volume<std::uint8_t> v(shape);
            for (std::int64_t z = 0; z < shape.nz; ++z)
                for (std::int64_t y = 0; y < shape.ny; ++y)
                    for (std::int64_t x = 0; x < shape.nx; ++x) {
                        Random random(4, static_cast<std::uint64_t>(x + 80 * (y + 60 * z)));
                        const double shade = slope.x * static_cast<double>(x) + slope.y * static_cast<double>(y) +
                                             slope.z * static_cast<double>(z);
                        v(x, y, z) =
                            static_cast<std::uint8_t>(std::clamp(165.0 + shade + 2.0 * random.normal(), 0.0, 255.0));
                    }
            Homogenise how;
            how.correction = correction;
            Homogeniser homogeniser(shape, how, histogram_of(v.values()));
            for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.fit(z, v.slice(z));
            for (std::int64_t z = shape.nz - 1; z >= 0; --z) homogeniser.learn(z, v.slice(z));
            homogeniser.settle();
            for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(homogeniser.gradient()[axis], slope[axis], 0.005);
            Volume<std::uint8_t> out(shape);
            for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.remove(z, v.slice(z), out.slice(z));
            double sum[8] = {}, count[8] = {};
            for (std::int64_t z = 0; z < shape.nz; ++z)
                for (std::int64_t y = 0; y < shape.ny; ++y)
                    for (std::int64_t x = 0; x < shape.nx; ++x) {
                        const int corner = (x >= 40 ? 1 : 0) + (y >= 30 ? 2 : 0) + (z >= 20 ? 4 : 0);
                        sum[corner] += out(x, y, z), count[corner] += 1.0;
                    }
            for (int corner = 0; corner < 8; ++corner)
                EXPECT_NEAR(sum[corner] / count[corner], sum[0] / count[0], 0.3)
                    << corner << " " << slope.x << " " << static_cast<int>(correction);
        }
}

// Power of the mean of all levels along each column, variations over more than 65 px left out.
double curtains_of(const Volume<std::uint8_t>& v, std::int64_t y0, std::int64_t y1)
{
    const std::int64_t width = v.shape().nx;
    const auto rows = std::span(v.values())
                          .subspan(static_cast<std::size_t>(width * y0), static_cast<std::size_t>(width * (y1 - y0)));
    const auto mean = line_means(rows, width, y1 - y0, 1, Solid{});
    double power = 0.0;
    for (std::size_t i = 32; i + 32 < mean.size(); ++i) {
        double around = 0.0;
        for (std::size_t j = i - 32; j <= i + 32; ++j) around += mean[j] / 65.0;
        power += (mean[i] - around) * (mean[i] - around) / static_cast<double>(mean.size() - 64);
    }
    return power;
}

// Severe real curtains are the wavelets' case; the notch is for long faint stripes.
TEST(Stripes, OfARealCurtainedSliceFallTenfold)
{
    const auto file = support::data_folder() / "curtained_slice" / "curtained.tif";
    CRAZE_NEEDS_DATA(file);
    const auto raw = io::read_volume<std::uint8_t>(file);
    const auto [w, h, depth] = raw.shape();
    Stripes how;
    how.method = Stripes::Method::wavelet;
    how.axis = 1;
    std::vector<float> slice(raw.values().begin(), raw.values().end());
    StripeFilter(w, h, how).remove(slice);
    Volume<std::uint8_t> cleaned(raw.shape());
    for (std::size_t i = 0; i < slice.size(); ++i)
        cleaned.values()[i] = static_cast<std::uint8_t>(std::clamp(slice[i] + 0.5F, 0.0F, 255.0F));
    const double before = curtains_of(raw, 0, h), after = curtains_of(cleaned, 0, h);
    std::printf("curtains: energy %.3f before, %.3f after, falls %.1f times\n", before, after, before / after);
    EXPECT_GE(before, 10.0 * after);
    // Streaks that begin or end within the slice are short and lean a little: an eighth of it sees them, too.
    for (std::int64_t part = 0; part < 8; ++part) {
        const std::int64_t y0 = h * part / 8, y1 = h * (part + 1) / 8;
        EXPECT_GE(curtains_of(raw, y0, y1), 10.0 * curtains_of(cleaned, y0, y1)) << part;
    }
    if (const char* folder = std::getenv("CRAZE_PICTURES"))
        io::write_png(std::filesystem::path(folder) / "wavelet.png", w, h, cleaned.values());
}

}  // namespace
}  // namespace craze::images
