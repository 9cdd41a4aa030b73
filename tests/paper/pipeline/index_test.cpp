#include "support/command.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

namespace craze {
namespace {

namespace fs = std::filesystem;

const fs::path root = CRAZE_SOURCE_DIR;

// "[Eq. 13]", "[Eqs. 5-7]", "[Eqs. 16, 17]", "Eq. 13": the numbers that a text names.
std::set<int> equations_named_in(const std::string& text)
{
    static const std::regex mention(R"(Eqs?\.\s*([0-9][0-9 ,\-]*(and [0-9]+|to [0-9]+)?))");
    static const std::regex item(R"(([0-9]+)\s*(?:-|to)\s*([0-9]+)|([0-9]+))");
    std::set<int> named;
    for (std::sregex_iterator m(text.begin(), text.end(), mention), end; m != end; ++m) {
        const std::string list = (*m)[1];
        for (std::sregex_iterator i(list.begin(), list.end(), item); i != end; ++i) {
            const int first = std::stoi((*i)[1].matched ? (*i)[1] : (*i)[3]);
            const int last = (*i)[2].matched ? std::stoi((*i)[2]) : first;
            for (int n = first; n <= last && n <= 25; ++n) named.insert(n);
        }
    }
    return named;
}

std::string all_tests()
{
    std::string text;
    for (const auto& entry : fs::recursive_directory_iterator(root / "tests"))
        if (entry.path().extension() == ".cpp") text += support::content_of(entry.path());
    return text;
}

TEST(PaperIndex, EveryEquationHasASourceThatNamesItAndATest)
{
    const std::string tests = all_tests();
    std::istringstream page(support::content_of(root / "docs" / "paper.md"));
    static const std::regex row(R"(\| (\d+) \| [^|]* \| `?([^|` ]+)`? \| `?([^|` ]+)`? \|)");
    std::set<int> homes;
    for (std::string line; std::getline(page, line);) {
        std::smatch m;
        if (!std::regex_match(line, m, row)) continue;
        const int equation = std::stoi(m[1]);
        const std::string source = m[2], test = m[3];
        homes.insert(equation);
        ASSERT_TRUE(fs::exists(root / source)) << line;
        EXPECT_TRUE(equations_named_in(support::content_of(root / source)).contains(equation)) << line;
        if (test.ends_with(".cpp")) {
            EXPECT_TRUE(fs::exists(root / test)) << line;
            continue;
        }
        const auto dot = test.find('.');
        ASSERT_NE(dot, std::string::npos) << line;
        const std::regex definition("TEST(_F|_P)?\\(" + test.substr(0, dot) + ",\\s*" + test.substr(dot + 1) + "\\)");
        EXPECT_TRUE(std::regex_search(tests, definition)) << line;
    }
    for (int n = 1; n <= 25; ++n) EXPECT_TRUE(homes.contains(n)) << "Eq. " << n << " has no home in docs/paper.md";
}

}  // namespace
}  // namespace craze
