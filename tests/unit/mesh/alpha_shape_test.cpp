#include "craze/mesh/alpha_shape.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/vec3.hpp"
#include "support/masks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace craze::mesh {
namespace {

using support::mask_of;
using support::random_mask;

Vec3 at(const LatticeSurface& s, std::int32_t v)
{
    const auto& p = s.vertices[static_cast<std::size_t>(v)];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Vec3 area_vector(const LatticeSurface& s, std::size_t t)
{
    const auto& k = s.triangles[t];
    return 0.5 * cross(at(s, k[1]) - at(s, k[0]), at(s, k[2]) - at(s, k[0]));
}

// Each sheet counted once: two skins are one sheet.
double area(const LatticeSurface& s)
{
    double sum = 0.0;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) sum += 0.5 * s.sides[t] * norm(area_vector(s, t));
    return sum;
}

// Edges and how many triangles meet there.
std::map<std::pair<std::int32_t, std::int32_t>, int> edges(const LatticeSurface& s)
{
    std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
    for (const auto& t : s.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
    return uses;
}

std::int64_t euler_number(const LatticeSurface& s)
{
    return static_cast<std::int64_t>(s.vertices.size()) - static_cast<std::int64_t>(edges(s).size()) +
           static_cast<std::int64_t>(s.triangles.size());
}

class AlphaShape : public testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    void TearDown() override { set_threads(0); }
};

TEST_F(AlphaShape, OfAPlaneSheetIsItsRectangleWithoutHoles)
{
    for (const double alpha : {0.75, 0.87, 1.0, 1.5, 2.0, 3.0, 4.0})
        for (int axis = 0; axis < 3; ++axis) {
            const Mask plane = mask_of(Shape{20, 20, 20}, [&](auto x, auto y, auto z) {
                const std::int64_t p[] = {x, y, z};
                return p[axis] == 7 && p[(axis + 1) % 3] >= 2 && p[(axis + 1) % 3] <= 17 && p[(axis + 2) % 3] >= 4;
            });
            const LatticeSurface s = alpha_shape(plane, alpha);
            EXPECT_EQ(s.vertices.size(), 256U);
            EXPECT_EQ(s.triangles.size(), 450U);
            EXPECT_NEAR(area(s), 225.0, 1e-9);
            EXPECT_EQ(euler_number(s), 1);  // a disc
            for (const auto& [edge, uses] : edges(s)) EXPECT_LE(uses, 2);
        }
}

TEST_F(AlphaShape, HasATriangleOnlyWhereASmallEnoughBallFits)
{
    Mask right(Shape{8, 8, 1});  // hypotenuse 5: radius 2.5
    right.set(0, 0, 0, true);
    right.set(3, 0, 0, true);
    right.set(0, 4, 0, true);
    EXPECT_EQ(alpha_shape(right, 2.49).triangles.size(), 0U);
    EXPECT_EQ(alpha_shape(right, 2.5).triangles.size(), 1U);
    right.set(1, 1, 0, true);  // in the middle: three smaller ones, of which one is too wide
    const LatticeSurface split = alpha_shape(right, 2.5);
    EXPECT_EQ(split.vertices.size(), 4U);
    EXPECT_EQ(split.triangles.size(), 2U);
}

TEST_F(AlphaShape, OfASolidBlockIsItsSkinTurnedOutwards)
{
    const Mask block = mask_of(Shape{9, 8, 7}, [](auto x, auto y, auto z) {
        return x >= 1 && x <= 6 && y >= 2 && y <= 6 && z >= 2 && z <= 5;
    });
    for (const double alpha : {0.87, 1.5, 2.0, 3.0}) {
        const LatticeSurface s = alpha_shape(block, alpha);
        EXPECT_EQ(s.triangles.size(), 2U * 2U * (5 * 4 + 5 * 3 + 4 * 3));
        EXPECT_EQ(euler_number(s), 2);
        double volume = 0.0;
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            EXPECT_EQ(s.sides[t], 1);
            volume += dot(at(s, s.triangles[t][0]), area_vector(s, t)) / 3.0;
        }
        EXPECT_NEAR(volume, 60.0, 1e-9);
    }
}

// Of 20 000 rays from `centre`, evenly over the sphere, those that meet no triangle (edges count as met).
int rays_that_miss(const LatticeSurface& s, const Vec3& centre)
{
    constexpr int rays = 20'000;
    std::vector<Vec3> ray;  // a spiral from z = 1 down: rays of like z lie together
    for (int k = 0; k < rays; ++k) {
        const double z = 1.0 - (2.0 * k + 1.0) / rays, turn = k * std::numbers::pi * (3.0 - std::sqrt(5.0));
        const double r = std::sqrt(1.0 - z * z);
        ray.push_back({r * std::cos(turn), r * std::sin(turn), z});
    }
    std::vector<char> met(rays, 0);
    for (const auto& t : s.triangles) {
        const Vec3 a = at(s, t[0]) - centre, b = at(s, t[1]) - centre, c = at(s, t[2]) - centre;
        // The ray lies in the cone of the three corners: on the same side of its three planes.
        const Vec3 sides[] = {cross(a, b), cross(b, c), cross(c, a)};
        const double turned = dot(sides[0], c) < 0.0 ? -1.0 : 1.0;
        const double z[] = {a.z / norm(a), b.z / norm(b), c.z / norm(c)};
        constexpr double bulge = 0.05;  // arcs reach beyond their ends
        const auto first = static_cast<int>((1.0 - std::ranges::max(z) - bulge) * 0.5 * rays);
        const auto last = static_cast<int>((1.0 - std::ranges::min(z) + bulge) * 0.5 * rays);
        for (int k = std::max(first, 0); k <= std::min(last, rays - 1); ++k) {
            const Vec3& d = ray[static_cast<std::size_t>(k)];
            const bool inside = dot(d, a + b + c) > 0.0 &&
                                std::ranges::all_of(sides, [&](const Vec3& n) { return turned * dot(d, n) >= -1e-9; });
            if (inside) met[static_cast<std::size_t>(k)] = 1;
        }
    }
    return static_cast<int>(std::ranges::count(met, 0));
}

TEST_F(AlphaShape, OfASphereShellHasNoHoleAndTheSpheresArea)
{
    const double radius = 14.0;
    const Vec3 centre{17.5, 17.5, 17.5};
    const Mask shell = mask_of(Shape{36, 36, 36}, [&](auto x, auto y, auto z) {
        const Vec3 d{static_cast<double>(x) - 17.5, static_cast<double>(y) - 17.5, static_cast<double>(z) - 17.5};
        return std::abs(norm(d) - radius) < 0.5;
    });
    const LatticeSurface s = alpha_shape(shell, 2.0);
    EXPECT_EQ(rays_that_miss(s, centre), 0);
    // Voxels lie up to half a voxel off the sphere, so triangles a voxel or two wide tilt by some 10 to 20 degrees:
    // up to four per cent more area, none less.
    EXPECT_GT(area(s) / (4.0 * std::numbers::pi * radius * radius), 1.0);
    EXPECT_LT(area(s) / (4.0 * std::numbers::pi * radius * radius), 1.04);

    // The rays do see a hole: without the triangles within a voxel of one point they miss.
    LatticeSurface pierced = s;
    std::erase_if(pierced.triangles, [&](const std::array<std::int32_t, 3>& t) {
        return norm((at(s, t[0]) + at(s, t[1]) + at(s, t[2])) / 3.0 - centre - radius * normalized({1, 2, 3})) < 1.0;
    });
    EXPECT_GT(rays_that_miss(pierced, centre), 3);
}

TEST_F(AlphaShape, OfATJunctionIsTwoSheetsThatMeetInANarrowFillet)
{
    const Mask junction = mask_of(Shape{21, 11, 15}, [](auto x, auto, auto z) { return z == 4 || (x == 10 && z > 4); });
    const LatticeSurface s = alpha_shape(junction, 0.87);
    // Both inner corners hold a prism: legs of one voxel, the slanted side sqrt(2) wide, 10 long.
    int skins = 0;
    for (const std::uint8_t sides : s.sides) skins += sides == 1;
    EXPECT_EQ(skins, 40 + 40 + 4);  // below, slanted, four ends
    EXPECT_EQ(s.triangles.size(), 84U + 2U * (18 * 10 + 9 * 10));
    EXPECT_NEAR(area(s), 18.0 * 10.0 + 9.0 * 10.0 + 0.5 * (20.0 + 20.0 * std::numbers::sqrt2 + 2.0), 1e-9);
    int rim = 0;
    for (const auto& [edge, uses] : edges(s)) rim += uses == 1;
    EXPECT_EQ(rim, 2 * 18 + 2 * 10 + 2 * 9 + 10);  // only the outer border: no holes
}

TEST_F(AlphaShape, HasNoTriangleTwiceAndNoneFlat)
{
    for (const double alpha : {0.87, 1.42, 2.0, 2.6}) {
        const LatticeSurface s = alpha_shape(random_mask(Shape{24, 22, 20}, 0.2, 8), alpha);
        std::set<std::array<std::int32_t, 3>> seen;
        for (std::size_t t = 0; t < s.triangles.size(); ++t) {
            auto sorted = s.triangles[t];
            std::ranges::sort(sorted);
            EXPECT_TRUE(seen.insert(sorted).second);
            EXPECT_GT(norm(area_vector(s, t)), 0.4);
        }
    }
}

TEST_F(AlphaShape, IsTheSameOnAnyNumberOfThreads)
{
    const Mask points = random_mask(Shape{70, 30, 20}, 0.1, 4);
    set_threads(1);
    const LatticeSurface one = alpha_shape(points, 2.0);
    set_threads(2);
    const LatticeSurface two = alpha_shape(points, 2.0);
    EXPECT_EQ(one.vertices, two.vertices);
    EXPECT_EQ(one.triangles, two.triangles);
    EXPECT_EQ(one.sides, two.sides);
}

TEST_F(AlphaShape, OfNothingIsNothing)
{
    EXPECT_TRUE(alpha_shape(Mask(Shape{5, 5, 5}), 2.0).triangles.empty());
    EXPECT_TRUE(alpha_shape(Mask(Shape{}), 2.0).triangles.empty());
}

}  // namespace
}  // namespace craze::mesh
