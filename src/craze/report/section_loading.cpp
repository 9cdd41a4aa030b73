// What the virtual tests say: moduli, stress and strain, pressure and density, strength [4, Figs. 18 to 25].

#include "craze/core/json.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace craze::report {

namespace {

constexpr double giga = 1e9, mega = 1e6, percent = 0.01;

enum class Kind { modulus, uniaxial, triaxial, fracture, cycles, program };

/// One curve of response.json.
struct Curve {
    const Json& json;
    Kind kind;
    std::string name, specimen;
    int axis = 0;

    double strength() const { return find_number(json, {"loading.strength"}); }
    bool tension() const { return name.find("compression") == std::string::npos; }
    /// A quantity along the curve, over `unit`.
    std::vector<double> along(std::string_view key, double unit) const
    {
        std::vector<double> out;
        for (const Json& point : json.at("points")) out.push_back(find_number(point, {key}) / unit);
        return out;
    }
    std::vector<double> strain() const { return along(fmt::format("strain.{}", "xyz"[axis]), percent); }
    std::vector<double> stress() const { return along(fmt::format("stress.{}", "xyz"[axis]), mega); }
};

std::vector<Curve> curves_of(const Json& response)
{
    std::vector<Curve> out;
    for (const Json& c : find(response, "curves")) {
        const auto name = find(c, "loading.name").get<std::string>();
        out.push_back({c, static_cast<Kind>(find(c, "loading.kind").get<int>()), name, name.substr(0, name.find(',')),
                       std::clamp(static_cast<int>(find_number(c, {"loading.axis"})), 0, 2)});
    }
    return out;
}

void moduli_table(Work& work, const Json& response)
{
    const Json& moduli = find(response, "moduli");
    if (!moduli.is_array() || moduli.empty()) return;
    // Table 3 of the paper, GPa.
    struct Row {
        std::string_view specimen;
        double x, y, z;
    };
    constexpr Row paper[] = {
        {"both", 89, 74, 115}, {"cracks", 135, 111, 159}, {"pores", 186, 184, 190}, {"dense", 223, 223, 223}};
    std::vector<std::string> specimens;
    for (const Json& m : moduli)
        if (const auto name = m.value("specimen", std::string());
            std::find(specimens.begin(), specimens.end(), name) == specimens.end())
            specimens.push_back(name);
    Table table{{"specimen", "E<sub>x</sub> [GPa]", "E<sub>y</sub>", "E<sub>z</sub>", "E<sub>z</sub>, compression",
                 "ν along z"},
                {},
                ""};
    if (work.paper) table.head.emplace_back("paper: E<sub>Tx</sub>, E<sub>Ty</sub>, E<sub>L</sub> [GPa]");
    for (const auto& specimen : specimens) {
        const auto value = [&](int axis, std::string_view key) {
            for (const Json& m : moduli)
                if (m.value("specimen", std::string()) == specimen && m.value("axis", -1) == axis)
                    return find_number(m, {key});
            return std::nan("");
        };
        std::vector<std::string> row{escape(specimen)};
        for (int axis = 0; axis < 3; ++axis) row.push_back(cell(value(axis, "tension"), giga));
        row.push_back(cell(value(2, "compression"), giga));
        row.push_back(cell(value(2, "nu"), 1.0, 3));
        if (work.paper) {
            const auto* known =
                std::find_if(std::begin(paper), std::end(paper), [&](const Row& r) { return r.specimen == specimen; });
            row.push_back(known == std::end(paper) ? "" : fmt::format("{}, {}, {}", known->x, known->y, known->z));
        }
        table.rows.push_back(std::move(row));
    }
    work.page.subtitle("Young's moduli at small strain");
    work.page.add(html(table));
}

/// Compression and tension of one specimen and axis as one curve through the origin.
void stress_strain(Work& work, const std::vector<Curve>& curves)
{
    Figure f;
    f.id = "stress_strain";
    f.caption =
        "Uniaxial loading: axial stress against axial strain, tension positive. Dashed: the tangent at the origin.";
    f.paper = work.figure("Fig. 18");
    f.x.title = "axial strain [%]";
    f.y.title = "axial stress [MPa]";
    std::vector<Series> tangents;
    for (const auto& c : curves) {
        if (c.kind != Kind::uniaxial) continue;
        const auto name = fmt::format("{}, {}", c.specimen, "xyz"[c.axis]);
        auto x = c.strain(), y = c.stress();
        if (x.size() < 2) continue;
        auto found = std::find_if(f.series.begin(), f.series.end(), [&](const Series& s) { return s.name == name; });
        if (found == f.series.end()) {
            f.series.push_back({name, {}, {}, Mark::line, static_cast<int>(f.series.size())});
            found = f.series.end() - 1;
        }
        const bool falls = x.back() < x.front();
        if (falls) {
            const double slope = (y[1] - y[0]) / (x[1] - x[0]);
            tangents.push_back({"", {x.back(), 0.0}, {slope * x.back(), 0.0}, Mark::dashed, found->colour});
            std::reverse(x.begin(), x.end()), std::reverse(y.begin(), y.end());
        }
        // The unloaded state is in both halves: once is enough.
        const auto join = [](std::vector<double>& to, const std::vector<double>& more, bool in_front) {
            if (in_front)
                to.insert(to.begin(), more.begin(), more.end() - (to.empty() ? 0 : 1));
            else
                to.insert(to.end(), more.begin() + (to.empty() ? 0 : 1), more.end());
        };
        join(found->x, x, falls), join(found->y, y, falls);
    }
    f.series.insert(f.series.end(), tangents.begin(), tangents.end());
    work.page.figure(f);
}

void triaxial(Work& work, const std::vector<Curve>& curves)
{
    struct Plot {
        const char *id, *key, *title, *caption, *paper;
        double unit;
    };
    constexpr Plot plots[] = {
        {"pressure_density", "pressure", "pressure P [MPa]", "Triaxial compression: pressure against density.",
         "Figs. 21a, 22a", mega},
        {"bulk_modulus", "bulk_modulus", "tangent bulk modulus K [GPa]",
         "Triaxial compression: tangent bulk modulus K = (1 + η) dP/dη.", "Figs. 21b, 22b", giga},
        {"crack_closure", "closure", "closed contact beams γ [%]",
         "Triaxial compression: share of contact beams under compression.", "Figs. 21c, 22c", percent}};
    for (const auto& p : plots) {
        Figure f;
        f.id = p.id, f.caption = p.caption, f.paper = work.figure(p.paper);
        f.x.title = "density η = (V₀ − V)/V [%]";
        f.y.title = p.title;
        for (const auto& c : curves) {
            if (c.kind != Kind::triaxial) continue;
            const auto gamma = c.along("closure", 1.0);
            if (std::string_view(p.id) == "crack_closure" && *std::max_element(gamma.begin(), gamma.end()) <= 0.0)
                continue;
            f.series.push_back({c.specimen, c.along("eta", percent), c.along(p.key, p.unit)});
        }
        if (work.paper && std::string_view(p.id) == "bulk_modulus" && !f.series.empty())
            f.guides = {{52.0, "paper, both, η = 0: 52 GPa", false}, {70.0, "paper, both, η = 1.5 %: 70 GPa", false}};
        work.page.figure(f);
    }
}

std::string bond_strength(const Curve& c)
{
    const double s = c.strength();
    return std::isfinite(s) ? fmt::format("{} GPa", format_number(s / giga, 3)) : std::string("unbreakable");
}

void fracture(Work& work, const Json& response, const std::vector<Curve>& curves)
{
    Figure stress, damage, cycles;
    stress.id = "fracture_stress";
    stress.caption = "Fracture: axial stress against axial strain for each bond strength, both as absolute values.";
    stress.paper = work.figure("Fig. 23a");
    stress.y.title = "|axial stress| [MPa]";
    damage.id = "fracture_damage";
    damage.caption = "Fracture: share α of the bonds that are contact beams, less that at the start.";
    damage.paper = work.figure("Fig. 23b");
    damage.y.title = "new contact beams [%]";
    cycles.id = "cycles";
    cycles.caption = "Cycles of loading and unloading.";
    cycles.paper = work.figure("Fig. 25");
    cycles.x.title = "axial strain [%]";
    cycles.y.title = "axial stress [MPa]";
    stress.x.title = damage.x.title = "|axial strain| [%]";
    const auto absolute = [](std::vector<double> v) {
        for (double& x : v) x = std::abs(x);
        return v;
    };
    for (const auto& c : curves) {
        if (c.kind == Kind::cycles)
            cycles.series.push_back({fmt::format("{}, {}", c.specimen, bond_strength(c)), c.strain(), c.stress()});
        if (c.kind != Kind::fracture) continue;
        const auto name =
            fmt::format("{}, {}, {}", c.specimen, c.tension() ? "tension" : "compression", bond_strength(c));
        auto alpha = c.along("cracked", percent);
        for (double& a : alpha) a -= find_number(c.json.at("points").front(), {"cracked"}) / percent;
        stress.series.push_back(
            {name, absolute(c.strain()), absolute(c.stress()), c.tension() ? Mark::line : Mark::dashed});
        damage.series.push_back({name, absolute(c.strain()), alpha, c.tension() ? Mark::line : Mark::dashed});
    }
    const Json& strengths = find(response, "strengths");
    if (strengths.is_array() && !strengths.empty()) {
        Table table{
            {"specimen", "load", "bond strength [GPa]", "strength [MPa]", "at strain [%]", "new contact beams [%]"},
            {},
            ""};
        if (work.paper) table.head.emplace_back("paper [MPa]");
        constexpr double sigma[] = {10, 20, 30, 40, 50}, uts[] = {61, 120, 179, 243, 308},
                         ucs[] = {171, 345, 540, 753, 1002};
        for (const Json& s : strengths) {
            const bool tension = s.value("tension", true);
            const double bond = find_number(s, {"sigma_failure"}) / giga;
            std::vector<std::string> row{
                escape(s.value("specimen", std::string("?"))),
                fmt::format("{} {}", tension ? "tension" : "compression", "xyz"[s.value("axis", 0)]),
                cell(bond, 1.0, 3),
                cell(find_number(s, {"strength"}), mega, 4),
                cell(find_number(s, {"strain"}), percent, 3),
                cell(find_number(s, {"new_cracks"}), percent, 3)};
            if (work.paper) {
                const auto* at = std::find_if(std::begin(sigma), std::end(sigma),
                                              [&](double v) { return std::abs(v - bond) < 1e-6; });
                const bool known = at != std::end(sigma) && s.value("axis", -1) == 0;
                row.push_back(known ? format_number((tension ? uts : ucs)[at - sigma], 4) : std::string());
            }
            table.rows.push_back(std::move(row));
        }
        work.page.subtitle("Strength");
        work.page.add(html(table));
    }
    work.page.add("<div class=\"row\">");
    work.page.figure(stress);
    work.page.figure(damage);
    work.page.figure(cycles);
    work.page.add("</div>");
}

void programs(Work& work, const std::vector<Curve>& curves)
{
    int number = 0;
    for (const auto& c : curves) {
        if (c.kind != Kind::program) continue;
        Figure f;
        f.id = fmt::format("program_{}", ++number);
        f.caption = fmt::format("Loading \"{}\": stress along each axis.", c.name);
        f.x.title = "strain of the program [%]";
        f.y.title = "stress [MPa]";
        for (const char axis : {'x', 'y', 'z'})
            f.series.push_back(
                {std::string("σ") + axis, c.along("program", percent), c.along(std::string("stress.") + axis, mega)});
        work.page.figure(f);
    }
}

void calibration(Work& work, const Json& response)
{
    const Json& path = find(response, "calibration.path");
    if (!path.is_array() || path.size() < 2) return;
    Table table{{"trial", "r̃", "E along z [GPa]", "ν along z"}, {}, ""};
    int trial = 0;
    for (const Json& t : path)
        table.rows.push_back({fmt::format("{}", ++trial), cell(find_number(t, {"r_tilde"}), 1.0, 6),
                              cell(find_number(t, {"E.z"}), giga, 5), cell(find_number(t, {"nu.z"}), 1.0, 5)});
    work.page.folded("The trials of the calibration", html(table));
}

void energies(Work& work, const std::vector<Curve>& curves)
{
    for (const auto& c : curves) {
        if (c.kind != Kind::fracture) continue;
        const auto broken = c.along("broken", 1.0);
        if (broken.empty() || broken.back() <= 0.0) continue;
        Figure f;
        f.id = "energies";
        f.caption = fmt::format("Energies of the loading \"{}\": the work of the sides against where it went.", c.name);
        f.x.title = "|axial strain| [%]";
        f.y.title = "energy [nJ]";
        auto x = c.strain();
        for (double& v : x) v = std::abs(v);
        for (const auto& [key, name] : {std::pair{"work", "work of the sides"},
                                        {"elastic", "elastic"},
                                        {"kinetic", "kinetic"},
                                        {"damped", "damped"},
                                        {"fracture", "fracture"}})
            f.series.push_back(
                {name, x, c.along(key, 1e-9), key == std::string_view("work") ? Mark::dashed : Mark::line});
        work.page.figure(f);
        return;
    }
}

}  // namespace

void write_loading(Work& work)
{
    if (!begin_room(work, "loading", "Virtual tests")) return;
    const Json response = read_json(work.folder.room("loading") / "response.json");
    const auto curves = curves_of(response);
    moduli_table(work, response);
    work.page.add("<div class=\"row\">");
    stress_strain(work, curves);
    triaxial(work, curves);
    programs(work, curves);
    work.page.add("</div>");
    fracture(work, response, curves);
    energies(work, curves);
    calibration(work, response);
    end_room(work, "loading");
}

}  // namespace craze::report
