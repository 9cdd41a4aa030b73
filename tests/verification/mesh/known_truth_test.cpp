// The volume of known truth: its crack skeleton was counted by independent programs (scikit-image).

#include "craze/core/progress.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/mesh/skeleton.hpp"
#include "craze/microstructure/classification.hpp"
#include "craze/microstructure/threshold.hpp"
#include "support/data.hpp"
#include "support/topology.hpp"

#include <gtest/gtest.h>

namespace craze::mesh {
namespace {

struct KnownTruth : testing::Test {
    std::filesystem::path folder = support::data_folder() / "known_truth";
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    Mask cracks() const
    {
        const auto truth = io::read_volume<std::uint8_t>(folder / "truth_matter_255.tif");
        return microstructure::classified(microstructure::matter_of(truth, 128), 8.5, 4.5).crack;
    }
};

TEST_F(KnownTruth, SkeletonOfTheSlicesHasTheKnownPixelsAndKeepsTheTopologyOfEachSlice)
{
    CRAZE_NEEDS_DATA(folder);
    const Mask crack = cracks();
    const Mask thin = skeleton_of_slices(crack, 2);
    EXPECT_NEAR(static_cast<double>(thin.count()), 231'740.0, 2'317.0);
    for (std::int64_t z = 0; z < crack.shape().nz; ++z) {
        for (const bool set : {true, false})
            ASSERT_EQ(support::components_of_slice(thin, z, set, set), support::components_of_slice(crack, z, set, set))
                << "slice " << z;
        ASSERT_EQ(support::euler_number_of_slice(thin, z), support::euler_number_of_slice(crack, z)) << "slice " << z;
    }
}

TEST_F(KnownTruth, BothSkeletonsFindTheSameCracks)
{
    CRAZE_NEEDS_DATA(folder);
    const Mask crack = cracks();
    Settings settings;
    const CrackMeasures slices = measure(mesh_cracks(crack, 1e-6, settings), crack, 1e-6);
    settings.skeleton = SkeletonKind::medial_surface;
    const CrackMeasures space = measure(mesh_cracks(crack, 1e-6, settings), crack, 1e-6);
    EXPECT_TRUE(slices.quality.clean());
    EXPECT_TRUE(space.quality.clean());
    // Sheets near the plane of the slices are lost by the slices.
    EXPECT_GT(space.area, slices.area);
    EXPECT_LT(space.area, 1.35 * slices.area);
    EXPECT_NEAR(space.openings.quantiles[1] / slices.openings.quantiles[1], 1.0, 0.15);
    // Rims recede, and slivers beside pores have no sheet: area times opening is most of the crack volume, not all.
    const double share = space.area * space.openings.mean / (static_cast<double>(crack.count()) * 1e-18);
    EXPECT_GT(share, 0.65);
    EXPECT_LT(share, 1.02);
}

}  // namespace
}  // namespace craze::mesh
