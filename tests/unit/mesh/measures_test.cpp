#include "craze/mesh/measures.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/mesh/pictures.hpp"
#include "support/masks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace craze::mesh {
namespace {

using std::numbers::pi;

constexpr double h = 0.5e-6;

struct Disc {
    Vec3 centre, normal;  // px
    double radius, thickness;
    bool holds(const Vec3& p) const
    {
        const double along = dot(p - centre, normal);
        return std::abs(along) < 0.5 * thickness && norm(p - centre - along * normal) < radius;
    }
};

Mask mask_of_discs(Shape shape, const std::vector<Disc>& discs)
{
    return support::mask_of(shape, [&](auto x, auto y, auto z) {
        const Vec3 p{static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, static_cast<double>(z) + 0.5};
        return std::ranges::any_of(discs, [&](const Disc& d) { return d.holds(p); });
    });
}

CrackMeasures measured(const Mask& mask, const Settings& settings)
{
    return measure(mesh_cracks(mask, h, settings), mask, h);
}

class Measures : public testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    void TearDown() override { set_threads(0); }
};

TEST_F(Measures, OfTiltedDiscsAreTheirNormalAreaOpeningAndRadius)
{
    Settings settings;
    settings.skeleton = SkeletonKind::medial_surface;
    for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0.2, 1, 0.1}, Vec3{1, 0.15, 0.4},
                                  Vec3{0.7, -0.6, 0.5}, Vec3{0.12, 0.05, 1}, Vec3{-0.5, 0.1, 1}}) {
        const Disc disc{{30.3, 29.8, 30.1}, normalized(direction), 22.0, 4.0};
        const Mask mask = mask_of_discs(Shape{60, 60, 60}, {disc});
        const CrackMeasures m = measured(mask, settings);
        const std::string what = "normal " + std::to_string(disc.normal.x) + " " + std::to_string(disc.normal.y);
        ASSERT_GE(m.cracks.size(), 1U) << what;
        EXPECT_GT(m.largest_share, 0.99) << what;
        const SingleCrack& c = m.cracks[0];
        EXPECT_GT(std::abs(dot(c.normal, disc.normal)), std::cos(1.5 * pi / 180.0)) << what;
        EXPECT_GT(c.flatness, 0.98) << what;
        // Rims recede by half the thickness, 2 px, and 0.5 to 1.8 voxels more, as the direction lies on the lattice.
        constexpr double radius = 22.0 - 2.0 - 1.15, slack = 0.75;
        EXPECT_NEAR(c.radius / h, radius, slack) << what;
        EXPECT_NEAR(c.area / (h * h), pi * radius * radius, 2.05 * pi * radius * slack) << what;
        EXPECT_NEAR(c.opening / h, 4.0, 0.3) << what;
        EXPECT_NEAR(norm(c.centre / h - disc.centre), 0.0, 1.0) << what;
        EXPECT_NEAR(m.crack_density * std::pow(60.0, 3), std::pow(radius, 3), 3.1 * radius * radius * slack) << what;
        EXPECT_FALSE(c.at_border);
        EXPECT_TRUE(m.quality.clean());
    }
}

// A crack 4 px thick through a volume, `slope` to the slices about y.
Mask sloping(const Shape& shape, const Vec3& normal)
{
    return support::mask_of(shape, [&](auto x, auto, auto z) {
        const Vec3 p{static_cast<double>(x) - 0.5 * static_cast<double>(shape.nx - 1), 0.0,
                     static_cast<double>(z) - 0.5 * static_cast<double>(shape.nz - 1)};
        return std::abs(dot(p, normal)) < 2.0;
    });
}

TEST_F(Measures, OfAPlaneThroughTheVolumeAreItsSectionWhateverItsSlope)
{
    // 20 to 85 degrees to the slices, by the paper's way.
    for (const double slope : {20.0, 25.0, 31.0, 47.0, 60.0, 75.0, 85.0}) {
        const double a = slope * pi / 180.0;
        const Vec3 normal{-std::sin(a), 0.0, std::cos(a)};
        const Mask mask = sloping(Shape{64, 40, 64}, normal);
        const CrackMeasures m = measured(mask, {});
        ASSERT_EQ(m.cracks.size(), 1U) << slope;
        // Borders take the same rim from a section of any size: second differences are the interior alone. Where lines
        // end between pixels leaves one voxel in 96 open at each end.
        const auto area = [&](std::int64_t nx, std::int64_t ny) {
            return measured(sloping(Shape{nx, ny, nx}, normal), {}).area / (h * h);
        };
        const double interior = area(160, 40) - area(160, 24) - area(64, 40) + area(64, 24);
        const double section = 96.0 * 16.0 / std::max(std::sin(a), std::cos(a));
        EXPECT_NEAR(interior / section, 1.0, 0.02) << slope;
        EXPECT_GT(m.fabric[0] * normal.x * normal.x + m.fabric[2] * normal.z * normal.z +
                      2 * m.fabric[4] * normal.x * normal.z,
                  0.99)
            << slope;
        EXPECT_NEAR(m.openings.mean / h, 4.0, 0.2) << slope;
        EXPECT_TRUE(m.spans[1]) << slope;
        // On sections perpendicular to y its line runs at this slope.
        const std::size_t bin = static_cast<std::size_t>(slope / 5.0);
        double near =
            m.rose.share[1][bin] + m.rose.share[1][bin - 1] + m.rose.share[1][std::min<std::size_t>(bin + 1, 35)];
        EXPECT_GT(near, 0.8) << slope;
    }
}

TEST_F(Measures, RimsRecedeByTheSameWhateverTheRadius)
{
    // What thinning takes hangs on opening, direction and the lattice alone: a share of the radius that goes to
    // nothing.
    for (const auto kind : {SkeletonKind::medial_surface, SkeletonKind::per_slice})
        for (const Vec3& direction : {Vec3{0.2, 1, 0.1}, Vec3{0.7, -0.6, 0.5}})
            for (const double thickness : {2.0, 4.0}) {
                Settings settings;
                settings.skeleton = kind;
                const auto lost = [&](double radius) {
                    const CrackMeasures m =
                        measured(mask_of_discs(Shape{76, 76, 76},
                                               {{{38.3, 37.8, 38.1}, normalized(direction), radius, thickness}}),
                                 settings);
                    return m.cracks.empty() ? radius : radius - m.cracks[0].radius / h;
                };
                const double small = lost(14.0), large = lost(32.0);
                EXPECT_NEAR(small, large, 0.25) << thickness;
                EXPECT_GT(large, 0.0) << thickness;
                EXPECT_LT(large, 0.5 * thickness + 1.6) << thickness;
            }
}

TEST_F(Measures, OfAWallGapeItsThicknessInAnyUnit)
{
    Settings settings;
    settings.skeleton = SkeletonKind::medial_surface;
    for (const std::int64_t thickness : {1, 2, 3, 5}) {
        const Mask wall =
            support::mask_of(Shape{30, 24, 20}, [&](auto x, auto, auto) { return x >= 9 && x < 9 + thickness; });
        for (const double size : {23.6e-9, 35.4e-9, 0.1e-6, 1e-6, 1.0}) {
            const CrackMeasures m = measure(mesh_cracks(wall, size, settings), wall, size);
            for (const double q : m.openings.quantiles)
                EXPECT_DOUBLE_EQ(q / size, static_cast<double>(thickness)) << size;
            EXPECT_NEAR(m.openings.mean / size, static_cast<double>(thickness), 1e-9) << size;
            ASSERT_EQ(m.openings.share.size(), static_cast<std::size_t>(2 * thickness + 1)) << size;
            EXPECT_NEAR(m.openings.share.back(), 1.0, 1e-9) << size;
        }
    }
}

TEST_F(Measures, QuantilesOfOpeningsAreByArea)
{
    // Three walls right through, 1, 2 and 4 px thick, of 14, 30 and 56 % of the length.
    Settings settings;
    settings.skeleton = SkeletonKind::medial_surface;
    const Mask walls = support::mask_of(Shape{40, 20, 101}, [](auto x, auto, auto z) {
        return z < 15 ? x == 5 : z > 15 && z < 46 ? x == 15 || x == 16 : z > 46 && x >= 25 && x < 29;
    });
    const CrackMeasures m = measure(mesh_cracks(walls, h, settings), walls, h);
    ASSERT_EQ(m.cracks.size(), 3U);
    EXPECT_NEAR(m.openings.quantiles[0] / h, 1.0, 1e-12);
    EXPECT_NEAR(m.openings.quantiles[1] / h, 4.0, 1e-12);
    EXPECT_NEAR(m.openings.quantiles[2] / h, 4.0, 1e-12);
    EXPECT_NEAR(m.openings.share[4], 0.30, 0.03);
}

TEST_F(Measures, DensityTensorOfAFlatCrackLiesOnItsNormalAndOfCrossedDiscsIsSplitByTheirAreas)
{
    Settings settings;
    settings.skeleton = SkeletonKind::medial_surface;
    const Shape shape{60, 60, 60};
    for (const Vec3& direction : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{0.3, -0.5, 0.7}}) {
        const Vec3 n = normalized(direction);
        const CrackMeasures m = measured(mask_of_discs(shape, {{{30.3, 29.8, 30.1}, n, 22, 4}}), settings);
        const Tensor flat{n.x * n.x, n.y * n.y, n.z * n.z, n.y * n.z, n.x * n.z, n.x * n.y};
        for (std::size_t k = 0; k < 6; ++k)
            EXPECT_NEAR(m.density_tensor[k] / m.crack_density, flat[k], 0.02) << direction.z << " component " << k;
    }
    for (const double second : {24.0, 16.0}) {
        const CrackMeasures m = measured(
            mask_of_discs(shape, {{{30, 30, 30}, {1, 0, 0}, 24, 3}, {{30, 30, 30}, {0, 1, 0}, second, 3}}), settings);
        ASSERT_GT(m.largest_share, 0.99);
        // Rims recede by half the thickness and half a voxel. Along the crossing a strip a few voxels wide faces
        // between.
        const double one = std::pow(24.0 - 2.0, 2), two = std::pow(second - 2.0, 2);
        const Tensor split{one / (one + two), two / (one + two), 0, 0, 0, 0};
        for (std::size_t k = 0; k < 6; ++k)
            EXPECT_NEAR(m.density_tensor[k] / m.crack_density, split[k], 0.03) << second << " component " << k;
    }
}

TEST_F(Measures, TellSingleCracksApartAndSortThem)
{
    const Mask mask = mask_of_discs(
        Shape{80, 50, 50},
        {{{15, 25, 25}, {1, 0, 0}, 10, 3}, {{40, 25, 25}, {1, 0, 0}, 18, 3}, {{65, 25, 25}, {1, 0, 0}, 14, 3}});
    const CrackSurface surface = mesh_cracks(mask, h, {});
    const CrackMeasures m = measure(surface, mask, h);
    ASSERT_EQ(m.cracks.size(), 3U);
    EXPECT_NEAR(m.cracks[0].centre.x / h, 40.0, 1.0);
    EXPECT_NEAR(m.cracks[1].centre.x / h, 65.0, 1.0);
    EXPECT_NEAR(m.cracks[2].centre.x / h, 15.0, 1.0);
    double sum = 0.0, total = 0.0, trace = 0.0;
    for (const SingleCrack& c : m.cracks) sum += std::pow(c.radius, 3) / m.volume, total += c.area;
    for (std::size_t k = 0; k < 3; ++k) trace += m.density_tensor[k];
    EXPECT_NEAR(m.crack_density, sum, 1e-12);
    EXPECT_NEAR(trace, sum, 1e-12);
    EXPECT_NEAR(total, m.area, 1e-9 * m.area);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const double x = surface.vertices[static_cast<std::size_t>(surface.triangles[t][0])].x / h;
        EXPECT_EQ(m.crack_of[t], x < 25 ? 2 : x < 55 ? 0 : 1);
    }
}

TEST_F(Measures, OfASphereShellFaceEverywhereAlike)
{
    const Mask shell = support::mask_of(Shape{80, 80, 80}, [](auto x, auto y, auto z) {
        const double r =
            norm(Vec3{static_cast<double>(x) - 39.5, static_cast<double>(y) - 39.5, static_cast<double>(z) - 39.5});
        return std::abs(r - 34.0) < 1.6;
    });
    Settings settings;
    settings.skeleton = SkeletonKind::medial_surface;
    const CrackMeasures m = measured(shell, settings);
    EXPECT_NEAR(m.area / (h * h) / (4.0 * pi * 34.0 * 34.0), 1.0, 0.03);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(m.fabric[k], 1.0 / 3.0, 0.01);
    for (std::size_t k = 3; k < 6; ++k) EXPECT_NEAR(m.fabric[k], 0.0, 0.01);
    double sum = 0.0;
    for (int quarter = 0; quarter < 4; ++quarter)
        for (int ring = 0; ring < PoleFigure::rings; ring += 6) {
            double part = 0.0;
            for (int r = ring; r < ring + 6; ++r)
                for (int s = 18 * quarter; s < 18 * (quarter + 1); ++s)
                    part += m.poles.share[static_cast<std::size_t>(s + PoleFigure::sectors * r)];
            EXPECT_NEAR(part * 12.0, 1.0, 0.1);
            sum += part;
        }
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_NEAR(m.openings.mean / h, 3.2, 0.25);
}

TEST_F(Measures, AreTheSameOnAnyNumberOfThreads)
{
    const Mask mask = mask_of_discs(Shape{60, 50, 40}, {{{20, 25, 20}, normalized({1, 1, 1}), 16, 3},
                                                        {{40, 25, 20}, normalized({1, -2, 1}), 15, 4}});
    set_threads(1);
    const CrackMeasures one = measured(mask, {});
    set_threads(2);
    const CrackMeasures two = measured(mask, {});
    EXPECT_EQ(one.area, two.area);
    EXPECT_EQ(one.crack_density, two.crack_density);
    EXPECT_EQ(one.poles.share, two.poles.share);
    EXPECT_EQ(one.opening_of, two.opening_of);
    EXPECT_EQ(one.crack_of, two.crack_of);
    EXPECT_EQ(one.quality.edges, two.quality.edges);
}

TEST_F(Measures, ReportAMeshThatIsNotClean)
{
    CrackSurface s;
    s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {5, 5, 5}, {2, 0, 0}, {2, 1, 0}};
    s.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 4, 1}, {2, 0, 1}, {0, 1, 1}, {1, 6, 7}};
    const MeshQuality q = quality(s, Incidence(s));
    EXPECT_EQ(q.duplicate_triangles, 1);
    EXPECT_EQ(q.degenerate_triangles, 1);
    EXPECT_EQ(q.unused_vertices, 1);
    EXPECT_FALSE(q.clean());

    s.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 4, 1}, {1, 6, 7}};
    s.vertices.erase(s.vertices.begin() + 5);
    for (auto& t : s.triangles)
        for (auto& v : t) v -= v > 5 ? 1 : 0;
    const MeshQuality three = quality(s, Incidence(s));  // three on an edge, and one that hangs on a corner
    EXPECT_TRUE(three.clean());
    EXPECT_FALSE(three.manifold());
    EXPECT_EQ(three.edges, 10);
    EXPECT_EQ(three.branching_edges, 1);
    EXPECT_EQ(three.rim_edges, 9);
    EXPECT_EQ(three.branching_vertices, 2);
    EXPECT_EQ(three.euler_number, 7 - 10 + 4);
}

TEST_F(Measures, PictureOfThePolesPutsXToTheRightAndYUp)
{
    PoleFigure poles;
    poles.share[static_cast<std::size_t>(0 + PoleFigure::sectors * (PoleFigure::rings - 1))] = 1.0;  // near +x
    const io::Picture right = pole_figure_picture(poles);
    EXPECT_LT(right.at(256 + 235, 256 - 3)[1], 100);
    EXPECT_GT(right.at(256, 256)[1], 250);
    poles.share = {};
    poles.share[static_cast<std::size_t>(18 + PoleFigure::sectors * (PoleFigure::rings - 1))] = 1.0;  // near +y
    EXPECT_LT(pole_figure_picture(poles).at(256 - 3, 256 - 235)[1], 100);
}

}  // namespace
}  // namespace craze::mesh
