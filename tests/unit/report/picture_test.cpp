#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"
#include "craze/report/decimate.hpp"
#include "craze/report/render.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>

namespace craze::report {
namespace {

/// A flat sheet z = 3 of n x n squares of edge 1, two triangles each.
mesh::CrackSurface sheet(std::int32_t n)
{
    mesh::CrackSurface s;
    for (std::int32_t y = 0; y <= n; ++y)
        for (std::int32_t x = 0; x <= n; ++x)
            s.vertices.push_back({static_cast<double>(x), static_cast<double>(y), 3.0});
    for (std::int32_t y = 0; y < n; ++y)
        for (std::int32_t x = 0; x < n; ++x) {
            const std::int32_t a = x + (n + 1) * y, b = a + n + 1;
            s.triangles.push_back({a, a + 1, b});
            s.triangles.push_back({a + 1, b + 1, b});
        }
    return s;
}

double area(const mesh::CrackSurface& s)
{
    double sum = 0.0;
    for (const auto& t : s.triangles) {
        const auto at = [&](std::size_t k) { return s.vertices[static_cast<std::size_t>(t[k])]; };
        sum += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
    }
    return sum;
}

TEST(Decimated, FlatSheetStaysFlatAndKeepsItsAreaButForAnEdge)
{
    const auto fine = sheet(100);
    const auto coarse = decimated(fine, 2000);
    EXPECT_LE(coarse.triangles.size(), 2000U);
    EXPECT_GE(coarse.triangles.size(), 1200U) << "most of what is allowed is used";
    for (const auto& v : coarse.vertices) EXPECT_DOUBLE_EQ(v.z, 3.0);
    EXPECT_NEAR(area(coarse), area(fine), 0.08 * area(fine));
}

TEST(Decimated, HasNoFlatOrRepeatedTriangleAndNoUnusedVertex)
{
    auto s = sheet(40);
    Random random(5);
    for (auto& v : s.vertices) v += Vec3{0.3 * random.normal(), 0.3 * random.normal(), 2.0 * random.normal()};
    const auto coarse = decimated(s, 900);
    ASSERT_LE(coarse.triangles.size(), 900U);
    ASSERT_GT(coarse.triangles.size(), 300U);
    std::set<std::set<std::int32_t>> seen;
    std::set<std::int32_t> used;
    for (const auto& t : coarse.triangles) {
        const std::set<std::int32_t> corners(t.begin(), t.end());
        EXPECT_EQ(corners.size(), 3U);
        EXPECT_TRUE(seen.insert(corners).second);
        used.insert(t.begin(), t.end());
    }
    EXPECT_EQ(used.size(), coarse.vertices.size());
    EXPECT_LT(*used.rbegin(), static_cast<std::int32_t>(coarse.vertices.size()));
}

TEST(Decimated, SmallSurfaceIsItselfWithoutUnusedVertices)
{
    auto s = sheet(3);
    s.vertices.push_back({9, 9, 9});
    const auto same = decimated(s, 18);
    EXPECT_EQ(same.triangles.size(), 18U);
    EXPECT_EQ(same.vertices.size(), 16U);
    EXPECT_DOUBLE_EQ(area(same), 9.0);
    EXPECT_TRUE(decimated({}, 10).triangles.empty());
}

Scene one_ball(double radius)
{
    Scene scene;
    scene.box = {10, 10, 10};
    scene.spheres.push_back({{5, 5, 5}, radius, {0, 114, 178}});
    return scene;
}

/// Share of pixels that are bluer than red: those of the ball.
double blue_share(const io::Picture& p)
{
    std::int64_t blue = 0;
    for (std::int64_t y = 0; y < p.height; ++y)
        for (std::int64_t x = 0; x < p.width; ++x) blue += p.at(x, y)[2] > p.at(x, y)[0] + 20;
    return static_cast<double>(blue) / static_cast<double>(p.width * p.height);
}

TEST(Render, BallCoversTheDiscItShould)
{
    // Looking along x the box is a square of 10 that fills 92 % of the height.
    const View view{300, 300, 0.0, 0.0};
    const double across = 0.92 * 300.0 / 10.0;
    EXPECT_NEAR(blue_share(render(one_ball(4.0), view)), M_PI * 16.0 * across * across / 90000.0, 0.01);
}

TEST(Render, WhatIsNearHidesWhatIsBehind)
{
    const View along_x{200, 200, 0.0, 0.0};
    for (const bool red_in_front : {true, false}) {
        auto scene = one_ball(2.0);
        scene.spheres.push_back({{red_in_front ? 9.0 : 1.0, 5, 5}, 2.0, {255, 0, 0}});
        const auto p = render(scene, along_x);
        EXPECT_EQ(p.at(100, 100)[0] > p.at(100, 100)[2], red_in_front) << "the viewer stands at large x";
    }
}

TEST(Render, SheetIsSeenFromBothSides)
{
    Scene scene;
    scene.box = {10, 10, 10};
    scene.vertices = {{5, 0, 0}, {5, 10, 0}, {5, 10, 10}, {5, 0, 10}};
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (const double azimuth : {0.0, 180.0}) {
        const auto p = render(scene, {100, 100, azimuth, 0.0});
        EXPECT_GT(p.at(50, 50)[0], 100);
        EXPECT_LT(p.at(50, 50)[2], 30);
    }
}

TEST(Render, IsTheSameOnAnyNumberOfThreads)
{
    auto scene = one_ball(1.0);
    Random random(3);
    for (int k = 0; k < 500; ++k)
        scene.spheres.push_back(
            {{random.uniform(0, 10), random.uniform(0, 10), random.uniform(0, 10)}, 0.4, viridis(random.uniform())});
    for (int k = 0; k < 200; ++k)
        scene.sticks.push_back({scene.spheres[static_cast<std::size_t>(k)].centre,
                                scene.spheres[static_cast<std::size_t>(k + 1)].centre,
                                0.05,
                                {0, 0, 0}});
    const auto s = sheet(10);
    scene.vertices = s.vertices, scene.triangles = s.triangles;
    set_threads(1);
    const auto one = render(scene, {160, 120});
    set_threads(2);
    EXPECT_EQ(render(scene, {160, 120}).pixels, one.pixels);
    set_threads(0);
    if (const char* folder = std::getenv("CRAZE_SHOW"))
        io::write_png(std::string(folder) + "/render.png", render(scene));
}

TEST(Viridis, GoesFromItsFirstToItsLastColour)
{
    EXPECT_EQ(viridis(-1.0), (Colour{68, 1, 84}));
    EXPECT_EQ(viridis(2.0), (Colour{253, 231, 37}));
    EXPECT_EQ(colour_of("#0072b2"), (Colour{0, 114, 178}));
}

}  // namespace
}  // namespace craze::report
