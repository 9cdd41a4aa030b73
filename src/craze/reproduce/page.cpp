#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/reproduce/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace craze::reproduce {

namespace {

bool is_fitted(const Reproduction& result, const std::string& key)
{
    return std::count(result.settings.fitted.begin(), result.settings.fitted.end(), key) > 0;
}

/// Numbers that the size of the box decides, and so says nothing about, when it is small.
bool of_the_box(const std::string& key) { return key == "elements" || key == "bonds"; }

/// Whole numbers from ten thousand on, which %g would write as powers of ten.
std::string four_digits(double value)
{
    return std::abs(value) < 1e4 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

/// Of each variant the given numbers (column, first key that begins so). Empty where nothing was tried.
std::string table(const std::vector<Variant>& tried, const char* title,
                  const std::vector<std::pair<const char*, const char*>>& columns)
{
    if (tried.empty()) return {};
    std::string head = "| |", rule = "|---|", rows;
    for (const auto& [column, key] : columns) head += fmt::format(" {} |", column), rule += "---|";
    for (const auto& variant : tried) {
        rows += fmt::format("| {:g} |", variant.value);
        for (const auto& [column, key] : columns) {
            const auto found = first_of(variant.numbers, key);
            rows += found ? fmt::format(" {:.3g} |", *found) : " - |";
        }
        rows += "\n";
    }
    return fmt::format("\n{}:\n\n{}\n{}\n{}", title, head, rule, rows);
}

}  // namespace

std::string page(const Reproduction& result)
{
    const auto ours = statistics(result.seeds);
    std::string md = fmt::format(
        "Size {}, {} coatings (seeds), short way. Fracture: {:g} wave crossings, damping {:g}. Neighbours without bond "
        "push "
        "in states of rest: {}. {:.0f} s in all.\n\n",
        result.settings.size == Size::small ? "small" : "paper", result.seeds.size(), result.settings.crossings,
        result.settings.damping, result.settings.near_contacts ? "yes" : "no", result.seconds);
    const bool images = !result.images.empty();
    md += fmt::format(
        "| where | number | paper | ours | spread | difference | goal | |{}\n|---|---|---|---|---|---|---|---|{}\n",
        images ? " by images, first seed | short way, first seed |" : "", images ? "---|---|" : "");
    for (const auto& t : targets()) {
        const auto found = ours.find(t.key);
        if (found == ours.end()) continue;
        if (of_the_box(t.key) && result.settings.size == Size::small) continue;
        const double difference = found->second.mean / t.paper - 1.0;
        md += fmt::format("| {} | {} | {} {} | {} | {:.2g} | {:+.1f} %{} | {:.0f} % | {} |", t.where, t.what,
                          four_digits(t.paper), t.unit, four_digits(found->second.mean), found->second.deviation,
                          100.0 * difference, std::abs(difference) <= t.goal ? "" : " (missed)", 100.0 * t.goal,
                          is_fitted(result, t.key) ? "fitted" : "predicted");
        if (images) {
            const auto seen = result.images.find(t.key);
            md += seen == result.images.end() ? " | |"
                                              : fmt::format(" {} | {} |", four_digits(seen->second),
                                                            four_digits(result.seeds.front().at(t.key)));
        }
        md += "\n";
    }
    md += fmt::format(
        "\nPores only, theory at our p_DE: Eq. 18 gives {:.1f} GPa, the Hashin-Shtrikman bound {:.1f} GPa.\n",
        result.E_eq18, result.E_bound);
    md += table(result.openings, "All openings of the first seed times a factor (0: closed)",
                {{"T2, median [nm]", "T2.median"},
                 {"K at eta = 0", "K.start"},
                 {"K at eta = 1.5 %", "K.end"},
                 {"UTS", "UTS."},
                 {"UCS", "UCS."},
                 {"UCS/UTS", "UCS/UTS."}});
    md += table(result.bending, "A share of the bending stress in Eq. 24, first seed",
                {{"UTS", "UTS."},
                 {"UCS", "UCS."},
                 {"UCS/UTS", "UCS/UTS."},
                 {"new contact beams in tension", "new.tension"},
                 {"in compression", "new.compression"}});
    return md;
}

Json summary(const Reproduction& result)
{
    Json numbers;
    const auto ours = statistics(result.seeds);
    for (const auto& t : targets()) {
        const auto found = ours.find(t.key);
        if (found == ours.end()) continue;
        numbers[t.key] = {{"where", t.where},
                          {"what", t.what},
                          {"unit", t.unit},
                          {"paper", t.paper},
                          {"goal", t.goal},
                          {"mean", found->second.mean},
                          {"deviation", found->second.deviation},
                          {"fitted", is_fitted(result, t.key)}};
        for (const auto& seed : result.seeds) {
            const auto own = seed.find(t.key);
            numbers[t.key]["by_seed"].push_back(own == seed.end() ? Json() : Json(own->second));
        }
        if (const auto seen = result.images.find(t.key); seen != result.images.end())
            numbers[t.key]["by_images"] = seen->second;
    }
    Json openings = Json::array(), bending = Json::array();
    for (const auto& [share, n] : result.bending) bending.push_back({{"share", share}, {"numbers", n}});
    for (const auto& [factor, n] : result.openings) openings.push_back({{"factor", factor}, {"numbers", n}});
    return {{"size", result.settings.size == Size::small ? "small" : "paper"},
            {"seeds", result.settings.seeds},
            {"numbers", numbers},
            {"openings", openings},
            {"bending", bending},
            {"E_eq18_GPa", result.E_eq18},
            {"E_hashin_shtrikman_GPa", result.E_bound}};
}

void save(const Reproduction& result, const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    io::write_text(folder / "reproduction.md", "# Reproduction\n\n" + page(result));
    io::write_text(folder / "reproduction.json", summary(result).dump(1) + "\n");
    Json list = Json::array();
    const auto add = [&](const auto& shown, const char* kind) {
        list.push_back({{"file", shown.id + kind}, {"caption", shown.caption}, {"paper", shown.paper}});
    };
    for (const auto& figure : figures(result)) {
        io::write_text(folder / (figure.id + ".svg"), report::svg(figure));
        io::write_text(folder / (figure.id + ".csv"), report::csv(figure));
        add(figure, ".svg");
    }
    for (const auto& field : fields(folder / fmt::format("seed_{}", result.settings.seeds.front()))) {
        io::write_png(folder / (field.id + ".png"), field.picture);
        add(field, ".png");
    }
    io::write_text(folder / "figures.json", list.dump(1) + "\n");
}

}  // namespace craze::reproduce
