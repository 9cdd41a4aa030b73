#include "craze/microstructure/microstructure.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/microstructure/porosity.hpp"
#include "support/random_masks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace craze::microstructure {
namespace {

// Fig. 6 voxel against voxel, by the paper's words: dilate and erode the white solid.
Classification twin(const Mask& matter, double R_C, double R_E, Border border)
{
    const Shape& s = matter.shape();
    const auto any = [&](std::int64_t x, std::int64_t y, std::int64_t z, double r,
                         const std::function<bool(std::int64_t, std::int64_t, std::int64_t, bool)>& is) {
        const auto reach = static_cast<std::int64_t>(r);
        for (std::int64_t k = -reach; k <= reach; ++k)
            for (std::int64_t j = -reach; j <= reach; ++j)
                for (std::int64_t i = -reach; i <= reach; ++i) {
                    if (static_cast<double>(i * i + j * j + k * k) > r * r) continue;
                    const bool inside =
                        x + i >= 0 && y + j >= 0 && z + k >= 0 && x + i < s.nx && y + j < s.ny && z + k < s.nz;
                    if (is(x + i, y + j, z + k, inside)) return true;
                }
        return false;
    };
    const auto each = [&](auto&& value) {
        Mask out(s);
        for (std::int64_t z = 0; z < s.nz; ++z)
            for (std::int64_t y = 0; y < s.ny; ++y)
                for (std::int64_t x = 0; x < s.nx; ++x) out.set(x, y, z, value(x, y, z));
        return out;
    };
    const Mask grown = each([&](auto x, auto y, auto z) {
        return any(x, y, z, R_C, [&](auto i, auto j, auto k, bool inside) {
            return inside ? matter(i, j, k) : border == Border::matter;
        });
    });
    Classification c;
    c.closed = each([&](auto x, auto y, auto z) {
        return any(x, y, z, R_C, [&](auto i, auto j, auto k, bool inside) { return inside && !grown(i, j, k); });
    });
    c.enlarged = each([&](auto x, auto y, auto z) {
        return any(x, y, z, R_E, [&](auto i, auto j, auto k, bool inside) { return inside && c.closed(i, j, k); });
    });
    c.pore = each([&](auto x, auto y, auto z) { return c.enlarged(x, y, z) && !matter(x, y, z); });
    c.crack = each([&](auto x, auto y, auto z) { return !c.pore(x, y, z) && !matter(x, y, z); });
    return c;
}

TEST(Classification, IsFigure6VoxelForVoxelOnRandomVolumesOnAnyThreads)
{
    std::uint64_t seed = 11;
    for (const Shape shape : {Shape{15, 13, 12}, Shape{70, 7, 5}})
        for (const auto& [R_C, R_E] : {std::pair{2.5, 1.5}, {3.5, 3.5}, {4.5, 2.5}, {1.5, 0.0}})
            for (const Border border : {Border::open, Border::matter}) {
                const Mask matter = complement(support::random_balls(shape, 30, 5.0, ++seed));
                const Classification expected = twin(matter, R_C, R_E, border);
                for (const int threads : {1, 2}) {
                    set_threads(threads);
                    const Classification c = classified(matter, R_C, R_E, border);
                    EXPECT_EQ(c.closed, expected.closed) << R_C << ' ' << R_E;
                    EXPECT_EQ(c.enlarged, expected.enlarged);
                    EXPECT_EQ(c.pore, expected.pore);
                    EXPECT_EQ(c.crack, expected.crack);
                }
            }
    set_threads(0);
}

TEST(Classification, TellsABallFromASheet)
{
    Mask void_({60, 60, 60});
    for (std::int64_t z = 0; z < 60; ++z)
        for (std::int64_t y = 0; y < 60; ++y)
            for (std::int64_t x = 0; x < 60; ++x) {
                const bool ball = (x - 30) * (x - 30) + (y - 30) * (y - 30) + (z - 20) * (z - 20) <= 144;
                if (ball || z == 50 || z == 51) void_.set(x, y, z, true);
            }
    const Classification c = classified(complement(void_), 8.5, 4.5);
    EXPECT_TRUE(c.pore(30, 30, 20));
    EXPECT_TRUE(c.pore(30, 30, 8));
    EXPECT_EQ(c.crack.count(), 2 * 60 * 60);
}

TEST(Classification, ABorderOfMatterAsksForTheWholeBall)
{
    Mask void_({40, 40, 40});  // half a ball of radius 10 at the wall x = 0: no ball of 8.5 fits inside
    for (std::int64_t z = 0; z < 40; ++z)
        for (std::int64_t y = 0; y < 40; ++y)
            for (std::int64_t x = 0; x < 40; ++x)
                void_.set(x, y, z, x * x + (y - 20) * (y - 20) + (z - 20) * (z - 20) <= 100);
    const Mask matter = complement(void_);
    EXPECT_EQ(classified(matter, 8.5, 4.5, Border::open).crack.count(), 0);
    EXPECT_EQ(classified(matter, 8.5, 4.5, Border::matter).pore.count(), 0);
}

images::Gray gray_of(const Mask& matter)
{
    images::Gray gray{Volume<std::uint8_t>(matter.shape()), 23.6e-9};
    for (std::int64_t z = 0; z < matter.shape().nz; ++z)
        for (std::int64_t y = 0; y < matter.shape().ny; ++y)
            for (std::int64_t x = 0; x < matter.shape().nx; ++x) gray.level(x, y, z) = matter(x, y, z) ? 165 : 45;
    return gray;
}

TEST(Classify, FillsTheVolumeWithMatterPoreAndCrack)
{
    const Mask matter = complement(support::random_balls({50, 40, 30}, 20, 8.0, 5));
    for (const auto method : {ThresholdMethod::moments, ThresholdMethod::otsu, ThresholdMethod::entropy}) {
        Settings settings;
        settings.threshold = method;
        settings.R_C = 4.5, settings.R_E = 2.5;
        const Microstructure micro = classify(gray_of(matter), settings);
        EXPECT_EQ(micro.matter, matter);
        EXPECT_EQ(micro.matter.count() + micro.pore.count() + micro.crack.count(), matter.shape().voxels());
        EXPECT_EQ(intersection(micro.pore, micro.crack).count(), 0);
        const Porosity p = porosity(micro);
        EXPECT_DOUBLE_EQ(p.total(), porosity(complement(matter)));
    }
}

TEST(Classify, RefusesWhatCannotBeParted)
{
    Settings settings;
    EXPECT_THROW(classify({}, settings), InvalidInput);
    EXPECT_THROW(classify(gray_of(complement(Mask({9, 9, 9}))), settings), InvalidInput);
    settings.threshold = ThresholdMethod::fixed;
    settings.level = 200;
    EXPECT_THROW(classify(gray_of(complement(Mask({9, 9, 9}))), settings), ComputationFailed);
    settings.level = 100;
    EXPECT_EQ(classify(gray_of(complement(Mask({9, 9, 9}))), settings).matter.count(), 729);
    settings.R_C = 3.5, settings.R_E = 4.5;
    EXPECT_THROW(check(settings), InvalidInput);
}

TEST(Porosity, OfDensitiesIsEquation1)
{
    EXPECT_DOUBLE_EQ(apparent_porosity(5454.0, 6060.0), 0.1);
    EXPECT_THROW(apparent_porosity(6061.0, 6060.0), InvalidInput);
    EXPECT_THROW(apparent_porosity(0.0, 6060.0), InvalidInput);
    EXPECT_THROW(apparent_porosity(std::nan(""), 6060.0), InvalidInput);
}

Microstructure micro_of(Mask pore, Mask crack)
{
    Microstructure micro;
    micro.matter = difference(complement(pore), crack);
    micro.pore = std::move(pore);
    micro.crack = std::move(crack);
    return micro;
}

TEST(Porosity, ProfilesAverageToTheWhole)
{
    const Shape shape{71, 13, 9};
    Mask pore = support::random_mask(shape, 0.1, 1);
    Mask crack = difference(support::random_mask(shape, 0.2, 2), pore);
    pore.set(70, 12, 8, true);
    crack.set(70, 12, 8, false);
    const Microstructure micro = micro_of(std::move(pore), std::move(crack));
    const Porosity whole = porosity(micro);
    for (const int threads : {1, 2}) {
        set_threads(threads);
        const auto profiles = porosity_profiles(micro);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& profile = profiles.along[axis];
            ASSERT_EQ(static_cast<std::int64_t>(profile.size()), shape[static_cast<int>(axis)]);
            double pores = 0, cracks = 0;
            for (const Porosity& p : profile) pores += p.pores, cracks += p.cracks;
            EXPECT_NEAR(pores / static_cast<double>(profile.size()), whole.pores, 1e-14);
            EXPECT_NEAR(cracks / static_cast<double>(profile.size()), whole.cracks, 1e-14);
        }
        EXPECT_NEAR(
            profiles.along[0][70].pores * 13 * 9,
            [&] {
                int n = 0;
                for (int z = 0; z < 9; ++z)
                    for (int y = 0; y < 13; ++y) n += micro.pore(70, y, z) ? 1 : 0;
                return n;
            }(),
            1e-9);
    }
    set_threads(0);
}

TEST(PorosityScatter, OfIndependentVoxelsFallsWithTheRootOfTheVolume)
{
    const Microstructure micro = micro_of(support::random_mask({128, 128, 128}, 0.06, 4), Mask({128, 128, 128}));
    const auto scatter = porosity_scatter(micro);
    ASSERT_EQ(scatter.size(), 3U);
    EXPECT_EQ(scatter[0].cubes, 512);
    EXPECT_EQ(scatter[2].edge, 64);
    // Binomial: sigma^2 = p (1 - p) / n.
    EXPECT_NEAR(scatter[0].total_deviation / std::sqrt(0.06 * 0.94 / 4096), 1, 0.1);
    EXPECT_NEAR(scatter[0].mean.total(), 0.06, 0.001);
    // sigma / p = 1 % at n = 0.94 / (0.06 1e-4), an edge of 53.9 px.
    EXPECT_NEAR(representative_edge(scatter, 0.01), std::cbrt(0.94 / 0.06 / 1e-4), 15);
}

}  // namespace
}  // namespace craze::microstructure
