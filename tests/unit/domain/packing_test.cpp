#include "craze/domain/packing.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/cells.hpp"
#include "craze/domain/pairs.hpp"
#include "craze/domain/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace craze::domain {
namespace {

constexpr double R = 200e-9;
constexpr Vec3 small_box{22 * R, 18 * R, 20 * R};

TEST(ElementCount, IsThePapersInThePapersBox)
{
    EXPECT_EQ(element_count({17.61e-6, 13.24e-6, 21.22e-6}, {}), 92000);  // [3.1.1]
}

TEST(ElementCount, RefusesBoxesThatHoldNone)
{
    EXPECT_THROW(element_count({1e-6, 1e-6, 0.1e-6}, {}), InvalidInput);
    EXPECT_THROW(element_count({1e-6, std::nan(""), 1e-6}, {}), InvalidInput);
    EXPECT_THROW(element_count({1, 1, 1}, {}), InvalidInput);
    EXPECT_THROW(element_count(small_box, {.mean_radius = 0.0}), InvalidInput);
}

TEST(Packing, FillsItsBoxDenselyWithHardlyAnyOverlap)
{
    PackingReport report;
    const Elements e = pack_elements(small_box, {}, &report);
    const Domain d = join(e, small_box, R, {});
    const Quality q = quality(d);
    EXPECT_EQ(e.size(), element_count(small_box, {}));
    EXPECT_NEAR(q.volume_fraction, 0.61, 0.02);            // walls included
    EXPECT_NEAR(q.interior_volume_fraction, 0.645, 0.05);  // some 300 elements: noisy
    EXPECT_LE(q.overlap[2], 0.003);                        // median
    EXPECT_LE(q.overlap[4], 0.02);                         // most
    EXPECT_NEAR(q.interior_cardinality, 6.2, 0.01);
    for (std::int32_t k = 0; k < e.size(); ++k)
        for (int axis = 0; axis < 3; ++axis) {
            const double c = e.centre(k)[axis], r = e.r[static_cast<std::size_t>(k)];
            ASSERT_GT(c, 0.95 * r);
            ASSERT_LT(c, small_box[axis] - 0.95 * r);
        }
}

TEST(Packing, RadiiAreUniformAroundTheMean)
{
    const Elements e = pack_elements(small_box, {.half_width = 0.25});
    const auto [least, most] = std::ranges::minmax(e.r);
    double sum = 0.0, squares = 0.0;
    for (const double r : e.r) sum += r, squares += r * r;
    const double n = e.size(), mean = sum / n, deviation = std::sqrt(squares / n - mean * mean);
    EXPECT_GE(least, 0.75 * R);
    EXPECT_LE(most, 1.25 * R);
    EXPECT_NEAR(mean / R, 1.0, 4.0 * 0.25 / std::sqrt(3.0 * n));
    EXPECT_NEAR(deviation / R, 0.25 / std::sqrt(3.0), 0.01);
}

TEST(Packing, IsTheSameOnAnyNumberOfThreadsAndAnotherWithAnotherSeed)
{
    const Vec3 box{14 * R, 12 * R, 13 * R};
    set_threads(1);
    const Elements one = pack_elements(box, {});
    set_threads(2);
    const Elements two = pack_elements(box, {});
    set_threads(3);
    const Elements three = pack_elements(box, {});
    set_threads(0);
    EXPECT_EQ(one.x, two.x);
    EXPECT_EQ(one.z, two.z);
    EXPECT_EQ(one.r, two.r);
    EXPECT_EQ(one.y, three.y);
    EXPECT_NE(pack_elements(box, {.seed = 2}).x, one.x);
}

TEST(Packing, InAPeriodicBoxHasNoWallLayer)
{
    const Elements e = pack_elements(small_box, {.periodic = true});
    const Pairs all = pairs_within(e, small_box, 0.0, true), inside = pairs_within(e, small_box, 0.0, false);
    EXPECT_GT(all.size(), inside.size());
    EXPECT_NEAR(2.0 * static_cast<double>(all.size()) / e.size(), 6.4, 0.3);
    for (std::int64_t p = 0; p < all.size(); ++p) ASSERT_GT(all.gap[static_cast<std::size_t>(p)], -0.04 * 1.125 * R);
    // Layers at a wall would show as a density wave along an axis.
    std::vector<int> slab(11, 0);
    for (const double x : e.x) ++slab[std::min<std::size_t>(10, static_cast<std::size_t>(x / (2 * R)))];
    for (const int count : slab) EXPECT_NEAR(count * 11.0 / e.size(), 1.0, 0.25);
    const Domain d = join(e, small_box, R, {}, true);
    for (std::int32_t b = 0; b < d.bonds.size(); ++b) ASSERT_LT(rest_length(d, b), 3 * R);
}

TEST(Packing, IsSortedAlongAMortonCurve)
{
    const Elements e = pack_elements(small_box, {});
    const auto order = morton_order(small_box / R, e.x, e.y, e.z);
    std::uint64_t before = 0;
    for (std::int32_t k = 0; k < e.size(); ++k) {
        const std::uint64_t code = morton_code(e.centre(k) / R, small_box / R);
        ASSERT_GE(code, before);
        before = code;
    }
}

TEST(PairsWithin, EqualBruteForce)
{
    for (const bool periodic : {false, true})
        for (const double gap : {0.0, 0.3 * R, 1.1 * R}) {
            const Elements e = pack_elements({8 * R, 7 * R, 9 * R}, {.periodic = periodic});
            const Vec3 box{8 * R, 7 * R, 9 * R};
            const Pairs found = pairs_within(e, box, gap, periodic);
            std::size_t p = 0;
            for (std::int32_t i = 0; i < e.size(); ++i)
                for (std::int32_t j = i + 1; j < e.size(); ++j) {
                    Vec3 d = e.centre(j) - e.centre(i);
                    if (periodic)
                        for (int axis = 0; axis < 3; ++axis) {
                            if (d[axis] > box[axis] / 2) d[axis] -= box[axis];
                            if (d[axis] < -box[axis] / 2) d[axis] += box[axis];
                        }
                    const double between =
                        norm(d) - e.r[static_cast<std::size_t>(i)] - e.r[static_cast<std::size_t>(j)];
                    if (between > gap) continue;
                    ASSERT_LT(p, found.i.size());
                    ASSERT_EQ(found.i[p], i);
                    ASSERT_EQ(found.j[p], j);
                    ASSERT_NEAR(found.gap[p], between, 1e-9 * R);
                    ++p;
                }
            EXPECT_EQ(p, found.i.size());
        }
}

TEST(Join, BondsTheNearestAndKeepsTheRestAsNearPairs)
{
    const Elements e = pack_elements(small_box, {});
    const Domain d = join(e, small_box, R, {.cardinality = 5.0, .near_gap = 0.3});
    const auto gap = [&](std::int32_t i, std::int32_t j) {
        return norm(d.elements.centre(j) - d.elements.centre(i)) - d.elements.r[static_cast<std::size_t>(i)] -
               d.elements.r[static_cast<std::size_t>(j)];
    };
    double widest_bond = -1.0, nearest_pair = 1.0;
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b)
        widest_bond = std::max(widest_bond, gap(d.bonds.i[b], d.bonds.j[b]));
    for (std::size_t p = 0; p < d.near.i.size(); ++p)
        nearest_pair = std::min(nearest_pair, gap(d.near.i[p], d.near.j[p]));
    EXPECT_LE(widest_bond, nearest_pair);
    EXPECT_EQ(d.bonds.i.size() + d.near.i.size(), static_cast<std::size_t>(pairs_within(e, small_box, 0.3 * R).size()));
    EXPECT_TRUE(std::ranges::is_sorted(d.bonds.i));
    EXPECT_NEAR(quality(d).interior_cardinality, 5.0, 0.01);
    EXPECT_THROW(join(e, small_box, R, {.cardinality = 40.0}), InvalidInput);
}

TEST(Quality, OfATouchingRowIsKnown)
{
    Domain d;
    d.box = {8, 2, 2};
    d.mean_radius = 1.0;
    d.elements = {{1, 2.9, 5, 7}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}};
    d.bonds = {{0, 1}, {1, 2}, {BondKind::beam, BondKind::beam}, {0, 0}};
    const Quality q = quality(d);
    EXPECT_EQ(q.rattlers, 1);
    EXPECT_EQ(q.components, 1);
    EXPECT_DOUBLE_EQ(q.largest_component, 0.75);
    EXPECT_DOUBLE_EQ(q.cardinality, 1.0);
    EXPECT_NEAR(q.overlap[4], 0.05, 1e-12);
    EXPECT_DOUBLE_EQ(q.fabric[0], 1.0);
    EXPECT_DOUBLE_EQ(q.fabric[1] + q.fabric[2] + q.fabric[3] + q.fabric[4] + q.fabric[5], 0.0);
    EXPECT_NEAR(q.volume_fraction, 3.14159265358979 / 6.0, 1e-12);
    EXPECT_EQ(q.touching, 1);
    EXPECT_DOUBLE_EQ(q.contact_number, 0.5);
    // L_0 is each bond's own: 1.9 and 2.1 radii, around the 2 R_DE of [Eq. 4].
    EXPECT_NEAR(q.bond_length[0], 0.95, 1e-12);
    EXPECT_NEAR(q.bond_length[4], 1.05, 1e-12);
    for (std::size_t bin = 0; bin < 60; ++bin) {
        const double middle = 0.705 + 0.01 * static_cast<double>(bin);
        const bool edge = std::abs(middle - 0.95) < 0.006 || std::abs(middle - 1.05) < 0.006;
        if (!edge) {
            EXPECT_EQ(q.bond_length_counts[bin], 0) << middle;
        }
    }
    EXPECT_EQ(std::accumulate(q.bond_length_counts.begin(), q.bond_length_counts.end(), std::int64_t{0}), 2);
}

}  // namespace
}  // namespace craze::domain
