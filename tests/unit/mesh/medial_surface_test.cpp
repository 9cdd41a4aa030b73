#include "craze/mesh/medial_surface.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/vec3.hpp"
#include "craze/mesh/neighbours.hpp"
#include "support/masks.hpp"
#include "support/topology.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::mesh {
namespace {

using support::components;
using support::euler_number;
using support::mask_of;
using support::random_mask;

void expect_same_topology(const Mask& before, const Mask& after)
{
    EXPECT_EQ(difference(after, before).count(), 0);
    EXPECT_EQ(components(after, true), components(before, true));
    EXPECT_EQ(components(after, false), components(before, false));
    EXPECT_EQ(euler_number(after), euler_number(before));
}

class MedialSurface : public testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    void TearDown() override { set_threads(0); }
};

TEST_F(MedialSurface, KeepsTheTopologyOfNoise)
{
    for (const double share : {0.15, 0.4, 0.6, 0.8, 0.95}) {
        const Mask noise = random_mask(Shape{23, 19, 17}, share, 3);
        expect_same_topology(noise, medial_surface(noise));
    }
    const Mask wide = random_mask(Shape{140, 9, 8}, 0.7, 9);
    expect_same_topology(wide, medial_surface(wide));
}

TEST_F(MedialSurface, SimpleIsThatRemovalKeepsPartsAndEulerNumber)
{
    Random random(7);
    for (int trial = 0; trial < 3000; ++trial) {
        const double share = random.uniform();
        Cube bits = 0;
        for (unsigned k = 0; k < 27; ++k) bits |= static_cast<Cube>(random.uniform() < share) << k;
        bits |= cube::middle;
        Mask m =
            mask_of(Shape{3, 3, 3}, [&](auto x, auto y, auto z) { return (bits >> (x + 3 * y + 9 * z) & 1U) != 0; });
        // Twin: a voxel is simple when neither the parts of the set nor the Euler number nor the parts of the rest
        // within a wide surrounding change.
        const int set = components(m, true), rest = components(m, false);
        const std::int64_t euler = euler_number(m);
        m.set(1, 1, 1, false);
        const bool same = components(m, true) == set && components(m, false) == rest && euler_number(m) == euler;
        EXPECT_EQ(cube::simple(bits), same) << bits;
    }
}

TEST_F(MedialSurface, OfAPlateIsItsMiddleWhateverItsAxis)
{
    for (int axis = 0; axis < 3; ++axis)
        for (const std::int64_t thick : {1, 2, 3, 6, 7}) {
            const Mask plate = mask_of(Shape{30, 30, 30}, [&](auto x, auto y, auto z) {
                const std::int64_t p[] = {x, y, z};
                const std::int64_t u = p[(axis + 1) % 3], v = p[(axis + 2) % 3];
                return p[axis] >= 10 && p[axis] < 10 + thick && u >= 3 && u < 27 && v >= 3 && v < 27;
            });
            const Mask sheet = medial_surface(plate);
            const std::int64_t rim = thick / 2 + 1;
            std::int64_t off = 0;
            for (std::int64_t u = 3; u < 27; ++u)
                for (std::int64_t v = 3; v < 27; ++v) {
                    std::int64_t found = 0;
                    for (std::int64_t d = 0; d < 30; ++d) {
                        std::int64_t p[3];
                        p[axis] = d, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
                        if (!sheet(p[0], p[1], p[2])) continue;
                        ++found;
                        off = std::max<std::int64_t>(off, std::abs(2 * d - (20 + thick - 1)));
                    }
                    if (u >= 3 + rim && u < 27 - rim && v >= 3 + rim && v < 27 - rim) {
                        EXPECT_EQ(found, 1) << u << ' ' << v;
                    }
                }
            EXPECT_LE(off, 1) << "half voxels from the middle, axis " << axis << ", thickness " << thick;
        }
}

TEST_F(MedialSurface, OfATiltedPlateIsAThinSheetNearItsMiddle)
{
    const Vec3 normal = normalized({0.3, -0.5, 0.81}), centre{20, 20, 20};
    const auto depth = [&](auto x, auto y, auto z) {
        return dot(Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} - centre, normal);
    };
    const Mask plate =
        mask_of(Shape{41, 41, 41}, [&](auto x, auto y, auto z) { return std::abs(depth(x, y, z)) < 2.2; });
    const Mask sheet = medial_surface(plate);
    expect_same_topology(plate, sheet);
    for (std::int64_t y = 4; y < 37; ++y)
        for (std::int64_t x = 4; x < 37; ++x) {
            int found = 0;
            for (std::int64_t z = 0; z < 41; ++z)
                if (sheet(x, y, z)) {
                    ++found;
                    EXPECT_LT(std::abs(depth(x, y, z)), 1.6);
                }
            // A column may be crossed between two voxels that share an edge, never left out twice running.
            EXPECT_LE(found, 2);
        }
}

TEST_F(MedialSurface, OfASphereShellIsAClosedShell)
{
    const Mask shell = mask_of(Shape{33, 33, 33}, [&](auto x, auto y, auto z) {
        const double r =
            norm(Vec3{static_cast<double>(x) - 16, static_cast<double>(y) - 16, static_cast<double>(z) - 16});
        return r > 10.0 && r < 13.5;
    });
    const Mask thin = medial_surface(shell);
    expect_same_topology(shell, thin);
    EXPECT_EQ(components(thin, false), 2);
    EXPECT_LT(static_cast<double>(thin.count()), 1.7 * 4.0 * 3.14 * 11.75 * 11.75);
    EXPECT_GT(static_cast<double>(thin.count()), 0.8 * 4.0 * 3.14 * 11.75 * 11.75);
}

TEST_F(MedialSurface, IsTheSameOnAnyNumberOfThreads)
{
    const Mask noise = random_mask(Shape{150, 90, 75}, 0.3, 12);  // large enough to be shared out
    set_threads(1);
    const Mask one = medial_surface(noise);
    set_threads(2);
    EXPECT_EQ(one, medial_surface(noise));
}

}  // namespace
}  // namespace craze::mesh
