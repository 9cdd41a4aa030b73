#include "craze/microstructure/objects.hpp"

#include "craze/microstructure/distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace craze::microstructure {
namespace {

using std::numbers::pi;

Mask drawn(Shape s, const std::function<bool(double, double, double)>& inside)
{
    Mask mask(s);
    for (std::int64_t z = 0; z < s.nz; ++z)
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x)
                mask.set(
                    x, y, z,
                    inside(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, static_cast<double>(z) + 0.5));
    return mask;
}

std::vector<Object> objects_of(const Mask& mask)
{
    return measured(mask, components(mask), squared_distance(complement(mask)));
}

TEST(Object, OfABallHasItsRadiusSurfaceAndShape)
{
    const auto objects = objects_of(drawn(
        {70, 66, 68}, [](double x, double y, double z) { return std::hypot(x - 35.2, y - 33.4, z - 34.1) <= 20; }));
    ASSERT_EQ(objects.size(), 1U);
    const Object& o = objects[0];
    EXPECT_NEAR(o.equivalent_radius, 20, 0.05);
    EXPECT_NEAR(o.surface / (4 * pi * 400), 1, 0.015);
    EXPECT_NEAR(o.sphericity, 1, 0.015);
    EXPECT_NEAR(o.inscribed_radius, 20, 1.0);
    EXPECT_NEAR(norm(o.centroid - Vec3{35.2, 33.4, 34.1}), 0, 0.05);
    for (const double axis : o.semi_axes) EXPECT_NEAR(axis, 20, 0.1);
    EXPECT_FALSE(o.at_border);
}

TEST(Object, OfATiltedEllipsoidFindsItsAxes)
{
    // Semi-axes 24, 14, 6; the shortest along n, the longest along m.
    const Vec3 m = normalized({1, 2, 2}), n = normalized({2, 1, -2}), k = cross(n, m), centre{40, 41, 39};
    const auto objects = objects_of(drawn({80, 80, 80}, [&](double x, double y, double z) {
        const Vec3 d = Vec3{x, y, z} - centre;
        return std::hypot(dot(d, m) / 24, dot(d, k) / 14, dot(d, n) / 6) <= 1;
    }));
    ASSERT_EQ(objects.size(), 1U);
    const Object& o = objects[0];
    EXPECT_NEAR(o.semi_axes[0], 24, 0.2);
    EXPECT_NEAR(o.semi_axes[1], 14, 0.2);
    EXPECT_NEAR(o.semi_axes[2], 6, 0.2);
    EXPECT_NEAR(std::abs(dot(o.major, m)), 1, 1e-4);
    EXPECT_NEAR(std::abs(dot(o.minor, n)), 1, 1e-4);
    EXPECT_GE(o.minor.z, 0);
    // Thomsen's approximation of the surface, good to 1.1 %.
    const double p = 1.6075;
    const double area =
        4 * pi * std::pow((std::pow(24. * 14, p) + std::pow(24. * 6, p) + std::pow(14. * 6, p)) / 3, 1 / p);
    EXPECT_NEAR(o.surface / area, 1, 0.04);
}

// What the header says of planes across an axis.
TEST(Object, OfAPlateAlongTheAxesHasItsSurfaceToTenPercent)
{
    for (const int n : {1, 3}) {
        Mask plate({70, 70, 9});
        for (int z = 3; z < 3 + n; ++z)
            for (int y = 5; y < 65; ++y)
                for (int x = 5; x < 65; ++x) plate.set(x, y, z, true);
        const auto objects = measured(plate, components(plate), squared_distance(complement(plate)));
        ASSERT_EQ(objects.size(), 1U);
        EXPECT_NEAR(objects[0].surface / (2.0 * 60 * 60 + 4.0 * 60 * n), 0.92, 0.02) << n;
    }
}

TEST(Object, SurfaceLeavesOutTheSectionsByTheBorder)
{
    const auto objects = objects_of(drawn({90, 50, 50}, [](double, double y, double z) {
        return std::hypot(y - 25, z - 25) <= 12;  // a cylinder through the whole volume
    }));
    ASSERT_EQ(objects.size(), 1U);
    // 13 directions see 0.9806 of a cylinder along x; both ends lose less than a voxel each.
    EXPECT_NEAR(objects[0].surface / (2 * pi * 12 * 90), 0.9806, 0.025);
    EXPECT_TRUE(objects[0].at_border);
    EXPECT_TRUE(objects[0].spans(0, {90, 50, 50}));
    EXPECT_FALSE(objects[0].spans(1, {90, 50, 50}));
}

TEST(Object, EachComponentIsMeasuredOnItsOwn)
{
    Mask mask({100, 20, 20});
    mask.set(0, 0, 0, true);
    for (int x = 60; x < 70; ++x) mask.set(x, 10, 10, true);
    const auto objects = objects_of(mask);
    ASSERT_EQ(objects.size(), 2U);
    EXPECT_EQ(objects[0].volume, 1);
    EXPECT_TRUE(objects[0].at_border);
    EXPECT_EQ(objects[1].volume, 10);
    EXPECT_FALSE(objects[1].at_border);
    EXPECT_EQ(objects[1].inscribed_radius, 1.0);
    EXPECT_EQ(objects[1].centroid, (Vec3{65.0, 10.5, 10.5}));
    EXPECT_EQ(objects[1].box, (std::array<std::int32_t, 6>{60, 69, 10, 10, 10, 10}));
    EXPECT_NEAR(objects[1].major.x * objects[1].major.x, 1.0, 1e-12);
}

}  // namespace
}  // namespace craze::microstructure
