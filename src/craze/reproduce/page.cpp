#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/report/figure.hpp"
#include "craze/reproduce/reproduce.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace {

bool is_fitted(const Reproduction& result, const std::string& key)
{
    return std::count(result.settings.fitted.begin(), result.settings.fitted.end(), key) > 0;
}

/// Numbers that the size of the box decides, and so says nothing about, when it is small.
bool of_the_box(const std::string& key) { return key == "elements" || key == "bonds"; }

/// Triaxial curves of the first seed: specimens chosen by `wanted`, one quantity over eta.
template <class Wanted, class Value>
report::Figure triaxial(const Reproduction& result, Wanted&& wanted, Value&& value)
{
    report::Figure figure;
    figure.x.title = "eta [%]";
    for (const auto& curve : result.curves.front().curves) {
        if (curve.loading.kind != loading::Loading::Kind::triaxial || !wanted(curve.loading.specimen)) continue;
        report::Series series;
        series.name = loading::specimen_name(curve.loading.specimen);
        for (const auto& point : curve.points) {
            series.x.push_back(100.0 * point.eta);
            series.y.push_back(value(point));
        }
        figure.series.push_back(std::move(series));
    }
    return figure;
}

std::vector<report::Figure> figures(const Reproduction& result)
{
    std::vector<report::Figure> out;
    if (result.curves.empty()) return out;
    const auto constant = [](const domain::Defects& d) { return d.thickness == domain::Defects::Thickness::constant; };
    struct Quantity {
        const char *id, *title;
        double (*value)(const loading::Point&);
    };
    const Quantity quantities[] = {{"pressure", "P_h [GPa]", [](const loading::Point& p) { return 1e-9 * p.pressure; }},
                                   {"bulk", "K [GPa]", [](const loading::Point& p) { return 1e-9 * p.bulk; }},
                                   {"closure", "gamma [%]", [](const loading::Point& p) { return 100.0 * p.closure; }}};
    for (const auto& q : quantities) {
        auto defects = triaxial(
            result, [&](const auto& d) { return !constant(d); }, q.value);
        defects.id = fmt::format("fig21_{}", q.id);
        defects.paper = "Fig. 21";
        defects.y.title = q.title;
        defects.caption = "Triaxial compression of pores, open cracks, and both.";
        if (std::string_view(q.id) == "bulk") {
            defects.guides.push_back({52.0, "paper, both, eta = 0", false});
            defects.guides.push_back({70.0, "paper, both, eta = 1.5 %", false});
        }
        out.push_back(std::move(defects));
        auto thickness = triaxial(
            result, [&](const auto& d) { return constant(d) || (!d.pores && d.cracks); }, q.value);
        thickness.id = fmt::format("fig22_{}", q.id);
        thickness.paper = "Fig. 22";
        thickness.y.title = q.title;
        thickness.caption = "Cracks only: constant thicknesses beside T2.";
        out.push_back(std::move(thickness));
    }
    std::erase_if(out, [](const report::Figure& figure) { return figure.empty(); });
    return out;
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
        md += fmt::format("| {} | {} | {:.4g} {} | {:.4g} | {:.2g} | {:+.1f} %{} | {:.0f} % | {} |", t.where, t.what,
                          t.paper, t.unit, found->second.mean, found->second.deviation, 100.0 * difference,
                          std::abs(difference) <= t.goal ? "" : " (missed)", 100.0 * t.goal,
                          is_fitted(result, t.key) ? "fitted" : "predicted");
        if (images) {
            const auto seen = result.images.find(t.key);
            md += seen == result.images.end()
                      ? " | |"
                      : fmt::format(" {:.4g} | {:.4g} |", seen->second, result.seeds.front().at(t.key));
        }
        md += "\n";
    }
    md += fmt::format(
        "\nPores only, theory at our p_DE: Eq. 18 gives {:.1f} GPa, the Hashin-Shtrikman bound {:.1f} GPa.\n",
        result.E_eq18, result.E_bound);
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
        if (const auto seen = result.images.find(t.key); seen != result.images.end())
            numbers[t.key]["by_images"] = seen->second;
    }
    return {{"size", result.settings.size == Size::small ? "small" : "paper"},
            {"seeds", result.settings.seeds},
            {"numbers", numbers},
            {"E_eq18_GPa", result.E_eq18},
            {"E_hashin_shtrikman_GPa", result.E_bound}};
}

void save(const Reproduction& result, const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    io::write_text(folder / "reproduction.md", "# Reproduction\n\n" + page(result));
    io::write_text(folder / "reproduction.json", summary(result).dump(1) + "\n");
    for (const auto& figure : figures(result)) {
        io::write_text(folder / (figure.id + ".svg"), report::svg(figure));
        io::write_text(folder / (figure.id + ".csv"), report::csv(figure));
    }
}

}  // namespace craze::reproduce
