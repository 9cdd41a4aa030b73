#include "craze/microstructure/distance.hpp"

#include "craze/core/parallel.hpp"
#include "craze/microstructure/morphology.hpp"
#include "support/random_masks.hpp"

#include <gtest/gtest.h>

namespace craze::microstructure {
namespace {

std::int32_t twin(const Mask& set, std::int64_t x, std::int64_t y, std::int64_t z)
{
    const Shape& s = set.shape();
    std::int64_t least = no_distance;
    for (std::int64_t k = 0; k < s.nz; ++k)
        for (std::int64_t j = 0; j < s.ny; ++j)
            for (std::int64_t i = 0; i < s.nx; ++i)
                if (set(i, j, k)) least = std::min(least, (i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z));
    return static_cast<std::int32_t>(least);
}

void expect_twin(const Mask& set)
{
    const Shape& s = set.shape();
    for (const int threads : {1, 2}) {
        set_threads(threads);
        const auto squared = squared_distance(set);
        for (std::int64_t z = 0; z < s.nz; ++z)
            for (std::int64_t y = 0; y < s.ny; ++y)
                for (std::int64_t x = 0; x < s.nx; ++x)
                    ASSERT_EQ(squared(x, y, z), twin(set, x, y, z)) << x << ' ' << y << ' ' << z;
    }
    set_threads(0);
}

TEST(SquaredDistance, IsTheNearestOfAllMembersOnAnyThreads)
{
    std::uint64_t seed = 0;
    for (const Shape shape : {Shape{19, 14, 12}, Shape{64, 7, 5}, Shape{33, 1, 20}, Shape{70, 9, 1}, Shape{1, 1, 9}})
        for (const double share : {0.9, 0.3, 0.02, 0.003}) expect_twin(support::random_mask(shape, share, ++seed));
}

// Beyond the rows that are searched one by one.
TEST(SquaredDistance, IsExactFarAway)
{
    std::uint64_t seed = 20;
    for (const Shape shape : {Shape{9, 90, 2}, Shape{3, 2, 100}, Shape{2, 45, 45}})
        for (int members = 1; members <= 4; ++members) {
            Mask set(shape);
            Random random(++seed);
            for (int m = 0; m < members; ++m)
                set.set(random.below(shape.nx), random.below(shape.ny), random.below(shape.nz), true);
            expect_twin(set);
        }
}

TEST(SquaredDistance, ToNothingIsNoDistance)
{
    const auto squared = squared_distance(Mask({70, 40, 50}));
    for (const auto d : squared.values()) ASSERT_EQ(d, no_distance);
}

TEST(SquaredDistance, UpToABallIsItsDilation)
{
    const Mask set = support::random_balls({90, 70, 50}, 6, 4.0, 2);
    const auto squared = squared_distance(set);
    const Mask grown = dilated(set, Ball(8.5));
    for (std::int64_t z = 0; z < 50; ++z)
        for (std::int64_t y = 0; y < 70; ++y)
            for (std::int64_t x = 0; x < 90; ++x) ASSERT_EQ(grown(x, y, z), squared(x, y, z) <= 72);
}

}  // namespace
}  // namespace craze::microstructure
