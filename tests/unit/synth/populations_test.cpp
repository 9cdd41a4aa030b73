// What a recipe says of a population is what its defects are.

#include "craze/synth/synth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::synth {
namespace {

constexpr double um = 1e-6, nm = 1e-9;

/// One population of cracks, 400 of them centred in a cube of 12 um.
Settings cracks_only(const CrackPopulation& population)
{
    Settings s;
    s.shape = {120, 120, 120};
    s.voxel_size = 0.1 * um;
    s.pores.clear();
    s.cracks = {population};
    return s;
}
CrackPopulation many()
{
    CrackPopulation p;
    p.count = 400;
    p.radius = {0.5 * um, 0.4, 0.1 * um, 2.0 * um};
    return p;
}
double radius(const Crack& c) { return std::sqrt(c.a * c.b); }

double share(const Coating& coating, auto&& is)
{
    return static_cast<double>(std::count_if(coating.cracks.begin(), coating.cracks.end(), is)) /
           static_cast<double>(coating.cracks.size());
}

double nearest_distance(const Coating& coating)
{
    double sum = 0.0;
    for (const auto& one : coating.cracks) {
        double least = 1.0;
        for (const auto& other : coating.cracks)
            if (&one != &other) least = std::min(least, norm(one.centre - other.centre));
        sum += least;
    }
    return sum / static_cast<double>(coating.cracks.size());
}

TEST(CrackPopulation, StandsAcrossTheAxesItIsAskedFor)
{
    auto p = many();
    p.normals = {1.0, 3.0, 0.0};
    p.scatter = 0.1;
    const Coating coating = make_coating(cracks_only(p));
    const auto along = [](int axis) { return [axis](const Crack& c) { return std::abs(c.frame.n[axis]) > 0.9; }; };
    EXPECT_NEAR(share(coating, along(0)), 0.25, 0.06);
    EXPECT_NEAR(share(coating, along(1)), 0.75, 0.06);
    EXPECT_EQ(share(coating, along(2)), 0.0);

    // Without scatter all are exact, with much of it they are isotropic: <n_z^2> = 1/3.
    p.scatter = 0.0;
    for (const auto& c : make_coating(cracks_only(p)).cracks)
        EXPECT_NEAR(std::max(std::abs(c.frame.n.x), std::abs(c.frame.n.y)), 1.0, 1e-12);
    p.scatter = 100.0;
    double square = 0.0;
    const Coating round = make_coating(cracks_only(p));
    for (const auto& c : round.cracks) square += c.frame.n.z * c.frame.n.z;
    EXPECT_NEAR(square / static_cast<double>(round.cracks.size()), 1.0 / 3.0, 0.05);
}

TEST(CrackPopulation, HasLognormalOpeningsWithinTheirBounds)
{
    auto p = many();
    p.aperture = {40 * nm, 0.6, 2 * nm, 380 * nm};
    const Coating coating = make_coating(cracks_only(p));
    std::vector<double> logs;
    for (const auto& c : coating.cracks) {
        EXPECT_GE(c.aperture, 2 * nm);
        EXPECT_LE(c.aperture, 380 * nm);
        logs.push_back(std::log(c.aperture / (40 * nm)));
    }
    std::sort(logs.begin(), logs.end());
    const std::size_t n = logs.size();
    EXPECT_NEAR(logs[n / 2], 0.0, 0.12);
    EXPECT_NEAR(0.5 * (logs[n * 84 / 100] - logs[n * 16 / 100]), 0.6, 0.08) << "half of the middle 68 %";
}

TEST(CrackPopulation, OpensWithItsRadiusWhereItIsToGrow)
{
    auto p = many();
    p.aperture = {40 * nm, 0.0, 1 * nm, 900 * nm};
    p.aperture_growth = 1.5;
    for (const auto& c : make_coating(cracks_only(p)).cracks)
        EXPECT_NEAR(c.aperture, 40 * nm * std::pow(radius(c) / p.radius.median, 1.5), 1e-3 * nm);
}

TEST(CrackPopulation, StaysAsFarApartAsItIsAskedTo)
{
    auto p = many();
    p.count = 60;
    p.gap = 1.2;
    const Coating coating = make_coating(cracks_only(p));
    for (const auto& one : coating.cracks)
        for (const auto& other : coating.cracks)
            if (&one != &other) {
                EXPECT_GE(norm(one.centre - other.centre), 1.2 * (radius(one) + radius(other)) - 1e-12);
            }
}

TEST(CrackPopulation, GathersInClusters)
{
    auto p = many();
    const double spread = nearest_distance(make_coating(cracks_only(p)));
    p.clustered = 0.9;
    p.cluster_radius = 0.3 * um;
    const Coating together = make_coating(cracks_only(p));
    EXPECT_LT(nearest_distance(together), 0.6 * spread);
    const auto inside = [](const Crack& c) {
        return std::min({c.centre.x, c.centre.y, c.centre.z}) >= 0.0 &&
               std::max({c.centre.x, c.centre.y, c.centre.z}) <= 12 * um;
    };
    EXPECT_EQ(std::count_if(together.cracks.begin(), together.cracks.end(), inside), 400);
}

TEST(CrackPopulation, StartsAtPoresWhereItIsAskedTo)
{
    auto s = cracks_only(many());
    s.cracks[0].count = 200;
    s.pores = {{.radius = {0.6 * um, 0.0, 0.1 * um, 2 * um}, .porosity = 0.03}};
    const auto touches = [&](const Coating& coating) {
        return share(coating, [&](const Crack& c) {
            for (int k = 0; k < 24; ++k) {
                const double angle = 2.0 * std::numbers::pi * k / 24;
                if (in_pore(coating, c.centre + c.a * std::cos(angle) * c.frame.u + c.b * std::sin(angle) * c.frame.v))
                    return true;
            }
            return false;
        });
    };
    const double by_chance = touches(make_coating(s));
    s.cracks[0].at_pores = 1.0;
    EXPECT_GT(touches(make_coating(s)), by_chance + 0.3);
}

TEST(CrackPopulation, HasTheShapeItIsAskedFor)
{
    auto p = many();
    p.elongation = 2.0;
    for (const auto& c : make_coating(cracks_only(p)).cracks) {
        EXPECT_DOUBLE_EQ(c.a, c.b);
        EXPECT_EQ(relief(c), 0.0);
    }
    p.shape = CrackShape::elliptic;
    for (const auto& c : make_coating(cracks_only(p)).cracks) EXPECT_NEAR(c.a / c.b, 2.0, 1e-12);
    p.shape = CrackShape::wavy;
    for (const auto& c : make_coating(cracks_only(p)).cracks) {
        EXPECT_GT(relief(c), 0.0);
        EXPECT_EQ(c.curvature, 0.0);
    }
    p.shape = CrackShape::bent;
    for (const auto& c : make_coating(cracks_only(p)).cracks)
        EXPECT_NEAR(std::abs(c.curvature) * radius(c), p.bend, 1e-9);
}

TEST(CrackPopulation, OfALensHoldsTwoThirdsOfAFlatOne)
{
    auto p = many();
    p.count = 20;
    const Coating lens = make_coating(cracks_only(p));
    p.profile = ApertureProfile::flat;
    const Coating flat = make_coating(cracks_only(p));
    ASSERT_EQ(lens.cracks.size(), flat.cracks.size());
    for (std::size_t k = 0; k < lens.cracks.size(); ++k) {
        const Crack& c = flat.cracks[k];
        EXPECT_NEAR(volume(c), std::numbers::pi * c.a * c.b * c.aperture, 1e-9 * volume(c));
        EXPECT_NEAR(volume(lens.cracks[k]) / volume(c), 2.0 / 3.0, 1e-9);
    }
}

TEST(PorePopulation, GathersInClustersAndMayOverlap)
{
    Settings s;
    s.shape = {120, 120, 120};
    s.voxel_size = 0.1 * um;
    s.cracks.clear();
    s.pores = {{.radius = {0.3 * um, 0.0, 0.1 * um, 1 * um}, .count = 80, .gap = -1.0}};
    const auto mean_nearest = [](const Coating& coating) {
        double sum = 0.0;
        for (const auto& one : coating.pores) {
            double least = 1.0;
            for (const auto& other : coating.pores)
                if (&one != &other) least = std::min(least, norm(one.lobes[0].centre - other.lobes[0].centre));
            sum += least;
        }
        return sum / static_cast<double>(coating.pores.size());
    };
    const double spread = mean_nearest(make_coating(s));
    s.pores[0].clustered = 0.9;
    s.pores[0].cluster_radius = 0.4 * um;
    const double together = mean_nearest(make_coating(s));
    EXPECT_LT(together, 0.5 * spread);
    EXPECT_LT(together, 2.0 * 0.3 * um) << "with a gap below zero they overlap";
}

TEST(PorePopulation, OfIrregularOnesLiesAcrossZUnlessScattered)
{
    Settings s;
    s.shape = {120, 120, 120};
    s.voxel_size = 0.1 * um;
    s.cracks.clear();
    s.pores = {{.shape = PoreShape::irregular,
                .radius = {0.3 * um, 0.0, 0.1 * um, 1 * um},
                .flatness = 0.5,
                .count = 400,
                .gap = -1.0}};
    // Shares of the direction z in the lobes' normals and in the steps from lobe to lobe, mean squares.
    const auto along_z = [](const Coating& coating) {
        double normals = 0.0, steps = 0.0;
        for (const auto& pore : coating.pores)
            for (std::size_t l = 1; l < pore.lobes.size(); ++l) {
                const Vec3 step = pore.lobes[l].centre - pore.lobes[0].centre;
                normals += pore.lobes[l].frame.n.z * pore.lobes[l].frame.n.z;
                steps += step.z * step.z / dot(step, step);
            }
        const auto count = 3.0 * static_cast<double>(coating.pores.size());
        return std::pair{normals / count, steps / count};
    };
    const auto flat = along_z(make_coating(s));
    EXPECT_GT(flat.first, 0.85);
    EXPECT_LT(flat.second, 0.15);
    s.pores[0].scatter = 100.0;
    const auto any = along_z(make_coating(s));
    EXPECT_NEAR(any.first, 1.0 / 3.0, 0.06);
    EXPECT_NEAR(any.second, 1.0 / 3.0, 0.06);
}

}  // namespace
}  // namespace craze::synth
