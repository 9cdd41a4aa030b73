#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/report/domain_pictures.hpp"
#include "craze/report/report.hpp"
#include "craze/report/scene_data.hpp"
#include "craze/report/slices.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <filesystem>

namespace craze::report {
namespace {

namespace fs = std::filesystem;

io::Picture picture(std::int64_t w, std::int64_t h, std::vector<std::uint8_t> pixels)
{
    io::Picture p(w, h);
    p.pixels = std::move(pixels);
    return p;
}

TEST(Overlaid, TintsPoresAndCracksAndLeavesMatterGray)
{
    const auto gray = picture(3, 1, {100, 100, 100}), phase = picture(3, 1, {255, 0, 128});
    const auto full = overlaid(gray, phase, 1.0);
    EXPECT_EQ(full.pixels, (std::vector<std::uint8_t>{100, 100, 100, 0x56, 0xb4, 0xe9, 0xd5, 0x5e, 0x00}));
    EXPECT_EQ(overlaid(gray, phase, 0.0).pixels, std::vector<std::uint8_t>(9, 100));
}

TEST(AveragedDown, TakesMeansAlsoOfCutSquares)
{
    EXPECT_EQ(averaged_down(picture(3, 2, {0, 10, 200, 20, 30, 100}), 2).pixels, (std::vector<std::uint8_t>{15, 150}));
}

TEST(PhasesDown, KeepsTheThinnestCrackAndHalvesOfPores)
{
    const auto p = picture(6, 2, {255, 128, 0, 0, 255, 255, 255, 255, 255, 255, 0, 255});
    EXPECT_EQ(phases_down(p, 2).pixels, (std::vector<std::uint8_t>{128, 0, 255}));
}

TEST(ScaleBar, IsARoundLengthOfFifteenToFortyPerCent)
{
    for (double width = 1e-6; width < 1e-3; width *= 1.07) {
        const double bar = scale_bar_length(width);
        EXPECT_LE(bar, 0.4 * width * (1 + 1e-12));
        EXPECT_GE(bar, 0.15 * width);
    }
    EXPECT_NEAR(scale_bar_length(17.6e-6), 5e-6, 1e-12);
}

std::vector<std::byte> unpacked(const std::string& text, std::size_t size)
{
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<Bytef> bytes;
    for (std::size_t i = 0; i + 3 < text.size(); i += 4) {
        unsigned word = 0;
        for (std::size_t k = 0; k < 4; ++k)
            word = word << 6U | (text[i + k] == '=' ? 0U : static_cast<unsigned>(digits.find(text[i + k])));
        for (int k = 2; k >= 0; --k) bytes.push_back(static_cast<Bytef>(word >> (8 * k) & 255U));
    }
    std::vector<std::byte> out(size);
    uLongf length = static_cast<uLongf>(size);
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &length, bytes.data(), static_cast<uLong>(bytes.size())),
              Z_OK);
    EXPECT_EQ(length, size);
    return out;
}

TEST(Packed, HoldsTheBytesOfEqualWeightTogether)
{
    const std::vector<std::uint16_t> values{0x0102, 0x0304, 0xfffe};
    const auto bytes = unpacked(packed(values), 6);
    const std::vector<int> expected{0x02, 0x04, 0xfe, 0x01, 0x03, 0xff};
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(std::to_integer<int>(bytes[k]), expected[k]);
}

TEST(SheetPart, CornersComeBackFromTheirDifferences)
{
    mesh::CrackSurface s;
    s.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {2, 2, 2}};
    s.triangles = {{0, 1, 2}, {3, 1, 0}};
    const auto part = sheet_part("cracks", "#d55e00", s, 2.0);
    const auto bytes = unpacked(part["corners"].get<std::string>(), 24);
    std::int32_t corner = 0;
    std::vector<std::int32_t> back;
    for (std::size_t k = 0; k < 6; ++k) {
        std::uint32_t step = 0;
        for (std::size_t b = 0; b < 4; ++b) step |= std::to_integer<std::uint32_t>(bytes[b * 6 + k]) << (8 * b);
        back.push_back(corner += static_cast<std::int32_t>(step));
    }
    EXPECT_EQ(back, (std::vector<std::int32_t>{0, 1, 2, 3, 1, 0}));
    EXPECT_EQ(quantised(2.0, 2.0), 65535);
    EXPECT_EQ(quantised(-1.0, 2.0), 0);
    EXPECT_EQ(quantised(1.0, 2.0), 32768);
}

/// A row of balls along x, bonded to the next; bond k is cut where asked, elements in pores where asked.
domain::Discretisation row(std::int32_t n)
{
    domain::Discretisation d;
    d.dense.box = {static_cast<double>(n), 1.0, 1.0};
    d.dense.mean_radius = 0.5;
    for (std::int32_t e = 0; e < n; ++e) {
        d.dense.elements.x.push_back(e + 0.5), d.dense.elements.y.push_back(0.5), d.dense.elements.z.push_back(0.5);
        d.dense.elements.r.push_back(0.5);
        d.in_pore.push_back(0);
        if (e == 0) continue;
        d.dense.bonds.i.push_back(e - 1), d.dense.bonds.j.push_back(e);
        d.dense.bonds.kind.push_back(domain::BondKind::beam), d.dense.bonds.thickness.push_back(0.0);
        d.bonds.cut.push_back(0), d.bonds.T1.push_back(0.0), d.bonds.T2.push_back(0.0);
    }
    return d;
}

TEST(ThicknessFigure, CountsCutBondsWhoseEndsAreBothMatter)
{
    auto d = row(5);
    for (std::size_t b = 0; b < 4; ++b) d.bonds.cut[b] = 1, d.bonds.T1[b] = 50e-9, d.bonds.T2[b] = 22e-9;
    d.in_pore[4] = 1;  // takes the last bond
    const auto f = thickness_figure(d);
    ASSERT_EQ(f.series.size(), 2U);
    double sum = 0.0, at_22 = 0.0;
    for (std::size_t k = 0; k < f.series[0].y.size(); ++k) {
        sum += f.series[0].y[k];
        if (f.series[0].x[k] <= 22.0 && 22.0 < f.series[0].x[k + 1]) at_22 = f.series[0].y[k];
    }
    EXPECT_NEAR(sum, 100.0, 1e-9);
    EXPECT_NEAR(at_22, 100.0, 1e-9);
    EXPECT_NE(f.caption.find("3 contact beams"), std::string::npos);
    EXPECT_TRUE(thickness_figure(row(5)).empty());
}

TEST(VoxelSizeFigure, DrawsBothThicknessesAtEachVoxelSize)
{
    const auto one = [](double median, std::vector<int> counts) {
        return Json{{"median_m", median}, {"zero", 0}, {"counts", std::move(counts)}};
    };
    const Json study{{{"voxel_size_m", 23.6e-9},
                      {"cut_bonds", 4},
                      {"bar_m", 4e-9},
                      {"T1", one(9e-9, {0, 1, 3})},
                      {"T2", one(5e-9, {1, 3, 0})}},
                     {{"voxel_size_m", 47.2e-9},
                      {"cut_bonds", 2},
                      {"bar_m", 4e-9},
                      {"T1", one(11e-9, {0, 0, 2})},
                      {"T2", one(5e-9, {0, 2, 0})}}};
    const auto f = voxel_size_figure(study);
    ASSERT_EQ(f.series.size(), 4U);
    EXPECT_EQ(f.series[0].y, (std::vector<double>{25, 75, 0}));
    EXPECT_EQ(f.series[1].x, (std::vector<double>{2, 6, 10}));
    EXPECT_EQ(f.series[3].y, (std::vector<double>{0, 0, 100}));
    EXPECT_EQ(f.series[0].colour, f.series[1].colour);
    EXPECT_NE(f.caption.find("47.2 nm: 2 bonds cut, medians T2 5, T1 11 nm"), std::string::npos) << f.caption;
    EXPECT_TRUE(voxel_size_figure(Json::array()).empty());
    EXPECT_TRUE(voxel_size_figure(Json()).empty());
}

TEST(ShareShown, IsTheLargestBoxThatHoldsNoMoreThanAsked)
{
    const auto d = row(1000);
    EXPECT_DOUBLE_EQ(share_shown(d.dense, 1000), 1.0);
    const double share = share_shown(d.dense, 100);
    EXPECT_LE(1000.0 * share, 101.0);
    EXPECT_GE(1000.0 * share, 97.0);
}

class Folder : public testing::Test {
protected:
    void SetUp() override
    {
        out = fs::temp_directory_path() /
              ("craze_content_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(out);
        fs::create_directories(out);
        take_notices();
    }
    void TearDown() override { fs::remove_all(out); }
    void summary(const std::string& room, const std::string& json = "{}")
    {
        io::write_text(out / room / "summary.json", json);
    }
    std::string page()
    {
        Settings settings;
        settings.slices = 3, settings.render_width = 200;
        return io::read_text(write_report(out, settings));
    }

    fs::path out;
};

TEST_F(Folder, DamagedFilesOfEveryRoomAreSaidAndSurvived)
{
    for (const char* room : {"images", "microstructure", "mesh", "domain", "loading"}) {
        fs::create_directories(out / room);
        summary(room);
    }
    for (const char* file :
         {"images/gray.mhd", "microstructure/phase.mhd", "microstructure/histogram.csv", "microstructure/pores.csv",
          "mesh/cracks.ply", "domain/domain.vtkhdf", "loading/response.json"})
        io::write_text(out / file, "this is not what it should be\n\n,,,\n");
    const auto text = page();
    for (const char* id : {"images", "microstructure", "mesh", "domain", "loading", "run"})
        EXPECT_NE(text.find("<section id=\"" + std::string(id) + "\">"), std::string::npos) << id;
    EXPECT_GE(take_notices().size(), 3U);
    EXPECT_NE(text.find("cut short"), std::string::npos);
}

TEST_F(Folder, SlicesOfAStackAreInThePageWithAPictureForPrint)
{
    Volume<std::uint8_t> gray({40, 30, 20}, 200), phase({40, 30, 20}, 255);
    phase(5, 5, 10) = 128;
    fs::create_directories(out / "images");
    fs::create_directories(out / "microstructure");
    io::write_volume(out / "images" / "gray.mhd", gray, 1e-7);
    io::write_volume(out / "microstructure" / "phase.mhd", phase, 1e-7);
    summary("images");
    const auto text = page();
    EXPECT_NE(text.find("\"positions\":[3,10,16]"), std::string::npos);
    EXPECT_NE(text.find("bar: 1 um"), std::string::npos);
    const auto still = io::read_png(out / "report" / "figures" / "slices.png");
    EXPECT_EQ(still.width, 88) << "two panes of 40 and a gap of 8";
    const auto* crack = still.at(48 + 5, 5);
    EXPECT_GT(crack[0], crack[2] + 100);
}

TEST_F(Folder, TheRecordedStackIsShownWhereTheCleanedOneBegins)
{
    Volume<std::uint8_t> raw({20, 16, 8}, 10);
    raw(3 + 4, 2 + 5, 4) = 250;  // voxel (4, 5, 4) of the cleaned stack
    fs::create_directories(out / "images");
    fs::create_directories(out / "synth");
    io::write_volume(out / "images" / "gray.mhd", Volume<std::uint8_t>({12, 12, 8}, 100), 0.0);
    io::write_volume(out / "synth" / "stack.tif", raw, 0.0);
    summary("images", R"({"alignment": {"common_crop": [3, 15, 2, 14]}})");
    page();
    EXPECT_TRUE(take_notices().empty());
    const auto still = io::read_png(out / "report" / "figures" / "slices.png");
    EXPECT_EQ(still.at(4, 5)[0], 250);
}

TEST_F(Folder, AStackOfAnotherShapeIsLeftOutWithANotice)
{
    fs::create_directories(out / "images");
    fs::create_directories(out / "microstructure");
    io::write_volume(out / "images" / "gray.mhd", Volume<std::uint8_t>({8, 8, 8}, 200), 1e-7);
    io::write_volume(out / "microstructure" / "phase.mhd", Volume<std::uint8_t>({9, 8, 8}, 255), 1e-7);
    page();
    const auto notices = take_notices();
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices[0].find("another shape"), std::string::npos);
}

TEST_F(Folder, HeadlineSetsTruthMeasureAndPaperSideBySide)
{
    for (const char* room : {"synth", "microstructure"}) fs::create_directories(out / room);
    summary("synth", R"({"true_porosity": {"total": 0.0871, "pores": 0.0577, "cracks": 0.0294}})");
    summary("microstructure", R"({"porosity": {"total": 0.0902, "pores": 0.0593, "cracks": 0.0309}})");
    const auto text = page();
    const auto row = text.substr(text.find("porosity, total"), 160);
    EXPECT_LT(row.find("9.02"), row.find("8.71"));
    EXPECT_LT(row.find("8.71"), row.find("8.83"));
    EXPECT_NE(row.find("8.83"), std::string::npos);
}

TEST_F(Folder, ReproductionMarksWhatMissesItsAimAndWhatWasFitted)
{
    fs::create_directories(out / "reproduce");
    io::write_text(out / "reproduce" / "reproduction.json", R"({"size": "small", "seeds": [1, 2, 3], "numbers": {
        "E.both.x": {"where": "Table 3", "what": "E along x", "unit": "GPa", "paper": 89, "goal": 0.1, "mean": 93, "deviation": 2, "fitted": true},
        "UTS": {"where": "Table 4", "what": "UTS", "unit": "MPa", "paper": 61, "goal": 0.15, "mean": 90, "deviation": 3, "fitted": false}}})");
    io::write_text(out / "reproduce" / "fig_21a.svg",
                   "<svg xmlns=\"http://www.w3.org/2000/svg\"><script>alert(1)</script></svg>");
    io::write_text(out / "reproduce" / "figures.json",
                   R"([{"file": "fig_21a.svg", "caption": "Pressure", "paper": "Fig. 21a"}, {"file": "gone.png"}])");
    const auto text = page();
    EXPECT_NE(text.find("Fig. 21a"), std::string::npos);
    EXPECT_NE(text.find("+4.5 %<"), std::string::npos);
    EXPECT_NE(text.find("+47.5 % *"), std::string::npos);
    EXPECT_NE(text.find("93 ± 2"), std::string::npos);
    EXPECT_NE(text.find("tag fitted"), std::string::npos);
    EXPECT_EQ(text.find("alert(1)"), std::string::npos)
        << "a drawing made elsewhere is a picture, not part of the document";
}

TEST_F(Folder, PaperNumbersStayAwayFromOtherMaterials)
{
    fs::create_directories(out / "microstructure");
    summary("microstructure", R"({"porosity": {"total": 0.0902}})");
    EXPECT_EQ(page().find("8.83"), std::string::npos);
}

}  // namespace
}  // namespace craze::report
