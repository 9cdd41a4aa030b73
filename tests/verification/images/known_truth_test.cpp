// The whole chain on a coating whose truth is known: stripes, a gradient and noise go, thin cracks stay.

#include "craze/core/progress.hpp"
#include "craze/images/images.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/microstructure/classification.hpp"
#include "craze/microstructure/threshold.hpp"
#include "support/data.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace craze::images {
namespace {

TEST(Chain, RecoversTheVoidsAndThinCracksOfTheKnownCoating)
{
    const auto data = support::data_folder() / "known_truth";
    CRAZE_NEEDS_DATA(data);
    set_verbosity(Verbosity::quiet);
    const support::TemporaryFolder folder;
    Settings s;
    s.source = (data / "stack.tif").string();
    s.voxel_size = {23.6e-9};
#ifdef CRAZE_SANITIZED
    constexpr std::int64_t n = 48;
#else
    constexpr std::int64_t n = 96;
#endif
    s.crop = {80, 80 + n, 80, 80 + n, 80, 80 + n};
    s.stripes.axis = 1;
    s.homogenise.by = Homogenise::By::solid;
    const auto done = preprocess(s, folder / "images");
    const Gray gray = load_gray(folder / "images");
    const auto truth = io::read_volume<std::uint8_t>(data / "truth_matter_255.tif");
    ASSERT_EQ(gray.level.shape(), done.shape);

    Mask void_truth(done.shape);
    for (std::int64_t z = 0; z < done.shape.nz; ++z)
        for (std::int64_t y = 0; y < done.shape.ny; ++y)
            for (std::int64_t x = 0; x < done.shape.nx; ++x)
                void_truth.set(x, y, z, truth(x + 80 + done.kept.x0, y + 80 + done.kept.y0, z + 80) == 0);
    const auto S = microstructure::moments_threshold(microstructure::histogram(gray.level));
    ASSERT_TRUE(S.has_value());
    const Mask void_found = complement(microstructure::matter_of(gray.level, *S));
    const Mask cracks = microstructure::classified(complement(void_truth), 8.5, 4.5).crack;
    const auto share = [](std::int64_t a, std::int64_t b) { return static_cast<double>(a) / static_cast<double>(b); };
    const double dice =
        share(2 * intersection(void_truth, void_found).count(), void_truth.count() + void_found.count());
    const double recall = share(intersection(cracks, void_found).count(), cracks.count());
    std::printf("jitter %.2f px, S %d, Dice %.4f, crack recall %.4f, sigma %.2f\n", done.jitter, *S, dice, recall,
                done.sigma);
    EXPECT_NEAR(done.sigma, 12.0, 1.0);
    EXPECT_GE(dice, 0.984);
    EXPECT_GE(recall, 0.965);
}

}  // namespace
}  // namespace craze::images
