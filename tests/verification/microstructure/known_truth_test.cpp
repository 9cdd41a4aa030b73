// The volume of known truth, whose answers were computed by independent programs (SciPy, ITK, scikit-image, ImageJ).

#include "craze/io/volume_file.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/microstructure.hpp"
#include "craze/microstructure/porosity.hpp"
#include "craze/microstructure/threshold.hpp"
#include "support/data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::microstructure {
namespace {

struct KnownTruth : testing::Test {
    std::filesystem::path folder = support::data_folder() / "known_truth";
    Mask matter() const { return matter_of(io::read_volume<std::uint8_t>(folder / "truth_matter_255.tif"), 128); }
};

TEST_F(KnownTruth, ThresholdsOfTheRawStack)
{
    CRAZE_NEEDS_DATA(folder);
    const Histogram h = histogram(io::read_volume<std::uint8_t>(folder / "stack.tif"));
    EXPECT_EQ(otsu_threshold(h), 110 + 1);
    EXPECT_EQ(entropy_threshold(h), 133 + 1);
    EXPECT_EQ(moments_threshold(h), 139 + 1);
    const auto two = preserving_moments(h).value();
    EXPECT_NEAR(two.z0, 63.115, 5e-4);
    EXPECT_NEAR(two.z1, 167.326, 5e-4);
    EXPECT_NEAR(two.p0, 0.124537, 5e-7);
}

TEST_F(KnownTruth, PoresAndCracks)
{
    CRAZE_NEEDS_DATA(folder);
    const Mask solid = matter();
    EXPECT_NEAR(porosity(complement(solid)), 0.088851, 5e-7);
    const Classification c = classified(solid, 8.5, 4.5);
    EXPECT_NEAR(porosity(c.closed), 0.049557, 5e-7);
    EXPECT_NEAR(porosity(c.pore), 0.054088, 5e-7);
    EXPECT_NEAR(porosity(c.crack), 0.034763, 5e-7);
    EXPECT_EQ(c.crack.count(), 583'231);
    EXPECT_EQ(components(complement(solid)).count, 74);
    EXPECT_EQ(components(c.pore).count, 76);
    EXPECT_EQ(components(c.pore, Connectivity::faces).count, 492);
}

TEST_F(KnownTruth, LargestDistanceToMatter)
{
    CRAZE_NEEDS_DATA(folder);
    const auto squared = squared_distance(matter());
    const auto values = squared.values();
    EXPECT_NEAR(std::sqrt(*std::max_element(values.begin(), values.end())), 22.737634, 5e-7);
}

}  // namespace
}  // namespace craze::microstructure
