#include "craze/microstructure/sheets.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"
#include "craze/core/vec3.hpp"
#include "craze/microstructure/microstructure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace craze::microstructure {
namespace {

Volume<std::uint8_t> drawn(Shape s, const std::function<double(double, double, double)>& level)
{
    Volume<std::uint8_t> gray(s);
    for (std::int64_t z = 0; z < s.nz; ++z)
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x)
                gray(x, y, z) = static_cast<std::uint8_t>(
                    std::lround(level(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z))));
    return gray;
}

using Matrix = std::array<std::array<double, 3>, 3>;

// Eigenvalues, ascending, by Jacobi rotations.
std::array<double, 3> eigenvalues(Matrix m)
{
    for (int sweep = 0; sweep < 30; ++sweep)
        for (std::size_t p = 0; p < 2; ++p)
            for (std::size_t q = p + 1; q < 3; ++q) {
                if (m[p][q] == 0) continue;
                const double angle = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]);
                const double c = std::cos(angle), s = std::sin(angle);
                for (std::size_t k = 0; k < 3; ++k) {
                    const double a = m[k][p], b = m[k][q];
                    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
                }
                for (std::size_t k = 0; k < 3; ++k) {
                    const double a = m[p][k], b = m[q][k];
                    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
                }
            }
    std::array<double, 3> l{m[0][0], m[1][1], m[2][2]};
    std::sort(l.begin(), l.end());
    return l;
}

// Smoothed volume and Hessian from their definitions.
double twin(const Volume<std::uint8_t>& gray, double sigma, std::int64_t x, std::int64_t y, std::int64_t z)
{
    const Shape& s = gray.shape();
    const auto reach = static_cast<std::int64_t>(std::ceil(4 * sigma));
    const auto in = [](std::int64_t i, std::int64_t n) { return std::clamp<std::int64_t>(i, 0, n - 1); };
    x = std::clamp<std::int64_t>(x, 1, s.nx - 2), y = std::clamp<std::int64_t>(y, 1, s.ny - 2),
    z = std::clamp<std::int64_t>(z, 1, s.nz - 2);
    const auto smooth = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
        a = in(a, s.nx), b = in(b, s.ny), c = in(c, s.nz);
        double sum = 0, weights = 0;
        for (std::int64_t k = -reach; k <= reach; ++k)
            for (std::int64_t j = -reach; j <= reach; ++j)
                for (std::int64_t i = -reach; i <= reach; ++i) {
                    const double w = std::exp(-0.5 * static_cast<double>(i * i + j * j + k * k) / (sigma * sigma));
                    sum += w * gray(in(a + i, s.nx), in(b + j, s.ny), in(c + k, s.nz));
                    weights += w;
                }
        return sum / weights;
    };
    const auto second = [&](int u, int v) {
        const std::int64_t e[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        const auto at = [&](std::int64_t a, std::int64_t b) {
            return smooth(x + a * e[u][0] + b * e[v][0], y + a * e[u][1] + b * e[v][1], z + a * e[u][2] + b * e[v][2]);
        };
        return u == v ? at(1, 0) + at(-1, 0) - 2 * at(0, 0) : (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / 4;
    };
    Matrix h;
    for (int u = 0; u < 3; ++u)
        for (int v = 0; v < 3; ++v) h[static_cast<std::size_t>(u)][static_cast<std::size_t>(v)] = second(u, v);
    const auto l = eigenvalues(h);
    if (!(l[0] + l[1] + l[2] > 0)) return 0;
    return std::max(0.0, sigma * sigma * (l[2] - std::max(std::abs(l[0]), std::abs(l[1]))));
}

TEST(SheetResponse, IsItsDefinitionOnRandomVolumesOnAnyThreads)
{
    Random random(4);
    const auto gray = drawn({9, 8, 20}, [&](double, double, double) { return random.uniform(0, 255); });
    const auto both = sheet_response(gray, {0.7, 1.2});
    for (std::int64_t z = 0; z < 20; z += 3)
        for (std::int64_t y = 0; y < 8; y += 2)
            for (std::int64_t x = 0; x < 9; x += 2)
                EXPECT_NEAR(static_cast<double>(both(x, y, z)),
                            std::max(twin(gray, 0.7, x, y, z), twin(gray, 1.2, x, y, z)), 2e-3);
    set_threads(1);
    const auto one = sheet_response(gray, {0.7, 1.2});
    set_threads(0);
    EXPECT_TRUE(std::equal(both.values().begin(), both.values().end(), one.values().begin()));
}

TEST(SheetResponse, OfAThinSheetIsWhatTheoryGivesInAnyOrientation)
{
    // w = 1 px, c = 60: 60 / (sqrt(2 pi) 3) = 7.98 at sigma = 3, less 3 % by the finite difference.
    for (const Vec3 n : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, normalized({1, 2, 2}), normalized({1, 1, 0})}) {
        const auto gray = drawn({48, 48, 48}, [&](double x, double y, double z) {
            const double d = std::abs(dot(n, Vec3{x - 24, y - 24, z - 24}));
            return 160 - 60 * std::clamp(1.0 - d, 0.0, 1.0);
        });
        EXPECT_NEAR(static_cast<double>(sheet_response(gray, {3.0})(24, 24, 24)), 7.98, 0.6);
    }
}

TEST(SheetResponse, TakesNoSlopeForASheetNotEvenAtTheFaces)
{
    // One gray level per voxel ends at a face like half a valley; what is left there is the kink of the continued
    // levels.
    const auto gray = drawn({40, 30, 50}, [](double x, double y, double z) { return 230 - x - y - z; });
    const double kink = 2.0 / std::sqrt(2 * std::numbers::pi);  // sigma^2 times the second derivative of one kink
    const auto response = sheet_response(gray, {2.0});
    for (const float r : response.values()) EXPECT_LT(static_cast<double>(r), 1.1 * kink);
}

TEST(SheetResponse, IgnoresBallsRodsAndBrightSheets)
{
    const auto centre = [](const std::function<double(double, double, double)>& level) {
        return static_cast<double>(sheet_response(drawn({48, 48, 48}, level), {2.0})(24, 24, 24));
    };
    EXPECT_LT(centre([](double x, double y, double z) { return std::hypot(x - 24, y - 24, z - 24) < 3 ? 60 : 160; }),
              0.5);
    EXPECT_LT(centre([](double x, double y, double) { return std::hypot(x - 24, y - 24) < 2 ? 60 : 160; }), 0.5);
    EXPECT_EQ(centre([](double, double, double z) { return z == 24 ? 220 : 160; }), 0.0);
    EXPECT_GT(centre([](double, double, double z) { return z == 24 ? 60 : 160; }), 15.0);
}

TEST(Hysteresis, KeepsWhatHangsTogetherWithACertainVoxel)
{
    Volume<float> response({70, 3, 2}, 0.0F);
    for (int x = 5; x < 15; ++x) response(x, 1, 0) = 6.0F;
    response(9, 1, 0) = 20.0F;
    for (int x = 30; x < 40; ++x) response(x, 1, 0) = 6.0F;  // never certain
    response(60, 1, 1) = 30.0F;                              // certain, too small
    const Mask found = hysteresis(response, 5, 15, 5);
    EXPECT_EQ(found.count(), 10);
    EXPECT_TRUE(found(5, 1, 0));
}

TEST(Sheets, AskForSaneScales)
{
    const Volume<std::uint8_t> gray({5, 5, 5}, 7);
    EXPECT_THROW(sheet_response(gray, {}), InvalidInput);
    EXPECT_THROW(sheet_response(gray, {0.1}), InvalidInput);
    EXPECT_THROW(sheet_response(gray, {std::numeric_limits<double>::quiet_NaN()}), InvalidInput);
}

TEST(Classify, FindsASheetThatNoThresholdFinds)
{
    // A pore of gray 40, a faint sheet of 115 in matter of 160 with noise of 10.
    Random random(8);
    images::Gray gray;
    gray.level = drawn({64, 64, 64}, [&](double x, double y, double z) {
        const double base = std::hypot(x - 20, y - 20, z - 20) < 12 ? 40 : (z == 48 || z == 49 || z == 50) ? 115 : 160;
        return std::clamp(base + 10 * random.normal(), 0.0, 255.0);
    });
    Settings settings;
    settings.threshold = ThresholdMethod::fixed;
    settings.level = 100;
    settings.sheets.on = true;
    const Microstructure micro = classify(std::move(gray), settings);
    std::int64_t found = 0;
    for (std::int64_t y = 4; y < 60; ++y)
        for (std::int64_t x = 4; x < 60; ++x) found += micro.crack(x, y, 49) ? 1 : 0;
    EXPECT_GT(found, 56 * 56 * 95 / 100);
    EXPECT_TRUE(micro.pore(20, 20, 20));
    EXPECT_TRUE(micro.matter(50, 50, 30));
}

}  // namespace
}  // namespace craze::microstructure
