#include "craze/images/images.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/io/volume_file.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::images {
namespace {

using support::TemporaryFolder;

// Bright, noisy, with dark balls, a shading along z and stripes along x.
Volume<std::uint8_t> raw_stack(Shape shape)
{
    Volume<std::uint8_t> v(shape);
    for (std::int64_t z = 0; z < shape.nz; ++z)
        for (std::int64_t y = 0; y < shape.ny; ++y) {
            Random stripe(1, static_cast<std::uint64_t>(y + shape.ny * z));
            const double offset = 4.0 * stripe.normal() + 0.3 * static_cast<double>(z);
            for (std::int64_t x = 0; x < shape.nx; ++x) {
                const auto cell = [](std::int64_t i) { return static_cast<double>(i % 24) - 12.0; };
                const double r = std::hypot(cell(x), cell(y), cell(z));
                const double level = (r < 6.0 ? 45.0 : 165.0) + offset + 8.0 * stripe.normal();
                v(x, y, z) = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
            }
        }
    return v;
}

Settings small_settings(const std::filesystem::path& source)
{
    Settings s;
    s.source = source.string();
    s.voxel_size = {23.6e-9};
    s.denoise.search = 7;
    s.homogenise.by = Homogenise::By::solid;
    return s;
}

class Preprocess : public testing::Test {
protected:
    void SetUp() override
    {
        set_verbosity(Verbosity::quiet);
        io::write_volume(folder / "raw.tif", raw_stack({70, 60, 40}));
    }
    void TearDown() override { set_threads(0); }
    TemporaryFolder folder;
};

TEST_F(Preprocess, GivesTheSameBitsForAnyThreadsAndMemory)
{
    Settings s = small_settings(folder / "raw.tif");
    set_threads(1);
    preprocess(s, folder / "a");
    set_threads(2);
    s.memory = 1e7;
    const auto done = preprocess(s, folder / "b");
    const Gray a = load_gray(folder / "a"), b = load_gray(folder / "b");
    EXPECT_EQ(a.voxel_size, 23.6e-9);
    EXPECT_TRUE(a.level.shape() == done.shape);
    EXPECT_TRUE(std::ranges::equal(a.level.values(), b.level.values()));
}

TEST_F(Preprocess, LowersNoiseStripesAndShading)
{
    const auto done = preprocess(small_settings(folder / "raw.tif"), folder / "out");
    const Quality &before = done.quality.front(), &after = done.quality.back();
    EXPECT_NEAR(before.noise, 8.0, 2.0);
    EXPECT_LT(after.noise, 0.2 * before.noise);
    EXPECT_LT(after.stripes, 0.2 * before.stripes);
    EXPECT_NEAR(before.gradient.z, 0.3, 0.05);
    EXPECT_LT(std::abs(after.gradient.z), 0.02);
    for (const char* name :
         {"gray.mhd", "gray.raw", "transforms.csv", "spectrum.csv", "profile.csv", "strip_1_raw.png"})
        EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "work"));
    EXPECT_EQ(summary(done)["shape"][2], 40);
}

TEST_F(Preprocess, WithEveryStepOffGivesTheStackItself)
{
    Settings s = small_settings(folder / "raw.tif");
    s.alignment.on = false;
    s.stripes.method = Stripes::Method::none;
    s.denoise.method = Denoise::Method::none;
    s.homogenise.on = false;
    preprocess(s, folder / "out");
    EXPECT_TRUE(std::ranges::equal(load_gray(folder / "out").level.values(), raw_stack({70, 60, 40}).values()));
}

}  // namespace
}  // namespace craze::images
