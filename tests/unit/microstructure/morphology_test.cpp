#include "craze/microstructure/morphology.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "support/random_masks.hpp"

#include <gtest/gtest.h>

namespace craze::microstructure {
namespace {

bool reaches(const Mask& a, std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t squared, bool value)
{
    const Shape& s = a.shape();
    for (std::int64_t k = 0; k < s.nz; ++k)
        for (std::int64_t j = 0; j < s.ny; ++j)
            for (std::int64_t i = 0; i < s.nx; ++i)
                if (a(i, j, k) == value && (i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z) <= squared)
                    return true;
    return false;
}

// The definitions of dilation (value true) and erosion (value false), voxel against voxel.
Mask twin(const Mask& a, std::int64_t squared, bool value)
{
    const Shape& s = a.shape();
    Mask out(s);
    for (std::int64_t z = 0; z < s.nz; ++z)
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x) out.set(x, y, z, reaches(a, x, y, z, squared, value) == value);
    return out;
}

TEST(Ball, OfHalfIntegerRadiusHoldsSquaresUpToTheFloor)
{
    EXPECT_EQ(Ball(8.5).squared, 72);
    EXPECT_EQ(Ball(4.5).squared, 20);
    EXPECT_EQ(Ball(1.5).squared, 2);
    EXPECT_EQ(Ball(0.0).squared, 0);
    EXPECT_THROW(Ball(-1.0), InvalidInput);
    EXPECT_THROW(Ball(std::nan("")), InvalidInput);
}

TEST(Morphology, IsItsDefinitionOnRandomVolumesOnAnyThreads)
{
    const struct {
        Shape shape;
        double share, radius;
    } cases[] = {{{13, 11, 9}, 0.02, 2.5}, {{70, 6, 5}, 0.01, 4.5},   {{64, 5, 7}, 0.01, 1.5},
                 {{1, 9, 12}, 0.05, 3.0},  {{129, 3, 2}, 0.004, 8.5}, {{20, 18, 16}, 0.001, 6.5},
                 {{7, 70, 3}, 0.01, 20.5}, {{5, 5, 5}, 0.3, 0.0}};
    std::uint64_t seed = 0;
    for (const auto& c : cases) {
        const Mask sparse = support::random_mask(c.shape, c.share, ++seed);
        const Mask dense = complement(sparse);
        const Ball ball(c.radius);
        for (const int threads : {1, 2}) {
            set_threads(threads);
            EXPECT_EQ(dilated(sparse, ball), twin(sparse, ball.squared, true)) << c.radius;
            EXPECT_EQ(eroded(dense, ball), twin(dense, ball.squared, false)) << c.radius;
            EXPECT_EQ(closed(sparse, ball), twin(twin(sparse, ball.squared, true), ball.squared, false)) << c.radius;
        }
    }
    set_threads(0);
}

TEST(Closing, KeepsItsSetAndRepeatedChangesNothing)
{
    const Mask matter = complement(support::random_balls({60, 50, 40}, 40, 7.0, 3));
    const Mask once = closed(matter, Ball(4.5));
    EXPECT_EQ(difference(matter, once).count(), 0);
    EXPECT_EQ(closed(once, Ball(4.5)), once);
    EXPECT_GT(once.count(), matter.count());
}

TEST(Dilation, OfOneVoxelIsTheBall)
{
    Mask point({41, 41, 41});
    point.set(20, 20, 20, true);
    std::int64_t inside = 0;
    for (int k = -20; k <= 20; ++k)
        for (int j = -20; j <= 20; ++j)
            for (int i = -20; i <= 20; ++i) inside += i * i + j * j + k * k <= 72 ? 1 : 0;
    EXPECT_EQ(dilated(point, Ball(8.5)).count(), inside);
}

}  // namespace
}  // namespace craze::microstructure
