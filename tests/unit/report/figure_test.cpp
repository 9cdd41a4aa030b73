#include "craze/report/figure.hpp"
#include "craze/core/json.hpp"
#include "craze/report/output_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::report {
namespace {

const double gap = std::numeric_limits<double>::quiet_NaN();

Figure curves()
{
    Figure f;
    f.id = "curves";
    f.caption = "Stress & strain";
    f.x.title = "strain [%]";
    f.y.title = "stress [MPa], along x";
    f.series = {{"tension", {0, 1, 2}, {0, 10, 20}}, {"compression", {0, 1, 2}, {0, gap, 30}}};
    return f;
}

TEST(FigureCsv, OfSharedAbscissaeHasOneColumnPerSeriesAndReadsBack)
{
    const auto back = parse_csv(csv(curves()));
    EXPECT_EQ(back.names, (std::vector<std::string>{"strain [%]", "tension", "compression"}));
    EXPECT_EQ(back.numbers("tension"), (std::vector<double>{0, 10, 20}));
    EXPECT_TRUE(std::isnan(back.numbers("compression")[1]));
}

TEST(FigureCsv, OfOneSeriesIsHeadedByTheAxisWithItsUnitQuoted)
{
    auto f = curves();
    f.series.pop_back();
    EXPECT_EQ(csv(f).substr(0, csv(f).find('\n')), "strain [%],\"stress [MPa], along x\"");
}

TEST(FigureCsv, OfDifferentAbscissaeNamesTheSeriesOfEveryPoint)
{
    auto f = curves();
    f.series[1].x[2] = 3;
    const auto back = parse_csv(csv(f));
    EXPECT_EQ(back.names.front(), "series");
    EXPECT_EQ(back.rows(), 6U);
    EXPECT_EQ(back.words("series")[3], "compression");
}

TEST(FigureCsv, OfBarsGivesBothEdges)
{
    Figure f;
    f.x.title = "r";
    f.y.title = "count";
    f.series = {{"", {0, 1, 3}, {5, 7}, Mark::bars}};
    EXPECT_EQ(csv(f), "r from,r to,count\n0,1,5\n1,3,7\n");
}

TEST(FigureJson, HoldsNullsForGapsAndAColourPerSeries)
{
    const auto json = to_json(curves());
    EXPECT_TRUE(json["series"][1]["y"][1].is_null());
    EXPECT_NE(json["series"][0]["colour"], json["series"][1]["colour"]);
}

TEST(Svg, EscapesTitlesAndHoldsOnePathPerSeries)
{
    const auto drawing = svg(curves());
    EXPECT_NE(drawing.find("Stress &amp; strain"), std::string::npos);
    EXPECT_EQ(drawing.find("nan"), std::string::npos);
    for (int k = 0; k < 2; ++k) EXPECT_NE(drawing.find("stroke=\"" + palette(k) + "\""), std::string::npos);
}

TEST(Svg, OfDegenerateDataIsStillADrawing)
{
    Figure f = curves();
    for (auto& s : f.series) s.x = {1, 1, 1}, s.y = {4, 4, 4};
    f.y.log = true;
    EXPECT_EQ(svg(f).find("nan"), std::string::npos);
    EXPECT_EQ(svg(f).find("inf"), std::string::npos);
    for (auto& s : f.series) s.y = {-1, 0, gap};
    EXPECT_EQ(svg(f).find("nan"), std::string::npos);
    f.series.clear();
    EXPECT_TRUE(f.empty());
    EXPECT_EQ(svg(f).find("nan"), std::string::npos);
}

TEST(RoseSvg, PetalAreasAreTheShares)
{
    Rose rose;
    rose.share = {1, 4};
    rose.east = "x", rose.north = "y";
    const auto drawing = svg(rose);
    EXPECT_NE(drawing.find("A66.00 66.00"), std::string::npos)
        << "half the radius of the petal with four times the share";
    EXPECT_NE(drawing.find("A132.00 132.00"), std::string::npos);
    EXPECT_EQ(csv(rose), "direction [degree],share [%]\n0,20\n90,80\n");
}

TEST(ParseCsv, TakesQuotesCommentsShortLinesAndForeignLineEnds)
{
    const auto t = parse_csv("# craze\r\na,\"b, \"\"c\"\"\"\r\n1,x\r\n\r\n2\r\n");
    EXPECT_EQ(t.names, (std::vector<std::string>{"a", "b, \"c\""}));
    EXPECT_EQ(t.numbers("a"), (std::vector<double>{1, 2}));
    EXPECT_EQ(t.words("b, \"c\""), (std::vector<std::string>{"x", ""}));
    EXPECT_TRUE(t.numbers("none").empty());
    EXPECT_EQ(parse_csv("").rows(), 0U);
    EXPECT_EQ(parse_csv("# only a comment").rows(), 0U);
}

}  // namespace
}  // namespace craze::report
