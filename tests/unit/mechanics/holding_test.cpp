#include "craze/mechanics/holding.hpp"

#include "craze/core/random.hpp"
#include "craze/mechanics/contacts.hpp"
#include "craze/mechanics/neighbours.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace craze::mechanics {
namespace {

using domain::BondKind;

// Elements 0 and 2 touch without a bond; 1 is bonded to both.
Lattice bent_triple()
{
    auto d = support::bonded({3, 3, 3}, {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}}, {1, 1, 1}, {{0, 1}, {1, 2}});
    d.near.i = {0};
    d.near.j = {2};
    d.near.thickness = {0.0};
    return make_lattice(d, {});
}

TEST(Holding, AThirdElementHoldsTwoOthersUntilABeamBreaks)
{
    const Lattice lattice = bent_triple();
    const Holding holding(lattice);
    std::vector<BondKind> kind = lattice.kind;
    EXPECT_TRUE(holding.holds(0, 2, kind));
    EXPECT_TRUE(holding.holds(2, 0, kind));
    EXPECT_EQ(unilateral_contacts(lattice, kind, true).size(), 0);
    EXPECT_FALSE(holding.parted(0, 2, true, kind)) << "held at the tip of a crack";
    kind[1] = BondKind::contact_beam;
    EXPECT_FALSE(holding.holds(0, 2, kind));
    EXPECT_TRUE(holding.parted(0, 2, false, kind)) << "2 has lost a beam";
    EXPECT_EQ(unilateral_contacts(lattice, kind, true).size(), 2) << "the broken beam and the free contact";
}

TEST(Neighbours, PressedTogetherWhenTheyPartStartAtZeroForce)
{
    const Lattice lattice = bent_triple();
    std::vector<BondKind> kind = lattice.kind;
    std::vector<double> pose(24, 0.0), force(24, 0.0);
    for (const std::size_t e : {0U, 1U, 2U}) pose[8 * e + 7] = 1.0;
    pose[16] = -0.1;
    for (const Geometry geometry : {Geometry::corotational, Geometry::small_displacement}) {
        Neighbours neighbours(lattice, geometry);
        neighbours.follow(pose, lattice.kind, 0.0);
        EXPECT_EQ(neighbours.active().size(), 0) << "held";
        kind[1] = BondKind::contact_beam;
        EXPECT_TRUE(neighbours.part(pose, kind, std::vector<std::int32_t>{1, 2}));
        ASSERT_EQ(neighbours.active().size(), 1);
        EXPECT_NEAR(neighbours.active().limit[0], 1.9, 1e-14);
        EXPECT_EQ(add_pairs(neighbours.active(), 0, 1, 7.0, geometry, 3, pose.data(), force.data()), 0.0);

        // What goes on from here knows it, and pushes once they come nearer still.
        Neighbours later(lattice, geometry, neighbours.pressed());
        auto nearer = pose;
        nearer[16] = -0.15;
        later.follow(nearer, kind, 0.0);
        EXPECT_NEAR(add_pairs(later.active(), 0, 1, 7.0, geometry, 3, nearer.data(), force.data()), 0.5 * 7.0 * 0.0025,
                    1e-13);
    }
}

TEST(NearPairs, AreThoseOfBruteForce)
{
    const Lattice lattice = make_lattice(support::small_packing(300, 3), {});
    const std::int32_t n = lattice.elements();
    std::vector<double> pose(8 * lattice.r.size(), 0.0);
    Random random(2);
    for (std::size_t k = 0; k < pose.size(); ++k)
        if (k % 8 < 3) pose[k] = lattice.mean_radius * random.uniform(-0.5, 0.5);
    pose[0] += 50.0 * lattice.mean_radius;  // a fragment far away
    const double reach = 0.3 * lattice.mean_radius;
    const Pairs got = near_pairs(lattice, Geometry::corotational, pose, reach);
    std::size_t p = 0, strangers = 0;
    const auto at = [&](std::int32_t e) {
        const double* u = pose.data() + 8 * std::int64_t{e};
        return lattice.centre(e) + Vec3{u[0], u[1], u[2]};
    };
    const auto among = [](const auto& is, const auto& js, std::int32_t i, std::int32_t j) {
        for (std::size_t k = 0; k < is.size(); ++k)
            if (is[k] == i && js[k] == j) return true;
        return false;
    };
    for (std::int32_t i = 0; i < n; ++i)
        for (std::int32_t j = i + 1; j < n; ++j) {
            const double touch =
                lattice.r[static_cast<std::size_t>(i)] + lattice.r[static_cast<std::size_t>(j)] + reach;
            const bool listed = among(lattice.free.i, lattice.free.j, i, j);
            if (norm(at(j) - at(i)) >= touch || among(lattice.i, lattice.j, i, j)) continue;
            if (!listed && norm(lattice.centre(j) - lattice.centre(i)) < touch) continue;
            ASSERT_LT(p, got.i.size());
            EXPECT_EQ(got.i[p], i);
            EXPECT_EQ(got.j[p], j);
            EXPECT_EQ(got.cut[p], listed ? 0 : 1);
            ++p, strangers += !listed;
        }
    EXPECT_EQ(p, got.i.size());
    EXPECT_GT(strangers, 10U);
    EXPECT_GT(p - strangers, 10U);
}

// Step by step, or all looked at anew: the same contacts and the same bits.
TEST(Neighbours, WhatPartsIsWhatASearchFromNothingFinds)
{
    const Lattice lattice = make_lattice(support::small_packing(400, 3), {});
    const auto n = lattice.r.size();
    for (const Geometry geometry : {Geometry::corotational, Geometry::small_displacement}) {
        Random random(5);
        std::vector<BondKind> kind = lattice.kind;
        std::vector<double> pose(8 * n, 0.0);
        for (std::size_t e = 0; e < n; ++e) pose[8 * e + 7] = 1.0;
        Neighbours followed(lattice, geometry);
        followed.follow(pose, kind, 0.0);
        std::int64_t touching = 0;
        for (int step = 0; step < 30; ++step) {
            const double most = 0.02 * lattice.mean_radius;
            for (std::size_t k = 0; k < 8 * n; ++k)
                if (k % 8 < 3) pose[k] += random.uniform(-most, most) / std::sqrt(3.0);
            followed.follow(pose, kind, 2.0 * most);
            std::vector<std::int32_t> ends;
            for (std::size_t b = 0; b < kind.size(); ++b)
                if (random.uniform(0.0, 1.0) < 0.02 && kind[b] == BondKind::beam) {
                    kind[b] = BondKind::contact_beam;
                    ends.insert(ends.end(), {lattice.i[b], lattice.j[b]});
                }
            followed.part(pose, kind, ends);

            Neighbours anew(lattice, geometry, followed.pressed());
            anew.follow(pose, kind, 0.0);
            std::vector<double> expected(8 * n, 0.0), got(8 * n, 0.0);
            const auto push = [&](const Neighbours& from, std::vector<double>& force) {
                return add_pairs(from.active(), 0, from.active().size(), 7.0, geometry, lattice.elements(), pose.data(),
                                 force.data());
            };
            ASSERT_EQ(push(followed, got), push(anew, expected)) << step;
            ASSERT_EQ(got, expected) << step;
            for (const double f : got) touching += f != 0.0;
        }
        EXPECT_GT(touching, 1000);
    }
}

TEST(Holding, ElementsWithoutACommonOneTouchAcrossACrackOnly)
{
    auto d = support::bonded({9, 3, 3}, {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {6, 0, 0}}, {1, 1, 1, 1}, {{0, 1}, {2, 3}});
    d.near.i = {1};
    d.near.j = {2};
    d.near.thickness = {0.0};
    const Lattice whole = make_lattice(d, {});
    EXPECT_EQ(unilateral_contacts(whole, whole.kind, true).size(), 0) << "nothing has parted them";
    d.near.thickness = {0.1};
    const Lattice cracked = make_lattice(d, {});
    EXPECT_EQ(unilateral_contacts(cracked, cracked.kind, true).size(), 1);
}

TEST(Holding, AgreesWithBruteForceOnARandomGraph)
{
    Random random(5);
    std::vector<Vec3> centres;
    for (int e = 0; e < 40; ++e) centres.push_back({random.uniform(), random.uniform(), random.uniform()});
    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    while (pairs.size() < 120) {
        const auto i = static_cast<std::int32_t>(random.below(40)), j = static_cast<std::int32_t>(random.below(40));
        if (i != j) pairs.insert(std::minmax(i, j));
    }
    const auto d = support::bonded({1, 1, 1}, centres, std::vector<double>(40, 0.1), {pairs.begin(), pairs.end()});
    const Lattice lattice = make_lattice(d, {});
    std::vector<BondKind> kind = lattice.kind;
    for (auto& k : kind) k = random.uniform() < 0.3 ? BondKind::contact_beam : BondKind::beam;

    std::set<std::pair<std::int32_t, std::int32_t>> intact;
    for (std::size_t b = 0; b < kind.size(); ++b)
        if (kind[b] == BondKind::beam)
            intact.insert({lattice.i[b], lattice.j[b]}), intact.insert({lattice.j[b], lattice.i[b]});
    const Holding holding(lattice);
    int held = 0;
    for (std::int32_t i = 0; i < 40; ++i)
        for (std::int32_t j = i + 1; j < 40; ++j) {
            bool expected = false;
            for (std::int32_t k = 0; k < 40; ++k)
                expected = expected || (intact.contains({i, k}) && intact.contains({k, j}));
            EXPECT_EQ(holding.holds(i, j, kind), expected) << i << " " << j;
            held += expected;
        }
    EXPECT_GT(held, 100);
}

}  // namespace
}  // namespace craze::mechanics
