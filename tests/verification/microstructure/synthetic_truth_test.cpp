// A coating whose truth is known, classified: true pores become pores, true cracks become cracks.

#include "craze/core/progress.hpp"
#include "craze/images/non_local_means.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/objects.hpp"
#include "craze/microstructure/sweep.hpp"
#include "craze/microstructure/threshold.hpp"
#include "craze/synth/synth.hpp"

#include <gtest/gtest.h>

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

TEST(SyntheticCoating, TruePoresBecomePoresAndTrueCracksCracks)
{
    set_verbosity(Verbosity::quiet);
    synth::Settings recipe;
    recipe.shape = {180, 180, 180};
    const auto label = synth::observe(synth::make_coating(recipe), recipe).label;
    const Mask matter = matter_of(label, 200), not_pore = matter_of(label, 100);
    const Mask crack = difference(not_pore, matter), pore = complement(not_pore);
    const Components each = components(pore);
    std::vector<std::uint8_t> large;
    for (const Object& o : measured(pore, each, squared_distance(not_pore)))
        large.push_back(o.inscribed_radius > 8.5 ? 1 : 0);
    const Mask large_pores = selected(each, large);
    const Classification c = classified(matter, 8.5, 4.5);
    EXPECT_GT(large_pores.count(), 100'000);
    EXPECT_GT(crack.count(), 50'000);
    EXPECT_GE(share(c.pore, large_pores), 0.97);
    EXPECT_GE(share(c.crack, crack), 0.90);

    Settings settings;
    settings.sweep.most = 9.5;
    const Sweep sweep = swept(matter, settings);
    const Classification proposed = classified(matter, sweep.R_C, sweep.R_E);
    EXPECT_GE(share(proposed.pore, large_pores), 0.97);
    EXPECT_GE(share(proposed.crack, crack), 0.90);
    for (const SweepRow& row : sweep.erosion)
        if (row.R_E == sweep.R_E) {
            EXPECT_LE(row.shell_share, settings.sweep.shell_share);
        }
}

}  // namespace
}  // namespace craze::microstructure
