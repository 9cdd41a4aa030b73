// The paper's numbers beside ours, over several coatings, where a reproduction has been run.

#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::report {

namespace fs = std::filesystem;

namespace {

std::string with_spread(double mean, double deviation)
{
    if (!std::isfinite(mean)) return "–";
    return deviation > 0.0 ? fmt::format("{} ± {}", format_number(mean, 4), format_number(deviation, 2))
                           : format_number(mean, 4);
}

Table comparison(const Json& numbers)
{
    Table table{{"number", "where", "paper", "ours", "by images", "difference", "aim", ""}, {}, ""};
    for (const auto& [key, n] : numbers.items()) {
        const auto unit = n.value("unit", std::string());
        const double paper = find_number(n, {"paper"}), mean = find_number(n, {"mean"}),
                     goal = find_number(n, {"goal"});
        const double off = mean / paper - 1.0;
        const bool fitted = n.value("fitted", false);
        table.rows.push_back({escape(n.value("what", key) + (unit.empty() ? "" : " [" + unit + "]")),
                              escape(n.value("where", std::string())), cell(paper),
                              with_spread(mean, find_number(n, {"deviation"})), cell(find_number(n, {"by_images"})),
                              std::isfinite(off)
                                  ? fmt::format("{:+.1f} %{}", 100.0 * off, std::abs(off) <= goal ? "" : " *")
                                  : std::string("–"),
                              std::isfinite(goal) ? fmt::format("{:.0f} %", 100.0 * goal) : std::string(),
                              fmt::format("<span class=\"tag {0}\">{0}</span>", fitted ? "fitted" : "predicted")});
    }
    return table;
}

}  // namespace

void write_reproduction(Work& work)
{
    const auto folder = work.folder.room("reproduce");
    if (!fs::exists(folder / "reproduction.json")) return;
    const Json result = read_json(folder / "reproduction.json");
    work.page.section("reproduce", "The paper beside ours");
    const Json& numbers = find(result, "numbers");
    if (!numbers.is_object() || numbers.empty()) {
        work.page.remark("reproduction.json holds no numbers.");
        return;
    }
    work.page.text(
        fmt::format("Synthetic coatings of the {} size, {} seeds: mean and standard deviation. A star marks what lies "
                    "further from the "
                    "paper than was aimed at.",
                    result.value("size", std::string("?")), find(result, "seeds").size()));
    work.page.add(html(comparison(numbers)));
    const double theory = find_number(result, {"E_eq18_GPa"}), bound = find_number(result, {"E_hashin_shtrikman_GPa"});
    if (std::isfinite(theory) && std::isfinite(bound))
        work.page.text(
            fmt::format("Pores alone, at the measured porosity: Eq. 18 gives {} GPa, the upper bound of Hashin and "
                        "Shtrikman {} GPa.",
                        format_number(theory, 4), format_number(bound, 4)));
    const Json list = fs::exists(folder / "figures.json") ? read_json(folder / "figures.json") : Json::array();
    work.page.add("<div class=\"row\">");
    for (const auto& shown : list) {
        const fs::path file = folder / shown.value("file", std::string());
        const auto id = "reproduce_" + file.stem().string();
        const auto caption = shown.value("caption", std::string()), paper = shown.value("paper", std::string());
        if (!fs::exists(file)) continue;
        if (file.extension() == ".png")
            work.page.picture(id, io::read_text(file), caption, paper);
        else
            work.page.drawing(id, io::read_text(file), caption, paper);
    }
    work.page.add("</div>");
}

}  // namespace craze::report
