// The numbers first: what was given, measured, fitted, predicted; truth and the paper's numbers beside.

#include "craze/core/json.hpp"
#include "craze/report/html.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::report {

namespace {

enum class Origin { measured, given, fitted, predicted };

std::string tag(Origin origin)
{
    constexpr const char* names[] = {"measured", "given", "fitted", "predicted"};
    const auto* name = names[static_cast<std::size_t>(origin)];
    return fmt::format("<span class=\"tag {0}\">{0}</span>", name);
}

class Headline {
public:
    Headline(bool truth, bool paper) : truth_(truth), paper_(paper)
    {
        table_.kind = "headline";
        table_.head = {"", "this run"};
        if (truth) table_.head.emplace_back("truth");
        if (paper) table_.head.emplace_back("paper");
        table_.head.emplace_back("");
    }
    /// Nothing where the value is not known. A NaN of truth or paper is a blank.
    void row(const std::string& name, double value, double unit, Origin origin, double truth = std::nan(""),
             double paper = std::nan(""), int digits = 4)
    {
        if (!std::isfinite(value)) return;
        const auto known = [digits](double v) { return std::isfinite(v) ? format_number(v, digits) : std::string(); };
        std::vector<std::string> cells{name, format_number(value / unit, digits)};
        if (truth_) cells.push_back(known(truth / unit));
        if (paper_) cells.push_back(known(paper));
        cells.push_back(tag(origin));
        table_.rows.push_back(std::move(cells));
    }
    bool empty() const { return table_.rows.empty(); }
    std::string text() const { return html(table_); }

private:
    bool truth_, paper_;
    Table table_;
};

void loading_rows(Headline& table, const Json& loading)
{
    const bool fitted = find(loading, "calibration.calibrated").is_boolean()
                            ? find(loading, "calibration.calibrated").get<bool>()
                            : true;
    const auto number = [&](std::string_view key) { return find_number(loading, {key}); };
    const double none = std::nan("");
    const Origin beam = fitted ? Origin::fitted : Origin::given;
    table.row("beam modulus E<sub>B</sub> [GPa]", number("calibration.E_B_Pa"), giga, beam, none, 5820);
    table.row("beam radius ratio r̃", number("calibration.r_tilde"), 1.0, beam, none, 0.345);
    table.row("E of the dense domain [GPa]", number("calibration.E_Pa"), giga, beam, none, 223);
    table.row("ν of the dense domain", number("calibration.nu"), 1.0, beam, none, 0.29);
    struct Paper {
        std::string_view specimen;
        double x, y, z;
    };
    constexpr Paper paper[] = {{"pores", 186, 184, 190}, {"cracks", 135, 111, 159}, {"both", 89, 74, 115}};
    for (const auto& p : paper) {
        const auto key = fmt::format("moduli.{}.tension_Pa.", p.specimen);
        const auto label = [&](char axis) {
            return fmt::format(
                "E<sub>{}</sub>, {} [GPa]", axis,
                p.specimen == "both" ? std::string("pores and cracks") : fmt::format("{} only", p.specimen));
        };
        table.row(label('x'), number(key + "x"), giga, Origin::predicted, none, p.x);
        table.row(label('y'), number(key + "y"), giga, Origin::predicted, none, p.y);
        table.row(label('z'), number(key + "z"), giga, Origin::predicted, none, p.z);
    }
    // Specimens of the reader's own ("both T1", "cracks 40 nm"): the paper has no number for them.
    const Json& moduli = find(loading, "moduli");
    for (const auto& item : moduli.items()) {
        const std::string& specimen = item.key();
        if (specimen == "dense" || std::ranges::any_of(paper, [&](const Paper& p) { return p.specimen == specimen; }))
            continue;
        for (const char axis : {'x', 'y', 'z'})
            table.row(fmt::format("E<sub>{}</sub>, {} [GPa]", axis, escape(specimen)),
                      find_number(item.value(), {fmt::format("tension_Pa.{}", axis)}), giga, Origin::predicted);
    }
    for (const std::string specimen : {"pores", "cracks", "both"}) {
        const double ratio = specimen == "pores" ? 0.75 : specimen == "cracks" ? 0.46 : 0.29;
        table.row(fmt::format("K(0)/K<sub>D</sub>, {}", specimen == "both" ? "pores and cracks" : specimen + " only"),
                  number(fmt::format("triaxial.{}.K_first_over_dense", specimen)), 1.0, Origin::predicted, none, ratio,
                  3);
    }
    const double eta = number("triaxial.both.eta_last");
    const bool same = std::abs(eta - 0.015) < 1e-4;
    table.row("K at η = 0 [GPa], pores and cracks", number("triaxial.both.K_first_Pa"), giga, Origin::predicted, none,
              52);
    table.row(fmt::format("K at η = {:.3g} % [GPa], pores and cracks", eta / percent),
              number("triaxial.both.K_last_Pa"), giga, Origin::predicted, none, same ? 70.0 : none);
    table.row(fmt::format("closed contact beams γ at η = {:.3g} % [%]", eta / percent),
              number("triaxial.both.closure_last"), percent, Origin::predicted, none, none, 3);
}

}  // namespace

void write_overview(Work& work)
{
    work.page.section("results", "Results");
    const auto& folder = work.folder;
    const Json &synth = folder.summary("synth"), &micro_summary = folder.summary("microstructure"),
               &domain = folder.summary("domain");
    Headline table(!synth.is_null(), work.paper);
    const double none = std::nan("");
    const auto truth = [&](std::string_view key) { return find_number(synth, {key}); };
    const auto measured = [&](std::string_view key) { return find_number(micro_summary, {key}); };
    double true_total = truth("true_porosity.total");
    if (!std::isfinite(true_total)) true_total = truth("true_porosity.pores") + truth("true_porosity.cracks");
    table.row("porosity, total [%]", measured("porosity.total"), percent, Origin::measured, true_total, 8.83, 3);
    table.row("porosity, pores [%]", measured("porosity.pores"), percent, Origin::measured,
              truth("true_porosity.pores"), 5.88, 3);
    table.row("porosity, cracks [%]", measured("porosity.cracks"), percent, Origin::measured,
              truth("true_porosity.cracks"), 2.95, 3);
    table.row("threshold S [gray level]", measured("threshold.used"), 1.0, Origin::measured);
    const auto discrete = [&](std::initializer_list<std::string_view> keys) { return find_number(domain, keys); };
    table.row("discrete porosity p<sub>DE</sub> [%]", discrete({"p_DE"}), percent, Origin::measured, none, 5.82, 3);
    table.row("elements", discrete({"elements"}), 1.0, Origin::measured, none, 92000, 9);
    table.row("bonds", discrete({"bonds"}), 1.0, Origin::measured, none, 278000, 9);
    table.row("contact beams (cut bonds)", discrete({"specimen.contact_beams", "contact_beams"}), 1.0, Origin::measured,
              none, none, 9);
    table.row("crack thickness T<sub>1</sub>, median [nm]", discrete({"T1_m.median"}), nano, Origin::measured, none,
              none, 3);
    table.row("crack thickness T<sub>2</sub>, median [nm]", discrete({"T2_m.median"}), nano, Origin::measured, none, 37,
              3);
    loading_rows(table, folder.summary("loading"));
    if (table.empty())
        work.page.remark("No room has left results in this folder yet.");
    else
        work.page.add(table.text());
    if (!table.empty())
        work.page.add(
            "<p class=\"soft\">Measured: from images or geometry. Fitted: parameters of the beams, so that the dense "
            "domain has the "
            "elastic constants of the dense ceramic. Predicted: everything mechanical that follows without further "
            "fitting.</p>\n");
}

}  // namespace craze::report
