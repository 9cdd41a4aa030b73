#include "craze/report/report.hpp"
#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace craze::report {
namespace {

namespace fs = std::filesystem;

class Report : public testing::Test {
protected:
    void SetUp() override
    {
        out = fs::temp_directory_path() /
              ("craze_report_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(out);
        fs::create_directories(out);
        take_notices();
    }
    void TearDown() override { fs::remove_all(out); }
    std::string page(const Settings& settings = {}) const { return io::read_text(write_report(out, settings)); }

    fs::path out;
};

TEST_F(Report, OfAnEmptyFolderSaysWhatIsMissing)
{
    const auto text = page();
    for (const char* room : {"images", "microstructure", "mesh", "domain", "loading"})
        EXPECT_NE(text.find(std::string("no ") + room + "/summary.json"), std::string::npos) << room;
    EXPECT_NE(text.find("no run.json"), std::string::npos);
}

TEST_F(Report, AsksNothingOfANetwork)
{
    const auto text = page();
    for (const char* sign : {"src=\"http", "href=\"http", "url(http", "@import", "<link"})
        EXPECT_EQ(text.find(sign), std::string::npos) << sign;
    EXPECT_NE(text.find("default-src 'none'"), std::string::npos);
}

TEST_F(Report, GoesOnWhenAFileIsBroken)
{
    fs::create_directories(out / "images");
    io::write_text(out / "images" / "summary.json", "{ \"threshold\": ");
    const auto text = page();
    EXPECT_NE(text.find("id=\"loading\""), std::string::npos);
    EXPECT_EQ(take_notices().size(), 1U);
}

TEST_F(Report, EscapesWhatComesFromFiles)
{
    fs::create_directories(out / "mesh");
    io::write_text(out / "mesh" / "summary.json", R"({"<script>alert(1)</script>": 3})");
    Settings settings;
    settings.title = "<b>bold</b>";
    const auto text = page(settings);
    EXPECT_EQ(text.find("<script>alert"), std::string::npos);
    EXPECT_EQ(text.find("<b>bold"), std::string::npos);
}

TEST_F(Report, IsTheSameBytesEveryTime)
{
    fs::create_directories(out / "domain");
    io::write_text(out / "domain" / "summary.json", R"({"elements": 92000})");
    const auto first = page();
    EXPECT_EQ(page(), first);
}

TEST_F(Report, RefusesWhatIsNoFolderAndATitleOfBlanks)
{
    EXPECT_THROW(write_report(out / "nowhere", {}), InvalidInput);
    Settings settings;
    settings.title = "  ";
    EXPECT_THROW(check(settings), InvalidInput);
}

}  // namespace
}  // namespace craze::report
