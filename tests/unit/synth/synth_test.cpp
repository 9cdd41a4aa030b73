#include "craze/synth/synth.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"

#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::synth {
namespace {

Settings small()
{
    Settings s;
    s.shape = {96, 80, 64};
    s.voxel_size = 50e-9;
    return s;
}

TEST(Coating, MeetsTheRecipesPorosityAndDensity)
{
    const Settings s = small();
    const Coating coating = make_coating(s);
    EXPECT_NEAR(porosity(coating, s.voxel_size).cracks, s.cracks[0].porosity + s.cracks[1].porosity, 0.0006);
    EXPECT_NEAR(porosity(coating, s.voxel_size).pores, s.pores[0].porosity + s.pores[1].porosity, 0.0006);
    for (std::size_t p = 0; p < s.cracks.size(); ++p) {
        double cubes = 0.0;
        for (const auto& crack : coating.cracks) {
            const Vec3 c = crack.centre, size = coating.size;
            const bool in = c.x >= 0 && c.x <= size.x && c.y >= 0 && c.y <= size.y && c.z >= 0 && c.z <= size.z;
            if (in && crack.population == static_cast<int>(p)) cubes += std::pow(crack.a * crack.b, 1.5);
        }
        const double box = coating.size.x * coating.size.y * coating.size.z;
        EXPECT_NEAR(cubes / box, s.cracks[p].density, 1e-9);
    }
}

TEST(Coating, KeepsItsPoresApart)
{
    const Settings s = small();
    const Coating coating = make_coating(s);
    for (std::size_t i = 0; i < coating.pores.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (const auto& lobe : coating.pores[i].lobes) EXPECT_FALSE(contains(coating.pores[j], lobe.centre));
}

TEST(Coating, OfAnotherSeedIsAnother)
{
    Settings s = small();
    const Coating one = make_coating(s), again = make_coating(s);
    s.seed = 2;
    const Coating other = make_coating(s);
    ASSERT_EQ(one.cracks.size(), again.cracks.size());
    for (std::size_t i = 0; i < one.cracks.size(); ++i) EXPECT_EQ(one.cracks[i].centre, again.cracks[i].centre);
    EXPECT_NE(one.cracks[0].centre, other.cracks[0].centre);
}

TEST(Coating, WithoutRoomIsRefusedAndNamesThePopulation)
{
    Settings s = small();
    s.cracks.clear();
    s.pores = {{.name = "blobs", .porosity = 0.45, .gap = 1e-6}};
    try {
        make_coating(s);
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("blobs"), std::string::npos);
    }
}

TEST(CoatingSettings, ThatContradictThemselvesAreRefused)
{
    const auto refused = [](auto change) {
        Settings s = small();
        change(s);
        EXPECT_THROW(check(s), InvalidInput);
    };
    EXPECT_NO_THROW(check(small()));
    refused([](Settings& s) { s.shape = {10, 10}; });
    refused([](Settings& s) { s.shape = {20000, 20000, 20000}; });
    refused([](Settings& s) { s.voxel_size = std::nan(""); });
    refused([](Settings& s) { s.pores[0].count = 3; });
    refused([](Settings& s) { s.pores[0].porosity = 0; });
    refused([](Settings& s) { s.cracks[0].count = 5; });
    refused([](Settings& s) { s.cracks[0].density = s.cracks[0].porosity = 0; });
    refused([](Settings& s) { s.cracks[0].normals = {0, 0, 0}; });
    refused([](Settings& s) { s.cracks[0].radius.least = 1; });
    refused([](Settings& s) { s.pores.clear(), s.cracks[0].at_pores = 0.5; });
}

TEST(Observation, HasTheSameBitsOnAnyNumberOfThreads)
{
    Settings s = small();
    s.microscope.drift = 0.3;
    s.microscope.thickness_jitter = 0.05;
    set_threads(1);
    const Observation one = observe(make_coating(s), s);
    set_threads(2);
    const Observation two = observe(make_coating(s), s);
    set_threads(0);
    EXPECT_TRUE(std::ranges::equal(one.stack.level.values(), two.stack.level.values()));
    EXPECT_TRUE(std::ranges::equal(one.label.values(), two.label.values()));
    EXPECT_EQ(one.fraction.total, two.fraction.total);
}

TEST(Observation, CountsLabelsLikeVoidShares)
{
    const Settings s = small();
    const Observation seen = observe(make_coating(s), s);
    EXPECT_NEAR(seen.voxels.pores / seen.fraction.pores, 1.0, 0.02);
    EXPECT_LT(seen.voxels.cracks, seen.fraction.cracks);  // half-full voxels only: thin cracks fall through
    std::int64_t voids = 0;
    for (const auto label : seen.label.values()) voids += label != 255;
    EXPECT_NEAR(static_cast<double>(voids) / static_cast<double>(seen.label.shape().voxels()), seen.voxels.total,
                1e-12);
}

TEST(Microscope, WithoutFaultsShowsTheVoidShare)
{
    Settings s = small();
    s.microscope = {.blur = 0, .noise = 0, .stripes = 0, .shading_y = 0};
    const Observation seen = observe(make_coating(s), s);
    double sum = 0.0;
    for (const auto level : seen.stack.level.values()) sum += level;
    const double mean = sum / static_cast<double>(seen.stack.level.shape().voxels());
    EXPECT_NEAR((165.0 - mean) / 120.0, seen.fraction.total, 0.0005);
}

TEST(Microscope, HasTheNoiseTheStripesAndTheShadingItIsSetTo)
{
    Settings s = small();
    s.pores.clear();
    s.cracks.clear();
    s.microscope = {.blur = 0.7, .noise = 12, .stripes = 5, .shading_x = 20, .shading_y = 0};
    const Observation seen = observe(make_coating(s), s);
    const Shape n = seen.stack.level.shape();
    double stripe2 = 0.0, within2 = 0.0, left = 0.0, right = 0.0;
    for (std::int64_t z = 0; z < n.nz; ++z)
        for (std::int64_t y = 0; y < n.ny; ++y) {
            double mean = 0.0;
            for (const auto v : seen.stack.level.row(y, z)) mean += v;
            mean /= static_cast<double>(n.nx);
            stripe2 += (mean - 165.0) * (mean - 165.0);
            for (std::int64_t x = 0; x < n.nx; ++x) {
                const double slope = 20.0 * (static_cast<double>(x) / static_cast<double>(n.nx - 1) - 0.5);
                const double rest = seen.stack.level(x, y, z) - mean - slope;
                within2 += rest * rest;
            }
            left += seen.stack.level(0, y, z), right += seen.stack.level(n.nx - 1, y, z);
        }
    const auto rows = static_cast<double>(n.ny * n.nz);
    EXPECT_NEAR(std::sqrt(stripe2 / rows), std::sqrt(25.0 + 144.0 / static_cast<double>(n.nx)), 0.25);
    EXPECT_NEAR(std::sqrt(within2 / static_cast<double>(n.voxels())), 12.0, 0.15);
    EXPECT_NEAR((right - left) / rows, 20.0, 1.0);
}

TEST(Microscope, DriftsAndErrsInDepthAsSetAndComesBack)
{
    Microscope m;
    m.drift = 0.5;
    m.thickness_jitter = 0.1;
    const auto positions = slice_positions(m, 2000, 3);
    EXPECT_EQ(positions.front(), (Vec3{0, 0, 0}));
    EXPECT_NEAR(norm(positions.back() - Vec3{0, 0, 1999}), 0.0, 1e-9);
    double step2 = 0.0, thickness2 = 0.0;
    for (std::size_t k = 1; k < positions.size(); ++k) {
        step2 += std::pow(positions[k].x - positions[k - 1].x, 2);
        thickness2 += std::pow(positions[k].z - positions[k - 1].z - 1.0, 2);
    }
    EXPECT_NEAR(std::sqrt(step2 / 1999), 0.5, 0.03);
    EXPECT_NEAR(std::sqrt(thickness2 / 1999), 0.1, 0.006);
}

TEST(Saved, CoatingIsReadBackWithItsTruthBeside)
{
    const Settings s = small();
    const Coating coating = make_coating(s);
    const Observation seen = observe(coating, s);
    const auto folder = std::filesystem::path(testing::TempDir()) / "craze_synth_saved";
    std::filesystem::remove_all(folder);
    save(coating, seen, s, folder);
    const auto stack = io::read_volume<std::uint8_t>(folder / "stack.tif");
    EXPECT_TRUE(std::ranges::equal(stack.values(), seen.stack.level.values()));
    const auto label = io::read_volume<std::uint8_t>(folder / "truth.mhd");
    EXPECT_TRUE(std::ranges::equal(label.values(), seen.label.values()));
    const Json truth = Json::parse(io::read_text(folder / "truth.json"));
    EXPECT_EQ(truth["true_porosity"]["total"], seen.fraction.total);
    EXPECT_EQ(truth["cracks"], coating.cracks.size());
    const std::string table = io::read_text(folder / "defects.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(table, '\n')),
              1 + coating.cracks.size() + coating.pores.size());
    EXPECT_EQ(io::read_text(folder / "cracks.ply").substr(0, 4), "ply\n");
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace craze::synth
