#include "craze/domain/thickness.hpp"

#include "craze/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::domain {
namespace {

microstructure::Microstructure blank(Shape shape, double h, std::uint8_t gray, int threshold)
{
    microstructure::Microstructure m;
    m.gray.level = Volume<std::uint8_t>(shape, gray);
    m.gray.voxel_size = h;
    m.threshold = threshold;
    m.pore = Mask(shape);
    m.crack = Mask(shape);
    m.matter = complement(m.pore);
    return m;
}

void darken(microstructure::Microstructure& m, std::int64_t x, std::int64_t y, std::int64_t z, std::uint8_t gray)
{
    m.gray.level(x, y, z) = gray;
    m.crack.set(x, y, z, true);
    m.matter.set(x, y, z, false);
}

TEST(BinaryThickness, IsThatOfFigure15)
{
    EXPECT_NEAR(binary_thickness({.total = 225, .black = 28, .darkness = 0}, 25.0), 3.1, 0.05);
}

TEST(BinaryThickness, OfFigure15DrawnInVoxels)  // 25 px long, 9 px across, 28 of 225 px black
{
    constexpr double h = 20e-9;
    auto m = blank({40, 10, 10}, h, 200, 100);
    std::int64_t drawn = 0;
    for (std::int64_t x = 10; drawn < 28; ++x)
        for (std::int64_t y = 3; y < 6; ++y)
            for (std::int64_t z = 3; z < 6 && drawn < 28; ++z, ++drawn) darken(m, x, y, z, 0);
    // The beam of radius 1.5 px around the middle of 3 x 3 voxels holds all nine.
    const auto voxels =
        voxels_in_cylinder({5 * h, 4.5 * h, 4.5 * h}, {30 * h, 4.5 * h, 4.5 * h}, 1.5 * h, m, CountedVoid::crack);
    EXPECT_EQ(voxels.total, 225);
    EXPECT_EQ(voxels.black, 28);
    EXPECT_NEAR(binary_thickness(voxels, 25 * h) / h, 3.1, 0.05);
    EXPECT_DOUBLE_EQ(intensity_thickness(voxels, 25 * h), binary_thickness(voxels, 25 * h));  // I = 0
}

TEST(IntensityThickness, TakesNothingBackForCrackVoxelsBrighterThanTheThreshold)  // [Eq. 15]: N^{<S}
{
    auto m = blank({20, 5, 5}, 1.0, 200, 100);
    for (const auto& [x, gray] : {std::pair{8, 0}, {9, 100}, {10, 180}})
        for (std::int64_t y = 0; y < 5; ++y)
            for (std::int64_t z = 0; z < 5; ++z) darken(m, x, y, z, static_cast<std::uint8_t>(gray));
    const auto voxels = voxels_in_cylinder({5, 2.5, 2.5}, {15, 2.5, 2.5}, 1.2, m, CountedVoid::crack);
    EXPECT_DOUBLE_EQ(binary_thickness(voxels, 10.0), 3.0);
    EXPECT_DOUBLE_EQ(intensity_thickness(voxels, 10.0), 1.0);
}

TEST(VoxelsInCylinder, EqualBruteForceInEveryDirection)
{
    constexpr double h = 0.1;
    auto m = blank({24, 20, 22}, h, 200, 100);
    Random noise(5, 1);
    for (std::int64_t z = 0; z < 22; ++z)
        for (std::int64_t y = 0; y < 20; ++y)
            for (std::int64_t x = 0; x < 24; ++x) {
                const auto gray = static_cast<std::uint8_t>(noise.below(200));
                if (gray < 100) darken(m, x, y, z, gray);
                if (gray % 7 == 0 && gray < 100) m.crack.set(x, y, z, false), m.pore.set(x, y, z, true);
            }
    for (std::uint64_t k = 0; k < 400; ++k) {
        Random random(6, k);
        Vec3 a{random.uniform(-0.3, 2.6), random.uniform(-0.3, 2.3), random.uniform(-0.3, 2.5)};
        Vec3 d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        if (k % 4 == 0) d = {k % 3 == 0 ? 0.9 : 0.0, k % 3 == 1 ? 0.9 : 0.0, k % 3 == 2 ? 0.9 : 0.0};
        if (k % 8 == 0)
            a = {0.1 * std::round(a.x * 10) + 0.05, 0.1 * std::round(a.y * 10) + 0.05,
                 0.1 * std::round(a.z * 10) + 0.05};
        const double R = k % 8 == 0 ? 0.2 : random.uniform(0.03, 0.5);
        const Vec3 b = a + d;
        const double L = norm(b - a);
        const Vec3 t = (b - a) / L;
        for (const CountedVoid counted : {CountedVoid::crack, CountedVoid::all}) {
            CylinderVoxels twin;
            for (std::int64_t z = 0; z < 22; ++z)
                for (std::int64_t y = 0; y < 20; ++y)
                    for (std::int64_t x = 0; x < 24; ++x) {
                        const Vec3 c = h * Vec3{double(x) + 0.5, double(y) + 0.5, double(z) + 0.5} - a;
                        const double s = dot(c, t);
                        if (s < -1e-9 || s > L + 1e-9 || dot(c, c) - s * s > R * R + 1e-9) continue;
                        ++twin.total;
                        if (m.crack(x, y, z) || (counted == CountedVoid::all && m.pore(x, y, z))) {
                            ++twin.black;
                            twin.darkness += 1.0 - m.gray.level(x, y, z) / 100.0;
                        }
                    }
            if (twin.total == 0) continue;
            const auto found = voxels_in_cylinder(a, b, R, m, counted);
            ASSERT_EQ(found.total, twin.total) << k;
            ASSERT_EQ(found.black, twin.black) << k;
            ASSERT_NEAR(found.darkness, twin.darkness, 1e-9) << k;
        }
    }
}

TEST(VoxelsInCylinder, TooThinForAnyCentreAreThoseAlongTheAxis)
{
    const auto m = blank({10, 10, 10}, 1.0, 200, 100);
    const auto voxels = voxels_in_cylinder({2.1, 3.1, 4.1}, {7.9, 3.1, 4.1}, 0.2, m, CountedVoid::crack);
    EXPECT_EQ(voxels.total, 6);
    EXPECT_EQ(voxels_in_cylinder({-5, -5, -5}, {-3, -5, -5}, 0.2, m, CountedVoid::crack).total, 0);
    EXPECT_EQ(binary_thickness({}, 1.0), 0.0);
}

TEST(MeasureThickness, OfATiltedSlabIsItsThicknessAlongTheBond)
{
    constexpr double h = 1.0;
    auto m = blank({60, 60, 60}, h, 200, 100);
    for (std::int64_t z = 0; z < 60; ++z)
        for (std::int64_t y = 0; y < 60; ++y)
            for (std::int64_t x = 25; x < 31; ++x) darken(m, x, y, z, 50);  // 6 px, half as bright as S
    const Elements e{{10, 50, 15}, {30, 30, 20}, {30, 30, 30}, {8, 8, 8}};
    const Elements oblique{{14, 42}, {16, 44}, {30, 30}, {8, 8}};
    PairCracks cracks{{1, 0}, {}, {}};
    const std::vector<std::int32_t> i{0, 0}, j{1, 2};
    measure_thickness(cracks, e, i, j, 6.0, m, CountedVoid::crack);
    EXPECT_DOUBLE_EQ(cracks.T1[0], 6.0);
    EXPECT_DOUBLE_EQ(cracks.T2[0], 3.0);
    EXPECT_EQ(cracks.T1[1], 0.0);  // not cut
    PairCracks tilted{{1}, {}, {}};
    measure_thickness(tilted, oblique, std::vector<std::int32_t>{0}, std::vector<std::int32_t>{1}, 5.0, m,
                      CountedVoid::crack);
    EXPECT_NEAR(tilted.T1[0], 6.0 * std::sqrt(2.0), 0.3);  // measured along the bond, 45 degrees to the slab
}

}  // namespace
}  // namespace craze::domain
