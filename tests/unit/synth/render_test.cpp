#include "craze/synth/render.hpp"

#include "craze/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace craze::synth {
namespace {

using std::numbers::pi;

/// Brute-force twin: the share of n^3 points of each voxel of slice z that lie in a pore, or in a crack and no pore.
void supersample(const Coating& coating, const SliceGrid& grid, int n, std::vector<double>& pore,
                 std::vector<double>& crack)
{
    pore.assign(static_cast<std::size_t>(grid.nx * grid.ny), 0.0);
    crack = pore;
    const double each = 1.0 / (n * n * n);
    for (std::int64_t y = 0; y < grid.ny; ++y)
        for (std::int64_t x = 0; x < grid.nx; ++x) {
            const Vec3 middle = grid.origin + grid.h * Vec3{static_cast<double>(x), static_cast<double>(y), 0.0};
            const bool far = std::all_of(coating.cracks.begin(), coating.cracks.end(), [&](const Crack& sheet) {
                return std::abs(view(sheet, middle).distance) > sheet.aperture + 2.0 * grid.h;
            });
            if (far && coating.pores.empty()) continue;
            for (int p = 0; p < n * n * n; ++p) {
                const Vec3 at = grid.origin + grid.h * Vec3{static_cast<double>(x) + (p % n + 0.5) / n - 0.5,
                                                            static_cast<double>(y) + (p / n % n + 0.5) / n - 0.5,
                                                            (p / (n * n) + 0.5) / n - 0.5};
                const auto i = static_cast<std::size_t>(x + grid.nx * y);
                if (in_pore(coating, at)) {
                    pore[i] += each;
                    continue;
                }
                for (const auto& sheet : coating.cracks) {
                    const CrackView seen = view(sheet, at);
                    if (std::abs(seen.distance) < 0.5 * seen.opening) {
                        crack[i] += each;
                        break;
                    }
                }
            }
        }
}

struct Difference {
    double rms, sum_ours, sum_theirs;
};
Difference compare(const Coating& coating, std::int64_t n, double h, int points, bool cracks)
{
    Difference d{0, 0, 0};
    std::int64_t touched = 0;
    std::vector<float> pore(static_cast<std::size_t>(n * n)), crack(pore.size());
    std::vector<double> pore_twin, crack_twin;
    for (std::int64_t z = 0; z < n; ++z) {
        const SliceGrid grid{n, n, h, {0.5 * h, 0.5 * h, (static_cast<double>(z) + 0.5) * h}};
        render_slice(coating, grid, pore, crack);
        supersample(coating, grid, points, pore_twin, crack_twin);
        for (std::size_t i = 0; i < pore.size(); ++i) {
            const double ours = cracks ? crack[i] : pore[i], theirs = cracks ? crack_twin[i] : pore_twin[i];
            d.sum_ours += ours;
            d.sum_theirs += theirs;
            if (ours == theirs) continue;
            d.rms += (ours - theirs) * (ours - theirs);
            ++touched;
        }
    }
    d.rms = std::sqrt(d.rms / static_cast<double>(std::max<std::int64_t>(1, touched)));
    return d;
}

TEST(ShareBelowPlane, EqualsCountedPoints)
{
    Random random(7);
    constexpr int n = 60;
    for (int c = 0; c < 40; ++c) {
        const Vec3 normal = c < 3 ? Vec3{c == 0 ? 1.0 : 0.0, c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0}
                                  : normalized({random.normal(), random.normal(), random.normal()});
        const double distance = random.uniform(-0.9, 0.9);
        int below = 0;
        for (int p = 0; p < n * n * n; ++p) {
            const Vec3 at{(p % n + 0.5) / n - 0.5, (p / n % n + 0.5) / n - 0.5, (p / (n * n) + 0.5) / n - 0.5};
            below += dot(normal, at) < distance;
        }
        EXPECT_NEAR(share_below_plane(normal, distance), below / double(n * n * n), c < 3 ? 0.5 / n + 1e-4 : 0.004);
    }
}

TEST(ShareBelowPlane, OfBothSidesIsOne)
{
    Random random(8);
    for (int c = 0; c < 200; ++c) {
        const Vec3 normal = normalized({random.normal(), c % 2 ? random.normal() : 0.0, 1e-5 * random.normal()});
        const double d = random.uniform(-1.0, 1.0);
        EXPECT_NEAR(share_below_plane(normal, d) + share_below_plane(normal, -d), 1.0, 1e-6);
    }
}

TEST(RenderedPore, EqualsBruteForceSupersampling)
{
    Coating coating{{18, 18, 18}, {}, {}};
    coating.pores.push_back({{{{8.3, 9.1, 8.8}, frame_about(normalized({1, 2, 3}), 0.4), {6, 5, 4}},
                              {{11.0, 10.0, 9.5}, frame_about(normalized({0, 1, 3}), 1.0), {4.5, 4.5, 3.5}}},
                             0});
    const auto d = compare(coating, 18, 1.0, 8, false);
    EXPECT_LT(d.rms, 0.03);
    EXPECT_NEAR(d.sum_ours / d.sum_theirs, 1.0, 0.01);
}

TEST(RenderedCrack, FarThinnerThanAVoxelLeavesTheRightShare)
{
    for (const double aperture : {0.05, 0.3, 1.0, 3.0}) {
        Coating coating{{18, 18, 18}, {}, {}};
        Crack crack{.centre = {9.2, 8.7, 9.4}, .frame = frame_about(normalized({1, 0.4, 2}), 0.3), .a = 7.0, .b = 6.0};
        crack.aperture = aperture;
        coating.cracks.push_back(crack);
        const auto d = compare(coating, 18, 1.0, aperture < 0.1 ? 20 : 10, true);
        EXPECT_LT(d.rms, 0.05) << aperture;  // the rounded rim of the widest is not a flat face
        EXPECT_NEAR(d.sum_ours / volume(crack), 1.0, 0.01) << aperture;
        EXPECT_NEAR(d.sum_ours / d.sum_theirs, 1.0, 0.02) << aperture;
    }
}

TEST(RenderedCrack, WavyOrBentOrFlatOpenedEqualsBruteForceSupersampling)
{
    Crack wavy{.centre = {9.2, 8.7, 9.4}, .frame = frame_about(normalized({0.2, 1, 0.3}), 0.3), .a = 7.0, .b = 6.0};
    wavy.aperture = 0.8;
    wavy.wave_height = {0.6, 0.3};
    wavy.wave_u = {0.3, -0.1};
    wavy.wave_v = {0.1, 0.4};
    wavy.wave_phase = {0.5, 2.0};
    Crack bent = wavy;
    bent.wave_height = {0, 0};
    bent.curvature = 0.06;
    Crack flat = bent;
    flat.profile = ApertureProfile::flat;
    for (const Crack& crack : {wavy, bent, flat}) {
        const Coating coating{{18, 18, 18}, {}, {crack}};
        const auto d = compare(coating, 18, 1.0, 10, true);
        EXPECT_LT(d.rms, crack.profile == ApertureProfile::flat ? 0.08 : 0.04);
        EXPECT_NEAR(d.sum_ours / d.sum_theirs, 1.0, 0.02);
        EXPECT_NEAR(d.sum_ours / volume(crack), 1.0, 0.02);
    }
}

TEST(Porosity, OfApartDefectsIsTheirAnalyticVolume)
{
    Coating coating{{40, 40, 40}, {}, {}};
    coating.pores.push_back({{{{10, 10, 10}, {}, {6, 5, 4}}}, 0});
    coating.pores.push_back({{{{30, 12, 28}, frame_about(normalized({1, 1, 1}), 0), {7, 7, 5}}}, 0});
    Crack crack{.centre = {14, 28, 22}, .frame = frame_about(normalized({3, 1, 2}), 1), .a = 9, .b = 9};
    crack.aperture = 0.4;
    coating.cracks.push_back(crack);
    const auto found = porosity(coating, 1.0);
    EXPECT_NEAR(found.pores * 64000.0, 4.0 / 3.0 * pi * (6 * 5 * 4 + 7 * 7 * 5), 0.005 * 1500);
    EXPECT_NEAR(found.cracks * 64000.0, 2.0 / 3.0 * pi * 81 * 0.4, 0.5);
    EXPECT_DOUBLE_EQ(found.total, found.pores + found.cracks);
}

TEST(Crack, InsideAPoreIsNotCountedTwice)
{
    Coating coating{{20, 20, 20}, {{{{{10, 10, 10}, {}, {8, 8, 8}}}, 0}}, {}};
    const double without = porosity(coating, 1.0).total;
    Crack crack{.centre = {10, 10, 10}, .frame = {}, .a = 6, .b = 6};
    crack.aperture = 2.0;
    coating.cracks.push_back(crack);
    EXPECT_NEAR(porosity(coating, 1.0).total, without, 1e-9);
    EXPECT_TRUE(crack_surface(coating, 1.0).triangles.empty());
}

TEST(CrackSurface, HasTheAreaOfTheSheetAndLiesOnIt)
{
    Crack crack{.centre = {20, 20, 20}, .frame = frame_about(normalized({1, 2, 1}), 0.7), .a = 10, .b = 7};
    Coating coating{{40, 40, 40}, {}, {crack}};
    const auto area = [](const mesh::CrackSurface& sheet) {
        double sum = 0.0;
        for (const auto& t : sheet.triangles) {
            const auto at = [&](std::size_t c) { return sheet.vertices[static_cast<std::size_t>(t[c])]; };
            sum += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
        }
        return sum;
    };
    EXPECT_NEAR(area(crack_surface(coating, 0.5)), pi * 70, 0.005 * pi * 70);
    coating.cracks[0].curvature = 0.05;
    for (const auto& v : crack_surface(coating, 1.0).vertices)
        EXPECT_NEAR(view(coating.cracks[0], v).distance, 0.0, 1e-9);
}

}  // namespace
}  // namespace craze::synth
