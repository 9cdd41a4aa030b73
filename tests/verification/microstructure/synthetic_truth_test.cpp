// A coating whose truth is known, classified: true pores become pores, true cracks become cracks.

#include "craze/core/progress.hpp"
#include "craze/images/non_local_means.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/objects.hpp"
#include "craze/microstructure/sweep.hpp"
#include "craze/microstructure/threshold.hpp"
#include "craze/synth/synth.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace craze::microstructure {
namespace {

double share(const Mask& found, const Mask& truth)
{
    return static_cast<double>(intersection(found, truth).count()) / static_cast<double>(truth.count());
}

// The order the paper found (Fig. 4), after the paper's filter.
TEST(SyntheticCoating, ThresholdsOfTheDenoisedVolumeRiseFromOtsuToMomentsToEntropy)
{
    synth::Settings recipe;
    recipe.shape = {96, 96, 96};
    const auto seen = synth::observe(synth::make_coating(recipe), recipe);
    images::NonLocalMeans filter;
    filter.sigma = 12;
    filter.h = 0.6 * filter.sigma;
    const Histogram levels = histogram(images::non_local_means(seen.stack.level, filter));
    EXPECT_LT(otsu_threshold(levels).value(), moments_threshold(levels).value());
    EXPECT_LT(moments_threshold(levels).value(), entropy_threshold(levels).value());
}

// True labels of the default recipe: 5.9 % pores, 3 % cracks.
struct Truth {
    static constexpr std::int64_t n = 300;
    Mask matter, pore, crack, large_pores;  ///< large: their inscribed ball is larger than R_C = 8.5 px

    Truth()
    {
        synth::Settings recipe;
        recipe.shape = {n, n, n};
        const auto label = synth::observe(synth::make_coating(recipe), recipe).label;
        const Mask not_pore = matter_of(label, 100);
        matter = matter_of(label, 200), crack = difference(not_pore, matter), pore = complement(not_pore);
        const Components each = components(pore);
        std::vector<std::uint8_t> large;
        for (const Object& o : measured(pore, each, squared_distance(not_pore)))
            large.push_back(o.inscribed_radius > 8.5 ? 1 : 0);
        large_pores = selected(each, large);
    }
};

const Truth& truth()
{
    set_verbosity(Verbosity::quiet);
    static const Truth made;
    return made;
}

Sweep proposal(const Mask& matter)
{
    Settings settings;
    settings.sweep.most = 9.5;
    return swept(matter, settings);
}

TEST(SyntheticCoating, TruePoresBecomePoresAndTrueCracksCracks)
{
    ASSERT_GT(truth().large_pores.count(), 100'000);
    ASSERT_GT(truth().crack.count(), 50'000);
    const Sweep sweep = proposal(truth().matter);
    for (const auto& [R_C, R_E] : {std::pair{8.5, 4.5}, {sweep.R_C, sweep.R_E}}) {
        const Classification c = classified(truth().matter, R_C, R_E);
        const double pores = share(c.pore, truth().large_pores), cracks = share(c.crack, truth().crack);
        std::cout << fmt::format("R_C {} R_E {}: {:.2f} % of large pores are pore, {:.2f} % of cracks crack\n", R_C,
                                 R_E, 100 * pores, 100 * cracks);
        EXPECT_GE(pores, 0.97);
        EXPECT_GE(cracks, 0.90);
    }
}

// What a shell is by the truth: a crack object most of which is part of a large pore.
double parasitic_share(const Mask& crack)
{
    const Components each = components(crack);
    const Components within = components(intersection(crack, truth().large_pores));
    std::vector<std::int64_t> in_pore(static_cast<std::size_t>(each.count), 0);
    const auto label = painted(each);
    const Shape& s = crack.shape();
    for (std::int64_t r = 0; r < s.ny * s.nz; ++r)
        for (auto i = within.row_begin[static_cast<std::size_t>(r)];
             i < within.row_begin[static_cast<std::size_t>(r) + 1]; ++i) {
            const Run& run = within.runs[static_cast<std::size_t>(i)];
            in_pore[static_cast<std::size_t>(label(run.first, r % s.ny, r / s.ny) - 1)] += run.length();
        }
    const auto volume = volumes(each);
    std::int64_t shells = 0;
    for (std::size_t k = 0; k < volume.size(); ++k)
        if (2 * in_pore[k] > volume[k]) shells += volume[k];
    return static_cast<double>(shells) / static_cast<double>(crack.count());
}

TEST(SyntheticCoating, HasNoParasiticShellsAtTheProposedErosion)
{
    const auto shells = [](double R_C, double R_E) {
        const double share = parasitic_share(classified(truth().matter, R_C, R_E).crack);
        std::cout << fmt::format("R_C {} R_E {}: {:.4f} % of the cracks are shells\n", R_C, R_E, 100 * share);
        return share;
    };
    const Sweep sweep = proposal(truth().matter);
    EXPECT_LT(shells(sweep.R_C, sweep.R_E), 5e-4);
    EXPECT_GT(shells(8.5, 0.0), 1e-2);
    EXPECT_LT(shells(8.5, 4.5), 1e-3);
}

// Every pore that has grown from a ball of R_C holds it. The others are void within R_E of such a pore but parted from
// it: they lie in img. 1b and outside img. 1a.
TEST(SyntheticCoating, EveryPoreHoldsABallOfR_CButVoidBehindAWall)
{
    const Classification c = classified(truth().matter, 8.5, 4.5);
    const Components each = components(c.pore);
    const auto label = painted(each);
    std::vector<std::uint8_t> grown(static_cast<std::size_t>(each.count), 0);
    const Components closed = components(c.closed);
    for (std::int64_t r = 0; r < Truth::n * Truth::n; ++r)
        for (auto i = closed.row_begin[static_cast<std::size_t>(r)];
             i < closed.row_begin[static_cast<std::size_t>(r) + 1]; ++i)
            grown[static_cast<std::size_t>(
                label(closed.runs[static_cast<std::size_t>(i)].first, r % Truth::n, r / Truth::n) - 1)] = 1;
    const auto objects = measured(c.pore, each, squared_distance(truth().matter));
    std::int64_t exceptions = 0, voxels = 0;
    for (std::size_t k = 0; k < objects.size(); ++k) {
        EXPECT_EQ(objects[k].inscribed_radius > 8.5, grown[k] != 0) << "pore " << k;
        if (grown[k] == 0) ++exceptions, voxels += objects[k].volume;
    }
    std::cout << fmt::format("{} of {} pores hold no ball of R_C: {} of {} voxels\n", exceptions, objects.size(),
                             voxels, c.pore.count());
    EXPECT_GT(std::ssize(objects) - exceptions, 20);
    EXPECT_LT(static_cast<double>(voxels), 0.002 * static_cast<double>(c.pore.count()));
}

}  // namespace
}  // namespace craze::microstructure
