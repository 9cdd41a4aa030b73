#include "craze/mesh/skeleton.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "support/masks.hpp"
#include "support/topology.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::mesh {
namespace {

using support::components_of_slice;
using support::drawing;
using support::mask_of;
using support::random_mask;

void expect_same_topology(const Mask& before, const Mask& after, const std::string& what)
{
    for (std::int64_t z = 0; z < before.shape().nz; ++z) {
        ASSERT_EQ(components_of_slice(after, z, true, true), components_of_slice(before, z, true, true))
            << what << ", slice " << z;
        ASSERT_EQ(components_of_slice(after, z, false, false), components_of_slice(before, z, false, false))
            << what << ", slice " << z;
    }
}

// Thick shapes joined by necks, with holes.
Mask blobs()
{
    return mask_of(Shape{130, 90, 8}, [](auto x, auto y, auto z) {
        return std::sin(0.21 * static_cast<double>(x + 3 * z)) + std::sin(0.17 * static_cast<double>(y - 2 * z)) +
                   0.4 * std::sin(0.9 * static_cast<double>(x - y)) >
               0.1;
    });
}

class Skeleton : public testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    void TearDown() override { set_threads(0); }
};

TEST_F(Skeleton, OfABarIsItsMiddleLine)
{
    const Mask bar = drawing({"............", ".##########.", ".##########.", ".##########.", "............"});
    const Mask line = skeleton_of_slices(bar, 2);
    for (std::int64_t x = 3; x < 9; ++x)
        for (std::int64_t y = 0; y < 5; ++y) EXPECT_EQ(line(x, y, 0), y == 2) << x << ' ' << y;
    EXPECT_LE(line.count(), 10);
}

TEST_F(Skeleton, KeepsWhatZhangAndSuensRuleLoses)
{
    EXPECT_EQ(components_of_slice(skeleton_of_slices(drawing({"....", ".##.", ".##.", "...."}), 2), 0, true, true), 1);
    const Mask band = drawing({"##......", ".##.....", "..##....", "...##...", "....##..", ".....##.", "......##"});
    const Mask thin = skeleton_of_slices(band, 2);
    EXPECT_EQ(components_of_slice(thin, 0, true, true), 1);
    EXPECT_GE(thin.count(), 6);
}

TEST_F(Skeleton, IsASubsetWithTheSameComponentsAndHolesInEverySlice)
{
    for (const double share : {0.3, 0.5, 0.65, 0.8, 0.93})
        for (const std::int64_t nx : {37, 64, 150}) {
            const Mask noise = random_mask(Shape{nx, 41, 6}, share, static_cast<std::uint64_t>(nx));
            const Mask thin = skeleton_of_slices(noise, 2);
            EXPECT_EQ(difference(thin, noise).count(), 0);
            expect_same_topology(noise, thin, "noise of " + std::to_string(share));
        }
    const Mask shapes = blobs();
    expect_same_topology(shapes, skeleton_of_slices(shapes, 2), "blobs");
}

TEST_F(Skeleton, IsOnePixelWide)
{
    const Mask shapes = blobs();
    const Mask thin = skeleton_of_slices(shapes, 2);
    std::int64_t squares = 0;
    for (std::int64_t z = 0; z < shapes.shape().nz; ++z)
        for (std::int64_t y = 0; y + 1 < shapes.shape().ny; ++y)
            for (std::int64_t x = 0; x + 1 < shapes.shape().nx; ++x)
                squares += thin(x, y, z) && thin(x + 1, y, z) && thin(x, y + 1, z) && thin(x + 1, y + 1, z);
    EXPECT_LE(squares, thin.count() / 200);  // crossings of four branches can need one
}

TEST_F(Skeleton, AlongAnotherAxisIsThatOfTheTurnedStack)
{
    const Shape s{30, 47, 23};
    const Mask noise = random_mask(s, 0.8, 11);
    const Mask along_x = skeleton_of_slices(noise, 0), along_y = skeleton_of_slices(noise, 1);
    const Mask turned_x = mask_of(Shape{s.ny, s.nz, s.nx}, [&](auto x, auto y, auto z) { return noise(z, x, y); });
    const Mask turned_y = mask_of(Shape{s.nx, s.nz, s.ny}, [&](auto x, auto y, auto z) { return noise(x, z, y); });
    const Mask thin_x = skeleton_of_slices(turned_x, 2), thin_y = skeleton_of_slices(turned_y, 2);
    EXPECT_EQ(along_x, mask_of(s, [&](auto x, auto y, auto z) { return thin_x(y, z, x); }));
    EXPECT_EQ(along_y, mask_of(s, [&](auto x, auto y, auto z) { return thin_y(x, z, y); }));
}

TEST_F(Skeleton, IsTheSameOnAnyNumberOfThreads)
{
    const Mask noise = random_mask(Shape{100, 60, 9}, 0.85, 3);
    set_threads(1);
    const Mask one = skeleton_of_slices(noise, 2);
    set_threads(2);
    EXPECT_EQ(one, skeleton_of_slices(noise, 2));
}

}  // namespace
}  // namespace craze::mesh
