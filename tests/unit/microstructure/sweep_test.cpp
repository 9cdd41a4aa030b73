#include "craze/microstructure/sweep.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/microstructure/figures.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

namespace craze::microstructure {
namespace {

Mask drawn(Shape s, const std::function<bool(std::int64_t, std::int64_t, std::int64_t)>& inside)
{
    Mask mask(s);
    for (std::int64_t z = 0; z < s.nz; ++z)
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x) mask.set(x, y, z, inside(x, y, z));
    return mask;
}

bool in_ball(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t a, std::int64_t b, std::int64_t c,
             std::int64_t r)
{
    return (x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c) <= r * r;
}

Settings up_to(double most)
{
    set_verbosity(Verbosity::quiet);
    Settings settings;
    settings.sweep.most = most;
    return settings;
}

TEST(Sweep, ProposesTheSmallestBallThatNoSheetHolds)
{
    // Two balls and a sheet of 5 voxels, which holds the ball of 2.5 px but not that of 3.5 px.
    const Mask matter = complement(drawn({80, 80, 70}, [](auto x, auto y, auto z) {
        return in_ball(x, y, z, 20, 22, 22, 13) || in_ball(x, y, z, 56, 54, 20, 12) ||
               (z >= 50 && z < 55 && x > 5 && x < 75);
    }));
    for (const int threads : {1, 2}) {
        set_threads(threads);
        const Sweep sweep = swept(matter, up_to(6.5));
        ASSERT_EQ(sweep.closing.size(), 6U);
        EXPECT_EQ(sweep.R_C, 3.5);
        EXPECT_GT(sweep.closing[1].thin_share, 0.3);
        EXPECT_EQ(sweep.closing[2].thin_share, 0.0);
        for (const SweepRow& row : sweep.erosion) EXPECT_EQ(row.R_C, 3.5);
    }
    set_threads(0);
}

TEST(Sweep, ProposesTheSmallestErosionThatLeavesNoShells)
{
    // A cube, whose edges lie (sqrt 2 - 1) R_C = 3.5 px and corners (sqrt 3 - 1) R_C = 6.2 px beyond what the ball of
    // 8.5 px reaches; and a sheet of 15 voxels that does not hold that ball.
    const Mask matter = complement(drawn({120, 60, 70}, [](auto x, auto y, auto z) {
        const bool cube = x >= 40 && x < 70 && y >= 14 && y < 44 && z >= 5 && z < 35;
        return cube || (z >= 48 && z < 63 && x >= 4 && x < 116);
    }));
    Settings settings = up_to(8.5);
    settings.sweep.least = 6.5;
    EXPECT_EQ(swept(matter, settings).R_C, 8.5);
    settings.sweep.least = 0.5;
    settings.sweep.step = 2.0;
    const Sweep sweep = swept(matter, settings);
    EXPECT_EQ(sweep.R_C, 8.5);
    EXPECT_EQ(sweep.R_E, 6.5);
    EXPECT_GT(sweep.erosion[1].shell_share, 1e-3);  // 2.5 px: edges are left
    EXPECT_GT(sweep.erosion[2].shell_share, 5e-4);  // 4.5 px: corners
    EXPECT_EQ(sweep.erosion[3].shell_share, 0.0);
}

TEST(Sweep, WritesTablesAndPictures)
{
    const Mask matter =
        complement(drawn({40, 40, 30}, [](auto x, auto y, auto z) { return in_ball(x, y, z, 20, 20, 15, 9); }));
    const auto folder = std::filesystem::temp_directory_path() / ("craze_sweep_" + std::to_string(getpid()));
    const Settings settings = up_to(4.5);
    const images::Gray gray{Volume<std::uint8_t>({40, 40, 30}, 120), 1e-8};
    const Sweep sweep = swept(matter, settings);
    save(sweep, gray, matter, settings, folder);
    for (const char* name : {"sweep_R_C.csv", "sweep_R_E.csv"}) EXPECT_TRUE(std::filesystem::exists(folder / name));
    // Five tiles of 40 px in a row.
    const io::Picture picture = io::read_png(folder / "sweep_R_C.png");
    EXPECT_EQ(picture.width, 5 * 46 + 6);
    EXPECT_EQ(picture.channels, 3);
    EXPECT_EQ(summary(sweep)["closing"].size(), 4U);
    EXPECT_THROW(swept(complement(Mask({9, 9, 9})), settings), InvalidInput);
    std::filesystem::remove_all(folder);
}

TEST(Figures, ShowPoresBlueAndCracksRed)
{
    const Volume<std::uint8_t> gray({1000, 20, 3}, 100);
    const Mask pore = drawn({1000, 20, 3}, [](auto x, auto, auto) { return x < 100; });
    const Mask crack = drawn({1000, 20, 3}, [](auto x, auto, auto) { return x >= 900; });
    const io::Picture picture = phases_over_gray(gray, pore, crack, 1, 500);
    EXPECT_EQ(picture.width, 500);
    EXPECT_EQ(picture.height, 10);
    EXPECT_EQ(picture.at(10, 5)[2], 255);
    EXPECT_EQ(picture.at(10, 5)[0], 50);
    EXPECT_EQ(picture.at(490, 5)[0], 255);
    EXPECT_EQ(picture.at(250, 5)[1], 100);
}

}  // namespace
}  // namespace craze::microstructure
