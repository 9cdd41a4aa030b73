#include "craze/report/colour_bar.hpp"
#include "craze/core/errors.hpp"

#include <gtest/gtest.h>

namespace craze::report {
namespace {

io::Picture plain(std::int64_t width, std::int64_t height) { return {width, height, 3, 200}; }

Colour at(const io::Picture& p, std::int64_t x, std::int64_t y)
{
    return {p.at(x, y)[0], p.at(x, y)[1], p.at(x, y)[2]};
}

std::int64_t dark(const io::Picture& p)
{
    std::int64_t count = 0;
    for (std::int64_t y = 0; y < p.height; ++y)
        for (std::int64_t x = 0; x < p.width; ++x) count += p.at(x, y)[0] < 100;
    return count;
}

TEST(ColourBar, StandsBesideAPictureThatItLeavesAsItWas)
{
    const auto seen = with_colour_bar(plain(500, 750), {-10.0, 20.0, "u_x [nm]"});
    EXPECT_EQ(seen.width, 700);
    for (std::int64_t y = 0; y < 750; ++y)
        for (std::int64_t x = 0; x < 500; ++x) ASSERT_EQ(at(seen, x, y), (Colour{200, 200, 200}));
}

TEST(ColourBar, RunsFromTheLeastColourBelowToTheGreatestAbove)
{
    const auto seen = with_colour_bar(plain(500, 750), {0.0, 1.0, ""});
    const auto near = [](Colour a, Colour b) {
        return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 12;
    };
    EXPECT_TRUE(near(at(seen, 535, 689), viridis(0.0)));
    EXPECT_TRUE(near(at(seen, 535, 400), viridis(0.5)));
    EXPECT_TRUE(near(at(seen, 535, 110), viridis(1.0)));
}

TEST(ColourBar, WritesATickForEachRoundValue)
{
    // Ticks are 8 px of ink right of the bar: -10, 0, 10, 20 on a bar of 580 px from y = 690 up.
    const auto seen = with_colour_bar(plain(500, 750), {-10.0, 20.0, ""});
    for (const double value : {-10.0, -5.0, 0.0, 5.0, 10.0, 15.0, 20.0}) {
        const auto y = static_cast<std::int64_t>(690.0 - 580.0 * (value + 10.0) / 30.0);
        EXPECT_LT(std::min(seen.at(554, y - 1)[0], seen.at(554, y)[0]), 160) << value;
    }
    EXPECT_GT(seen.at(554, 660)[0], 250) << "nothing between them";
}

TEST(ColourBar, EverySignOfAUnitLeavesInkAndABlankNone)
{
    for (const char c : std::string_view("0123456789-.%[]_nmuxyz")) {
        auto p = plain(60, 60);
        write_text(p, 10.0, 10.0, 30.0, std::string_view(&c, 1), {0, 0, 0});
        EXPECT_GT(dark(p), 10) << c;
    }
    auto p = plain(60, 60);
    write_text(p, 10.0, 10.0, 30.0, " ?", {0, 0, 0});
    EXPECT_EQ(dark(p), 0);
}

TEST(ColourBar, WritesWithinThePictureOnly)
{
    auto p = plain(20, 20);
    write_text(p, -10.0, -10.0, 60.0, "888", {0, 0, 0});
    EXPECT_GT(dark(p), 0);
}

TEST(ColourBar, RefusesAGrayPictureAndValuesThatDoNotRise)
{
    EXPECT_THROW(with_colour_bar(io::Picture(10, 10, 1), {0.0, 1.0, ""}), InvalidInput);
    EXPECT_THROW(with_colour_bar(plain(10, 10), {1.0, 1.0, ""}), InvalidInput);
}

}  // namespace
}  // namespace craze::report
