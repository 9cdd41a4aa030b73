#include "craze/domain/cracks.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/orientation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::domain {
namespace {

struct Case {
    Elements elements;
    std::vector<std::int32_t> i, j;
    mesh::CrackSurface surface;
};

std::vector<std::uint8_t> brute_force(const Case& c)
{
    std::vector<std::uint8_t> met(c.i.size(), 0);
    for (std::size_t s = 0; s < c.i.size(); ++s) {
        int count = 0;
        for (const auto& t : c.surface.triangles) {
            const auto vertex = [&](int k) {
                return c.surface.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
            };
            count += meets(c.elements.centre(c.i[s]), c.elements.centre(c.j[s]), vertex(0), vertex(1), vertex(2));
        }
        met[s] = static_cast<std::uint8_t>(std::min(count, 255));
    }
    return met;
}

// Segments and triangles on a lattice of step h (many degenerate cases) or anywhere, sheets, giants and specks.
Case random_case(std::uint64_t k)
{
    Random random(7, k);
    Case c;
    const bool lattice = k % 3 != 0;
    const double h = k % 2 == 0 ? 1.0 : 23.6e-9, range = 3.0 + static_cast<double>(random.below(6));
    const auto point = [&]() -> Vec3 {
        Vec3 p{random.uniform(0, range), random.uniform(0, range), random.uniform(0, range)};
        if (lattice) p = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
        return h * p;
    };
    const auto elements = 2 + random.below(8);
    for (std::int64_t e = 0; e < elements; ++e) {
        const Vec3 p = point();
        c.elements.x.push_back(p.x), c.elements.y.push_back(p.y), c.elements.z.push_back(p.z);
        c.elements.r.push_back(h);
    }
    for (std::int32_t a = 0; a < elements; ++a)
        for (std::int32_t b = a + 1; b < elements; ++b)
            if (random.below(3) != 0 && !(c.elements.centre(a) == c.elements.centre(b)))
                c.i.push_back(a), c.j.push_back(b);
    const auto vertices = 3 + random.below(12);
    for (std::int64_t v = 0; v < vertices; ++v) c.surface.vertices.push_back(point());
    const auto triangles = random.below(25);
    for (std::int64_t t = 0; t < triangles; ++t) {
        const auto pick = [&] { return static_cast<std::int32_t>(random.below(vertices)); };
        c.surface.triangles.push_back({pick(), pick(), pick()});
    }
    return c;
}

TEST(CutBonds, EqualBruteForceOnTenThousandRandomSheets)
{
    std::int64_t met = 0, cases = 0;
    for (std::uint64_t k = 0; k < 10000; ++k) {
        const Case c = random_case(k);
        const auto found = triangles_met(c.elements, c.i, c.j, c.surface), twin = brute_force(c);
        ASSERT_EQ(found, twin) << "case " << k;
        met += std::ranges::count_if(twin, [](auto n) { return n > 0; });
        cases += static_cast<std::int64_t>(twin.size());
    }
    EXPECT_GT(met, cases / 10);
}

TEST(CutBonds, OfAWavySheetEqualBruteForceAndDoNotDependOnThreads)
{
    Case c;
    Random random(11, 0);
    for (std::int32_t e = 0; e < 600; ++e) {
        c.elements.x.push_back(random.uniform()), c.elements.y.push_back(random.uniform());
        c.elements.z.push_back(random.uniform()), c.elements.r.push_back(0.05);
    }
    for (std::int32_t a = 0; a < 600; ++a)
        for (std::int32_t b = a + 1; b < 600; ++b)
            if (norm(c.elements.centre(b) - c.elements.centre(a)) < 0.1) c.i.push_back(a), c.j.push_back(b);
    constexpr std::int32_t n = 60;
    for (std::int32_t u = 0; u <= n; ++u)
        for (std::int32_t v = 0; v <= n; ++v)
            c.surface.vertices.push_back(
                {double(u) / n, double(v) / n, 0.5 + 0.1 * std::sin(9.0 * u / n) * std::cos(7.0 * v / n)});
    for (std::int32_t u = 0; u < n; ++u)
        for (std::int32_t v = 0; v < n; ++v) {
            const std::int32_t a = u * (n + 1) + v;
            c.surface.triangles.push_back({a, a + 1, a + n + 1});
            c.surface.triangles.push_back({a + 1, a + n + 2, a + n + 1});
        }
    const auto twin = brute_force(c);
    set_threads(1);
    EXPECT_EQ(triangles_met(c.elements, c.i, c.j, c.surface), twin);
    set_threads(3);
    EXPECT_EQ(triangles_met(c.elements, c.i, c.j, c.surface), twin);
    set_threads(0);

    // A watertight sheet between two elements cuts them exactly when they lie on different sides of it.
    for (std::size_t s = 0; s < twin.size(); ++s) {
        const auto side = [&](std::int32_t e) {
            const Vec3 p = c.elements.centre(e);
            return p.z > 0.5 + 0.1 * std::sin(9.0 * p.x) * std::cos(7.0 * p.y);
        };
        const auto far = [&](std::int32_t e) {
            const Vec3 p = c.elements.centre(e);
            return std::abs(p.z - 0.5 - 0.1 * std::sin(9.0 * p.x) * std::cos(7.0 * p.y)) > 0.002;
        };
        if (far(c.i[s]) && far(c.j[s]) && twin[s] < 2) {
            EXPECT_EQ(twin[s] == 1, side(c.i[s]) != side(c.j[s])) << s;
        }
    }
}

TEST(CutBonds, AreNoneWithoutATriangle)
{
    Case c = random_case(4);
    c.surface.triangles.clear();
    EXPECT_EQ(std::ranges::count(triangles_met(c.elements, c.i, c.j, c.surface), 0), std::ssize(c.i));
    EXPECT_TRUE(triangles_met(c.elements, {}, {}, random_case(5).surface).empty());
}

TEST(CrackVoxelRuns, CountTheCracksBetweenTwoElements)
{
    Mask crack(Shape{20, 5, 5});
    for (std::int64_t y = 0; y < 5; ++y)
        for (std::int64_t z = 0; z < 5; ++z) {
            crack.set(6, y, z, true);
            crack.set(7, y, z, true);
            crack.set(12, y, z, true);
        }
    constexpr double h = 2e-8;
    const Elements e{{h, 10 * h, 19 * h, 19.5 * h}, {h, 2 * h, 3.5 * h, h}, {h, h, 2.5 * h, 4 * h}, {h, h, h, h}};
    const std::vector<std::int32_t> i{0, 0, 1, 2}, j{1, 2, 2, 3};
    EXPECT_EQ(crack_voxel_runs_met(e, i, j, crack, h), (std::vector<std::uint8_t>{1, 2, 1, 0}));
}

}  // namespace
}  // namespace craze::domain
