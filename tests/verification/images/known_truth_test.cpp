// The whole chain on a coating whose truth is known: stripes, a gradient and noise go, thin cracks stay.

#include "craze/core/progress.hpp"
#include "craze/images/images.hpp"
#include "craze/images/non_local_means.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/microstructure/classification.hpp"
#include "craze/microstructure/threshold.hpp"
#include "support/data.hpp"
#include "support/speed.hpp"
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

// How the reference figures of this coating were found, 0.984 and 0.989: non-local means alone on 72^3 voxels, where
// Otsu on the raw levels gave 0.970 and 0.963. From crop to crop they scatter by more than a hundredth; this one starts
// from 0.978 and 0.968.
TEST(NonLocalMeans, AloneReachTheReferenceOnACropOfTheKnownCoating)
{
    const auto data = support::data_folder() / "known_truth";
    CRAZE_NEEDS_DATA(data);
    CRAZE_NEEDS_SPEED;
    const auto stack = io::read_volume<std::uint8_t>(data / "stack.tif"),
               truth = io::read_volume<std::uint8_t>(data / "truth_matter_255.tif");
    const Shape shape{72, 72, 72};
    Volume<std::uint8_t> raw(shape);
    Mask matter(shape);
    for (std::int64_t z = 0; z < shape.nz; ++z)
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x)
                raw(x, y, z) = stack(x, y, z), matter.set(x, y, z, truth(x, y, z) != 0);
    const Mask voids = complement(matter), cracks = microstructure::classified(matter, 8.5, 4.5).crack;
    const auto judge = [&](const Volume<std::uint8_t>& level, std::optional<int> S) {
        const Mask seen = complement(microstructure::matter_of(level, S.value_or(0)));
        const double dice = 2.0 * static_cast<double>(intersection(voids, seen).count()) /
                            static_cast<double>(voids.count() + seen.count());
        const double recall =
            static_cast<double>(intersection(cracks, seen).count()) / static_cast<double>(cracks.count());
        std::printf("S %d, Dice %.4f, crack recall %.4f\n", S.value_or(0), dice, recall);
        return std::pair{dice, recall};
    };
    const auto before = judge(raw, microstructure::otsu_threshold(microstructure::histogram(raw)));
    const auto clean = non_local_means(raw, {21, 5, true, 12.0, 0.6 * 12.0});
    const auto after = judge(clean, microstructure::moments_threshold(microstructure::histogram(clean)));
    EXPECT_LT(before.second, 0.970);
    EXPECT_GE(after.first, 0.984);
    EXPECT_GE(after.second, 0.989);
}

}  // namespace
}  // namespace craze::images
