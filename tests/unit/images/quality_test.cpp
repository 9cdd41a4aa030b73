#include "craze/images/quality.hpp"

#include "craze/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace craze::images {
namespace {

constexpr Shape shape{160, 120, 8};

// Noise of deviation 12, as it comes or spread over neighbours by [1 2 1] along both axes, on an even solid or on
// waves of 40 px.
Volume<std::uint8_t> noisy(bool spread, double waves)
{
    Volume<std::uint8_t> v(shape);
    for (std::int64_t z = 0; z < shape.nz; ++z) {
        Random random(5, static_cast<std::uint64_t>(z));
        std::vector<double> white(static_cast<std::size_t>((shape.nx + 2) * (shape.ny + 2)));
        for (double& w : white) w = random.normal();
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x) {
                double n = 0.0, square = 0.0;
                for (int i = -1; i <= 1; ++i)
                    for (int j = -1; j <= 1; ++j) {
                        const double w =
                            spread ? (2 - std::abs(i)) * (2 - std::abs(j)) : (i == 0 && j == 0 ? 1.0 : 0.0);
                        n += w * white[static_cast<std::size_t>(x + 1 + i + (shape.nx + 2) * (y + 1 + j))];
                        square += w * w;
                    }
                const double wave = waves * std::sin(6.2832 * static_cast<double>(x) / 40.0) *
                                    std::sin(6.2832 * static_cast<double>(y) / 40.0);
                const bool dark = (x + 2 * y + 3 * z) % 97 < 4;
                v(x, y, z) = static_cast<std::uint8_t>(
                    std::clamp((dark ? 45.0 : 165.0) + wave + 12.0 * n / std::sqrt(square) + 0.5, 0.0, 255.0));
            }
    }
    return v;
}

Quality quality(const Volume<std::uint8_t>& v)
{
    return quality_of(
        "raw", shape, [&](std::int64_t z, std::span<std::uint8_t> to) { std::ranges::copy(v.slice(z), to.begin()); }, 0,
        64.0);
}

TEST(Noise, IsFoundWhetherItsVoxelsAreIndependentOrNot)
{
    const Quality white = quality(noisy(false, 0.0));
    EXPECT_NEAR(white.noise, 12.0, 1.2);
    EXPECT_NEAR(white.noise_apart, 12.0, 0.6);
    EXPECT_FALSE(white.correlated);
    const Quality smooth = quality(noisy(true, 0.0));
    EXPECT_LT(smooth.noise, 6.0);
    EXPECT_NEAR(smooth.noise_apart, 12.0, 0.6);
    EXPECT_TRUE(smooth.correlated);
}

TEST(Noise, IsNotWhatWidensWithDistance)
{
    const Quality textured = quality(noisy(true, 60.0));
    EXPECT_GT(textured.noise_apart, 1.3 * textured.noise);
    EXPECT_FALSE(textured.correlated);
}

TEST(Noise, OfASliceTooSmallForTheMaskIsZero)
{
    const std::vector<std::uint8_t> slice(64, 100);
    EXPECT_EQ(noise_of_slice(slice, 8, 8, 4), 0.0);
    EXPECT_EQ(noise_of_slice(slice, 32, 2), 0.0);
}

}  // namespace
}  // namespace craze::images
