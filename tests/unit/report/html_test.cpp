#include "craze/report/html.hpp"
#include "craze/core/json.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>

namespace craze::report {
namespace {

TEST(Escape, LeavesNoCharacterThatCouldOpenATagOrCloseAnAttribute)
{
    EXPECT_EQ(escape("<img src='x' onerror=\"a&b\">"), "&lt;img src=&#39;x&#39; onerror=&quot;a&amp;b&quot;&gt;");
    EXPECT_EQ(escape(std::string_view("a\0b\x1b", 4)), "a b ");
    EXPECT_EQ(escape("µm, °, 10⁻⁹"), "µm, °, 10⁻⁹");
}

TEST(Base64, AgreesWithTheVectorsOfRfc4648)
{
    const char* words[][2] = {{"", ""},
                              {"f", "Zg=="},
                              {"fo", "Zm8="},
                              {"foo", "Zm9v"},
                              {"foob", "Zm9vYg=="},
                              {"fooba", "Zm9vYmE="},
                              {"foobar", "Zm9vYmFy"}};
    for (const auto& [plain, coded] : words) EXPECT_EQ(base64(std::string_view(plain)), coded);
    EXPECT_EQ(base64(std::string_view("\xff\xfe\xfd")), "//79");
}

TEST(Deflated, IsWhatZlibInflates)
{
    std::string text;
    for (int i = 0; i < 5000; ++i) text += std::to_string(i * i % 97);
    const auto packed = deflated(std::as_bytes(std::span(text)));
    EXPECT_LT(packed.size(), text.size() / 4);
    std::string back(text.size(), '\0');
    uLongf size = static_cast<uLongf>(back.size());
    ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(back.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                         static_cast<uLong>(packed.size())),
              Z_OK);
    EXPECT_EQ(back, text);
}

TEST(ScriptJson, CannotEndItsScriptElement)
{
    const Json json{{"name", "</script><!-- x"}};
    const auto text = script_json(json);
    EXPECT_EQ(text.find("</"), std::string::npos);
    EXPECT_EQ(text.find("<!--"), std::string::npos);
    EXPECT_EQ(Json::parse(text), json);
}

TEST(ScriptJson, SurvivesBytesThatAreNotUtf8) { EXPECT_NO_THROW(script_json(Json{{"path", "caf\xe9"}})); }

TEST(FormatNumber, KeepsThousandsApartAndNamesWhatIsNoNumber)
{
    EXPECT_EQ(format_number(92123, 6), "92\u00a0123");
    EXPECT_EQ(format_number(-1234567, 9), "-1\u00a0234\u00a0567");
    EXPECT_EQ(format_number(999, 4), "999");
    EXPECT_EQ(format_number(0.0588, 3), "0.0588");
    EXPECT_EQ(format_number(278000, 3), "278\u00a0000");
    EXPECT_EQ(format_number(std::nan("")), "–");
}

TEST(SummaryTable, EscapesKeysAndValuesAndCutsLongLists)
{
    Json json{{"a<b", {{"c", "x&y"}}}, {"list", Json::array()}};
    for (int i = 0; i < 100; ++i) json["list"].push_back(i);
    const auto table = summary_table(json);
    EXPECT_NE(table.find("a&lt;b.c"), std::string::npos);
    EXPECT_NE(table.find("x&amp;y"), std::string::npos);
    EXPECT_NE(table.find("(100 items)"), std::string::npos);
    EXPECT_EQ(table.find("57"), std::string::npos);
}

}  // namespace
}  // namespace craze::report
