// What the virtual tests say: moduli, stress and strain, pressure and density, strength [4, Figs. 18 to 25].

#include "craze/core/json.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace craze::report {

namespace {

using loading::Point;
using Kind = loading::Loading::Kind;

/// A measured curve with what plots ask of it.
struct Curve {
    const loading::Curve& measured;
    Kind kind;
    std::string specimen;
    int axis;
    bool tension;

    explicit Curve(const loading::Curve& curve)
        : measured(curve),
          kind(curve.loading.kind),
          specimen(loading::specimen_name(curve.loading.specimen)),
          axis(std::clamp(curve.loading.axis, 0, 2)),
          tension(curve.loading.path.empty() || curve.loading.path.front() >= 0.0)
    {
    }
    template <class Value>
    std::vector<double> along(Value value, double unit) const
    {
        std::vector<double> out;
        for (const Point& p : measured.points) out.push_back(value(p) / unit);
        return out;
    }
    std::vector<double> along(double Point::*member, double unit) const
    {
        return along([member](const Point& p) { return p.*member; }, unit);
    }
    std::vector<double> strain() const
    {
        return along([this](const Point& p) { return p.strain[axis]; }, percent);
    }
    std::vector<double> stress() const
    {
        return along([this](const Point& p) { return p.stress[axis]; }, mega);
    }
};

/// The same specimen has the same colour in every plot.
int colour_of_specimen(const std::string& name)
{
    return name == "dense" ? 6 : name == "pores" ? 0 : name == "cracks" ? 1 : name == "both" ? 2 : -1;
}

void moduli_table(Work& work, const std::vector<loading::Modulus>& moduli)
{
    if (moduli.empty()) return;
    // Table 3 of the paper, GPa.
    struct Row {
        std::string_view specimen;
        double x, y, z;
    };
    constexpr Row paper[] = {
        {"both", 89, 74, 115}, {"cracks", 135, 111, 159}, {"pores", 186, 184, 190}, {"dense", 223, 223, 223}};
    std::vector<std::string> specimens;
    for (const auto& m : moduli)
        if (std::find(specimens.begin(), specimens.end(), m.specimen) == specimens.end())
            specimens.push_back(m.specimen);
    Table table{{"specimen", "E<sub>x</sub> [GPa]", "E<sub>y</sub>", "E<sub>z</sub>", "compression: E<sub>x</sub>",
                 "E<sub>y</sub>", "E<sub>z</sub>", "ν along z"},
                {},
                ""};
    if (work.paper) table.head.emplace_back("paper: E<sub>Tx</sub>, E<sub>Ty</sub>, E<sub>L</sub> [GPa]");
    for (const auto& specimen : specimens) {
        const auto value = [&](int axis, double loading::Modulus::*member) {
            for (const auto& m : moduli)
                if (m.specimen == specimen && m.axis == axis) return m.*member;
            return std::nan("");
        };
        std::vector<std::string> row{escape(specimen)};
        for (const auto sense : {&loading::Modulus::tension, &loading::Modulus::compression})
            for (int axis = 0; axis < 3; ++axis) row.push_back(cell(value(axis, sense), giga));
        row.push_back(cell(value(2, &loading::Modulus::nu), 1.0, 3));
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
        const char *id, *title, *caption, *paper;
        double Point::*member;
        double unit;
    };
    constexpr Plot plots[] = {
        {"pressure_density", "pressure P [MPa]", "Triaxial compression: pressure against density.", "Figs. 21a, 22a",
         &Point::pressure, mega},
        {"bulk_modulus", "tangent bulk modulus K [GPa]",
         "Triaxial compression: tangent bulk modulus K = (1 + η) dP/dη.", "Figs. 21b, 22b", &Point::bulk, giga},
        {"crack_closure", "closed contact beams γ [%]",
         "Triaxial compression: share of contact beams under compression.", "Figs. 21c, 22c", &Point::closure,
         percent}};
    for (const auto& p : plots) {
        Figure f;
        f.id = p.id, f.caption = p.caption, f.paper = work.figure(p.paper);
        f.x.title = "density η = (V₀ − V)/V [%]";
        f.y = {p.title, false, 0.0};
        bool both = false;
        for (const auto& c : curves) {
            if (c.kind != Kind::triaxial || c.measured.points.empty()) continue;
            if (p.member == &Point::closure && c.measured.points.back().cracked <= 0.0) continue;
            f.series.push_back({c.specimen, c.along(&Point::eta, percent), c.along(p.member, p.unit), Mark::line,
                                colour_of_specimen(c.specimen)});
            both = both || c.specimen == "both";
        }
        if (work.paper && both && p.member == &Point::bulk)
            f.series.push_back({"paper, both", {0.0, 1.5}, {52.0, 70.0}, Mark::points, 2});
        work.page.figure(f);
    }
}

std::string bond_strength(const Curve& c)
{
    const double s = c.measured.loading.strength;
    return std::isfinite(s) ? fmt::format("{} GPa", format_number(s / giga, 3)) : std::string("unbreakable");
}

void strength_table(Work& work, const std::vector<loading::Strength>& strengths)
{
    if (strengths.empty()) return;
    Table table{{"specimen", "load", "bond strength [GPa]", "strength [MPa]", "at strain [%]", "new contact beams [%]"},
                {},
                ""};
    if (work.paper) table.head.emplace_back("paper [MPa]");
    // Table 4 of the paper: loading along x.
    constexpr double sigma[] = {10, 20, 30, 40, 50}, uts[] = {61, 120, 179, 243, 308},
                     ucs[] = {171, 345, 540, 753, 1002};
    for (const auto& s : strengths) {
        const double bond = s.sigma_failure / giga;
        std::vector<std::string> row{
            escape(s.specimen),         fmt::format("{} {}", s.tension ? "tension" : "compression", "xyz"[s.axis]),
            cell(bond, 1.0, 3),         cell(s.strength, mega, 4),
            cell(s.strain, percent, 3), cell(s.new_cracks, percent, 3)};
        if (work.paper) {
            const auto* at =
                std::find_if(std::begin(sigma), std::end(sigma), [&](double v) { return std::abs(v - bond) < 1e-6; });
            const bool known = at != std::end(sigma) && s.axis == 0;
            row.push_back(known ? format_number((s.tension ? uts : ucs)[at - sigma], 4) : std::string());
        }
        table.rows.push_back(std::move(row));
    }
    work.page.subtitle("Strength");
    work.page.add(html(table));
}

std::vector<double> absolute(std::vector<double> values)
{
    for (double& v : values) v = std::abs(v);
    return values;
}

void fracture(Work& work, const std::vector<Curve>& curves)
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
    stress.x.title = damage.x.title = "|axial strain| [%]";
    cycles.id = "cycles";
    cycles.caption = "Cycles of loading and unloading.";
    cycles.paper = work.figure("Fig. 25");
    cycles.x.title = "axial strain [%]";
    cycles.y.title = "axial stress [MPa]";
    for (const auto& c : curves) {
        if (c.measured.points.empty()) continue;
        if (c.kind == Kind::cycles)
            cycles.series.push_back({fmt::format("{}, {}", c.specimen, bond_strength(c)), c.strain(), c.stress()});
        if (c.kind != Kind::fracture) continue;
        const auto name = fmt::format("{}, {} {}, {}", c.specimen, c.tension ? "tension" : "compression", "xyz"[c.axis],
                                      bond_strength(c));
        auto alpha = c.along(&Point::cracked, percent);
        const double before = alpha.front();
        for (double& a : alpha) a -= before;
        const Mark mark = c.tension ? Mark::line : Mark::dashed;
        stress.series.push_back({name, absolute(c.strain()), absolute(c.stress()), mark});
        damage.series.push_back({name, absolute(c.strain()), alpha, mark});
    }
    work.page.figure(stress);
    work.page.figure(damage);
    work.page.figure(cycles);
}

void energies(Work& work, const std::vector<Curve>& curves)
{
    const auto first = std::find_if(curves.begin(), curves.end(), [](const Curve& c) {
        return c.kind == Kind::fracture && !c.measured.broken.empty();
    });
    if (first == curves.end()) return;
    Figure f;
    f.id = "energies";
    f.caption = fmt::format("Energies of the loading \"{}\": the work of the sides against where it went.",
                            first->measured.loading.name);
    f.x.title = "|axial strain| [%]";
    f.y.title = "energy [nJ]";
    constexpr std::pair<double Point::*, const char*> parts[] = {{&Point::work, "work of the sides"},
                                                                 {&Point::elastic, "elastic"},
                                                                 {&Point::kinetic, "kinetic"},
                                                                 {&Point::damped, "damped"},
                                                                 {&Point::fracture, "fracture"}};
    for (const auto& [member, name] : parts)
        f.series.push_back({name, absolute(first->strain()), first->along(member, 1e-9),
                            member == &Point::work ? Mark::dashed : Mark::line});
    work.page.figure(f);
}

void programs(Work& work, const std::vector<Curve>& curves)
{
    int number = 0;
    for (const auto& c : curves) {
        if (c.kind != Kind::program) continue;
        Figure f;
        f.id = fmt::format("program_{}", ++number);
        f.caption = fmt::format("Loading \"{}\": stress along each axis.", c.measured.loading.name);
        f.x.title = "strain of the program [%]";
        f.y.title = "stress [MPa]";
        for (int axis = 0; axis < 3; ++axis)
            f.series.push_back({fmt::format("σ{0}{0}", "xyz"[axis]), c.along(&Point::program, percent),
                                c.along([axis](const Point& p) { return p.stress[axis]; }, mega)});
        work.page.figure(f);
    }
}

void calibration(Work& work, const loading::Calibration& c)
{
    if (c.path.size() < 2) return;
    Table table{{"trial", "r̃", "E along x, y, z [GPa]", "ν along x, y, z"}, {}, ""};
    const auto three = [](const Vec3& v, double unit, int digits) {
        std::string out;
        for (int axis = 0; axis < 3; ++axis)
            if (v[axis] != 0.0) out += (out.empty() ? "" : ", ") + cell(v[axis], unit, digits);
        return out;
    };
    int trial = 0;
    for (const auto& t : c.path)
        table.rows.push_back(
            {fmt::format("{}", ++trial), cell(t.r_tilde, 1.0, 6), three(t.E, giga, 5), three(t.nu, 1.0, 4)});
    work.page.folded("The trials of the calibration", html(table));
}

}  // namespace

void write_loading(Work& work)
{
    if (!begin_room(work, "loading", "Virtual tests")) return;
    const auto response = loading::load_response(work.folder.room("loading"));
    const std::vector<Curve> curves(response.curves.begin(), response.curves.end());
    moduli_table(work, response.moduli);
    strength_table(work, response.strengths);
    work.page.add("<div class=\"row\">");
    stress_strain(work, curves);
    triaxial(work, curves);
    fracture(work, curves);
    energies(work, curves);
    programs(work, curves);
    work.page.add("</div>");
    calibration(work, response.calibration);
    end_room(work, "loading");
}

}  // namespace craze::report
