#include "craze/microstructure/thickness.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/microstructure/distance.hpp"
#include "support/random_masks.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::microstructure {
namespace {

// For each voxel, over all voxels of the set: does their largest lattice ball cover it?
TEST(LocalThickness, IsTheLargestCoveringBallOnRandomVolumesOnAnyThreads)
{
    const Shape s{30, 16, 14};
    const Mask set = support::random_balls(s, 9, 5.0, 9);
    const auto squared = squared_distance(complement(set));
    for (const double step : {0.25, 1.0}) {
        const Thickness t = local_thickness(squared, step);
        std::vector<std::int64_t> least;  // squared distance from which a level holds
        for (const double d : t.diameter) least.push_back(std::llround((d + 1) * (d + 1) / 4));
        least[0] = 0;
        Volume<std::uint8_t> twin(s, 0);
        for (std::int64_t z = 0; z < s.nz; ++z)
            for (std::int64_t y = 0; y < s.ny; ++y)
                for (std::int64_t x = 0; x < s.nx; ++x)
                    for (std::size_t level = 1; level < least.size() && least[level] <= squared(x, y, z); ++level)
                        for (std::int64_t k = 0; k < s.nz; ++k)
                            for (std::int64_t j = 0; j < s.ny; ++j)
                                for (std::int64_t i = 0; i < s.nx; ++i)
                                    if ((i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z) < least[level])
                                        twin(i, j, k) = std::max(twin(i, j, k), static_cast<std::uint8_t>(level));
        EXPECT_TRUE(std::equal(t.level.values().begin(), t.level.values().end(), twin.values().begin())) << step;
        set_threads(1);
        const Thickness one = local_thickness(squared, step);
        EXPECT_TRUE(std::equal(t.level.values().begin(), t.level.values().end(), one.level.values().begin()));
        set_threads(0);
    }
}

TEST(LocalThickness, OfAPlateIsItsThicknessOrOneVoxelLessWhereItIsEven)
{
    for (const int n : {1, 2, 3, 4, 5, 8, 9}) {
        Mask plate({30, 30, 30});
        for (int z = 0; z < 30; ++z)
            for (int y = 0; y < 30; ++y)
                for (int x = 12; x < 12 + n; ++x) plate.set(x, y, z, true);
        const Thickness t = local_thickness(squared_distance(complement(plate)), 0.5);
        const auto count = thickness_histogram(t, plate);
        for (const double q : {0.01, 0.5, 1.0}) EXPECT_DOUBLE_EQ(thickness_quantile(t, count, q), n - (n + 1) % 2);
    }
}

TEST(MeanThickness, IsThatOfTheVoxelsOfEachObject)
{
    const Mask set = support::random_balls({40, 30, 24}, 9, 5.0, 3);
    const Thickness t = local_thickness(squared_distance(complement(set)), 0.5);
    const Components each = components(set);
    const auto label = painted(each);
    std::vector<double> sum(static_cast<std::size_t>(each.count), 0.0);
    for (std::int64_t z = 0; z < 24; ++z)
        for (std::int64_t y = 0; y < 30; ++y)
            for (std::int64_t x = 0; x < 40; ++x)
                if (set(x, y, z)) sum[static_cast<std::size_t>(label(x, y, z) - 1)] += t.diameter[t.level(x, y, z)];
    const auto mean = mean_thickness(t, each);
    const auto voxels = volumes(each);
    ASSERT_GT(mean.size(), 1U);
    ASSERT_EQ(mean.size(), sum.size());
    for (std::size_t k = 0; k < sum.size(); ++k) EXPECT_NEAR(mean[k], sum[k] / static_cast<double>(voxels[k]), 1e-9);
}

TEST(LocalThickness, RefusesASetWithoutBoundAndASillyStep)
{
    EXPECT_THROW(local_thickness(squared_distance(Mask({9, 9, 9})), 0.5), InvalidInput);
    EXPECT_THROW(local_thickness(squared_distance(complement(Mask({9, 9, 9}))), 0.0), InvalidInput);
    const Thickness none = local_thickness(squared_distance(complement(Mask({9, 9, 9}))), 0.5);
    EXPECT_EQ(none.diameter, std::vector<double>{0.0});
}

}  // namespace
}  // namespace craze::microstructure
