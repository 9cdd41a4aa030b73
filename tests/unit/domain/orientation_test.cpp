#include "craze/domain/orientation.hpp"

#include "craze/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace craze::domain {
namespace {

// The twin works on integers, where every product is exact.
__extension__ using Big = __int128;
struct Point {
    std::int64_t x, y, z;
    Vec3 real() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
};
struct BigVector {
    Big x, y, z;
};
BigVector minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
BigVector cross(const BigVector& a, const BigVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Big dot(const BigVector& a, const BigVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
int sign(Big v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

int twin_orientation(const Point& a, const Point& b, const Point& c, const Point& d)
{
    return sign(dot(cross(minus(b, a), minus(c, a)), minus(d, a)));
}

// Two convex sets are apart if and only if a face of their Minkowski difference separates them.
bool twin_meets(const Point& p, const Point& q, const Point& a, const Point& b, const Point& c)
{
    const BigVector n = cross(minus(b, a), minus(c, a)), d = minus(q, p);
    if (n.x == 0 && n.y == 0 && n.z == 0) return false;  // no area: the rule of meets()
    const std::array<BigVector, 3> edge{minus(b, a), minus(c, b), minus(a, c)};
    std::vector<BigVector> axes{n, cross(n, d)};
    for (const auto& e : edge) {
        axes.push_back(cross(d, e));
        axes.push_back(cross(n, e));
    }
    const auto along = [](const BigVector& axis, const Point& k) { return dot(axis, BigVector{k.x, k.y, k.z}); };
    for (const auto& axis : axes) {
        const Big s0 = along(axis, p), s1 = along(axis, q), t0 = along(axis, a), t1 = along(axis, b),
                  t2 = along(axis, c);
        if (std::max(s0, s1) < std::min({t0, t1, t2}) || std::min(s0, s1) > std::max({t0, t1, t2})) return false;
    }
    return true;
}

Point random_point(Random& random, std::int64_t range)
{
    return {random.below(range), random.below(range), random.below(range)};
}

TEST(Orientation, IsExactWhereRoundingWouldDecide)
{
    std::int64_t zeros = 0;
    for (std::uint64_t k = 0; k < 20000; ++k) {
        Random random(1, k);
        const std::int64_t range = std::int64_t{1} << 31;
        const Point a = random_point(random, range), b = random_point(random, range), c = random_point(random, range);
        // In the plane of a, b, c but for one step of the grid.
        const std::int64_t s = random.below(3) - 1, t = random.below(3) - 1;
        Point d{a.x + s * (b.x - a.x) + t * (c.x - a.x), a.y + s * (b.y - a.y) + t * (c.y - a.y),
                a.z + s * (b.z - a.z) + t * (c.z - a.z)};
        d.z += random.below(3) - 1;
        const int twin = twin_orientation(a, b, c, d);
        zeros += twin == 0;
        ASSERT_EQ(orientation(a.real(), b.real(), c.real(), d.real()), twin) << k;
        ASSERT_EQ(orientation(b.real(), a.real(), c.real(), d.real()), -twin) << k;
    }
    EXPECT_GT(zeros, 5000);
}

TEST(Orientation, IsExactForDecimalFractions)
{
    // 0.1 and its multiples are no doubles: the plane x + y + z = 0.3 misses its own corners by their rounding.
    const Vec3 a{0.3, 0, 0}, b{0, 0.3, 0}, c{0, 0, 0.3};
    EXPECT_EQ(orientation(a, b, c, {0.15, 0.15, 0}), 0);
    EXPECT_EQ(orientation(a, b, c, {0.1, 0.1, 0.1}), 0.1 + 0.1 + 0.1 > 0.3 ? 1 : -1);  // 3 x 0.1 is above 0.3, exactly
    EXPECT_EQ(orientation(a, b, c, {0.1, 0.2, 0}), 1);
}

TEST(Turn, IsExactWhereRoundingWouldDecide)
{
    for (std::uint64_t k = 0; k < 20000; ++k) {
        Random random(2, k);
        const Point a = random_point(random, std::int64_t{1} << 50), b = random_point(random, std::int64_t{1} << 50);
        const Point c{2 * b.x - a.x, 2 * b.y - a.y + random.below(3) - 1, 0};
        const BigVector u = minus(b, a), v = minus(c, a);
        ASSERT_EQ(turn(a.real(), b.real(), c.real(), 0, 1), sign(u.x * v.y - u.y * v.x));
    }
}

TEST(Meets, EqualsSeparatingAxesOnLatticesFullOfDegenerateCases)
{
    std::int64_t met = 0, coplanar = 0;
    for (std::uint64_t k = 0; k < 200000; ++k) {
        Random random(3, k);
        const std::int64_t range = 2 + random.below(5);
        const Point p = random_point(random, range), q = random_point(random, range), a = random_point(random, range),
                    b = random_point(random, range), c = random_point(random, range);
        const bool twin = twin_meets(p, q, a, b, c);
        met += twin;
        coplanar += twin && twin_orientation(a, b, c, p) == 0 && twin_orientation(a, b, c, q) == 0;
        ASSERT_EQ(meets(p.real(), q.real(), a.real(), b.real(), c.real()), twin) << k;
        ASSERT_EQ(meets(q.real(), p.real(), c.real(), b.real(), a.real()), twin) << k;
    }
    EXPECT_GT(met, 20000);
    EXPECT_GT(coplanar, 2000);
}

TEST(Meets, CountsTouching)
{
    const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    EXPECT_TRUE(meets({1, 1, -1}, {1, 1, 1}, a, b, c));       // through the inside
    EXPECT_TRUE(meets({2, 0, -1}, {2, 0, 1}, a, b, c));       // an edge
    EXPECT_TRUE(meets({0, 0, -1}, {0, 0, 1}, a, b, c));       // a vertex
    EXPECT_TRUE(meets({1, 1, 0}, {1, 1, 5}, a, b, c));        // an end on the sheet
    EXPECT_TRUE(meets({-1, 1, 0}, {9, 1, 0}, a, b, c));       // in the plane, across
    EXPECT_TRUE(meets({1, 1, 0}, {1.5, 1, 0}, a, b, c));      // in the plane, inside
    EXPECT_TRUE(meets({-1, 0, 0}, {9, 0, 0}, a, b, c));       // along an edge
    EXPECT_TRUE(meets({4, 0, 0}, {9, 0, 0}, a, b, c));        // in line with an edge, at its end
    EXPECT_FALSE(meets({4.0001, 0, 0}, {9, 0, 0}, a, b, c));  // beyond it
    EXPECT_FALSE(meets({1, 1, 1}, {1, 1, 2}, a, b, c));
    EXPECT_FALSE(meets({3, 3, -1}, {3, 3, 1}, a, b, c));
    EXPECT_FALSE(meets({0, 0, -1}, {0, 0, 1}, a, b, b));  // no area
}

}  // namespace
}  // namespace craze::domain
