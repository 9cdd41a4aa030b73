#include "craze/images/images.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/images/resample.hpp"
#include "craze/io/volume_file.hpp"
#include "support/command.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>

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

// Runs in a process of its own until its journal says that a slab is filtered, then asks it to stop as Ctrl-C does.
int stopped_after_a_slab(const Settings& s, const std::filesystem::path& folder)
{
    const pid_t child = fork();
    if (child == 0) {
        int code = 0;
        try {
            catch_interrupts();
            set_threads(1);
            preprocess(s, folder);
        } catch (const Interrupted&) {
            code = 130;
        } catch (...) {
            code = 1;
        }
        _exit(code);
    }
    const auto journal = folder / "work" / "journal.json";
    for (int wait = 0; wait < 300'000; ++wait) {
        if (std::filesystem::exists(journal) && support::content_of(journal).find("denoised") != std::string::npos)
            break;
        if (waitpid(child, nullptr, WNOHANG) == child) return -1;
        usleep(200);
    }
    kill(child, SIGINT);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
}

TEST_F(Preprocess, GoesOnAfterItsLastFinishedSlabWhenInterrupted)
{
    Settings s = small_settings(folder / "raw.tif");
    s.denoise.search = 11;
    s.homogenise.on = false;
    s.memory = 3e6;  // a few slices at a time
    set_threads(1);
    ASSERT_EQ(stopped_after_a_slab(s, folder / "out"), 130);
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "gray.mhd"));
    const Json said = Json::parse(support::content_of(folder / "out" / "work" / "journal.json"));
    const auto done = said["entries"]["denoised"].get<std::int64_t>();
    ASSERT_GT(done, 0);
    ASSERT_LT(done, 40);

    // A mark left in a finished slice is still there in the end: that slab was not filtered again.
    std::filesystem::copy(folder / "out", folder / "marked", std::filesystem::copy_options::recursive);
    {
        std::fstream file(folder / "marked" / "work" / "denoised.raw", std::ios::in | std::ios::out | std::ios::binary);
        file << std::string(100, '\x07');
    }
    preprocess(s, folder / "marked");
    const Gray marked = load_gray(folder / "marked");
    EXPECT_EQ(std::ranges::count(marked.level.values().first(100), 7), 100);

    preprocess(s, folder / "out");
    preprocess(s, folder / "whole");
    const Gray resumed = load_gray(folder / "out"), whole = load_gray(folder / "whole");
    EXPECT_TRUE(std::ranges::equal(resumed.level.values(), whole.level.values()));
    EXPECT_TRUE(std::ranges::equal(marked.level.values().subspan(100), whole.level.values().subspan(100)));
    EXPECT_EQ(support::content_of(folder / "out" / "transforms.csv"),
              support::content_of(folder / "whole" / "transforms.csv"));
}

TEST_F(Preprocess, MakesCubesOfUnequalVoxels)
{
    Settings s = small_settings(folder / "raw.tif");
    s.alignment.on = false;
    s.stripes.method = Stripes::Method::none;
    s.denoise.method = Denoise::Method::none;
    s.homogenise.on = false;
    s.voxel_size = {10e-9, 10e-9, 25e-9};
    const auto done = preprocess(s, folder / "out");
    EXPECT_EQ(done.voxel_size, 10e-9);
    EXPECT_TRUE((done.shape == Shape{70, 60, 100}));
    EXPECT_EQ(load_gray(folder / "out").voxel_size, 10e-9);
}

TEST_F(Preprocess, WindowsSixteenBitsByValuesAndByPercentiles)
{
    // 1000 levels from 20000 on, every one as often as the others.
    Volume<std::uint16_t> v({100, 50, 2});
    for (std::size_t i = 0; i < v.values().size(); ++i) v.values()[i] = static_cast<std::uint16_t>(20000 + i % 1000);
    io::write_volume(folder / "deep.tif", v);
    Settings s = small_settings(folder / "deep.tif");
    s.alignment.on = false;
    s.stripes.method = Stripes::Method::none;
    s.denoise.method = Denoise::Method::none;
    s.homogenise.on = false;
    s.window.method = Window::Method::values;
    s.window.low = 20100, s.window.high = 20610;
    preprocess(s, folder / "values");
    const auto stated = load_gray(folder / "values").level;
    for (std::size_t i = 0; i < 1000; ++i) {
        const double level = std::clamp((static_cast<double>(i) - 100.0) / 2.0, 0.0, 255.0);
        ASSERT_NEAR(stated.values()[i], level, 0.51) << i;
    }
    s.window.method = Window::Method::percentiles;
    s.window.low_percent = 10, s.window.high_percent = 90;
    const auto done = preprocess(s, folder / "percentiles");
    EXPECT_NEAR(done.low, 20100, 2);
    EXPECT_NEAR(done.high, 20900, 2);
    s.window.method = Window::Method::as_is;
    preprocess(s, folder / "as_is");
    EXPECT_NEAR(load_gray(folder / "as_is").level.values()[0], 20000.0 / 65535 * 255, 0.51);
}

// A plane wave with steps between slices: cubic interpolation keeps what a straight line and a parabola say.
TEST(CubicVoxels, KeepARampAndAWaveInSpace)
{
    const Shape shape{24, 20, 16};
    const auto level = [](double x, double y, double z) {
        return 60.0 + 2.0 * x + 1.5 * y + 40.0 * std::sin(0.15 * z);  // x, y, z in units of the shortest edge
    };
    const Vec3 edge{1e-8, 2e-8, 3e-8};
    CubicVoxels cubes(shape, edge, [&](std::int64_t z, std::span<std::uint8_t> to) {
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x)
                to[static_cast<std::size_t>(x + shape.nx * y)] = static_cast<std::uint8_t>(
                    std::lround(level(static_cast<double>(x) + 0.5, 2.0 * (static_cast<double>(y) + 0.5),
                                      3.0 * (static_cast<double>(z) + 0.5))));
    });
    ASSERT_TRUE(cubes.needed());
    ASSERT_TRUE((cubes.shape() == Shape{24, 40, 48}));
    EXPECT_EQ(cubes.edge(), 1e-8);
    std::vector<std::uint8_t> slice(24 * 40);
    double worst = 0.0;
    for (std::int64_t z = 0; z < 48; ++z) {
        cubes.read(z, slice);
        if (z < 6 || z >= 42) continue;
        for (std::int64_t y = 4; y < 36; ++y)
            for (std::int64_t x = 0; x < 24; ++x)
                worst = std::max(worst, std::abs(slice[static_cast<std::size_t>(x + 24 * y)] -
                                                 level(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5,
                                                       static_cast<double>(z) + 0.5)));
    }
    EXPECT_LE(worst, 1.6);
}

}  // namespace
}  // namespace craze::images
