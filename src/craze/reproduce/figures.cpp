#include "craze/reproduce/figures.hpp"

#include "craze/loading/specimen.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::reproduce {

namespace {

using Kind = loading::Loading::Kind;
using loading::Curve;
using loading::Point;
using report::Figure;
using report::Mark;
using report::Series;

Figure blank(std::string id, std::string paper, std::string x, std::string y, std::string caption)
{
    Figure f;
    f.id = std::move(id);
    f.paper = std::move(paper);
    f.x.title = std::move(x);
    f.y.title = std::move(y);
    f.caption = std::move(caption);
    return f;
}

template <class X, class Y>
Series series(std::string name, const Curve& curve, X&& x, Y&& y, Mark mark = Mark::line, int colour = -1)
{
    Series out{std::move(name), {}, {}, mark, colour};
    for (const Point& p : curve.points) {
        out.x.push_back(x(p));
        out.y.push_back(y(p));
    }
    return out;
}

bool in_tension(const Curve& curve) { return !curve.loading.path.empty() && curve.loading.path.front() > 0.0; }

/// Stress of both senses over strain, one colour for each axis, with the tangent at the origin.
Figure stress_strain(const std::vector<Curve>& curves)
{
    Figure f = blank("fig18_stress_strain", "Fig. 18", "axial strain [%]", "axial stress [MPa]",
                     "Pores and cracks: axial stress against axial strain along x, y and z. Dashed: tangents at the "
                     "origin.");
    for (const auto& c : curves) {
        if (c.loading.kind != Kind::uniaxial || c.points.size() < 2) continue;
        const int axis = c.loading.axis;
        const auto strain = [&](const Point& p) { return 100.0 * p.strain[axis]; };
        const auto stress = [&](const Point& p) { return 1e-6 * p.stress[axis]; };
        f.series.push_back(series(fmt::format("{}, {}", "xyz"[axis], in_tension(c) ? "tension" : "compression"), c,
                                  strain, stress, Mark::line, axis));
        const double slope = stress(c.points[1]) / strain(c.points[1]), end = strain(c.points.back());
        if (!in_tension(c)) f.series.push_back({"", {0.0, end}, {0.0, slope * end}, Mark::dashed, axis});
    }
    return f;
}

/// Triaxial curves: specimens chosen by `wanted`, one quantity over eta up to its largest value.
template <class Wanted, class Value>
Figure triaxial(const std::vector<Curve>& curves, double eta, Wanted&& wanted, Value&& value)
{
    Figure f;
    f.x.title = "eta [%]";
    for (Curve c : curves)
        if (c.loading.kind == Kind::triaxial && wanted(c.loading.specimen)) {
            std::erase_if(c.points, [&](const Point& p) { return p.eta > eta * (1.0 + 1e-9); });
            const bool closed = c.loading.specimen.thickness == domain::Defects::Thickness::closed;
            f.series.push_back(series(
                loading::specimen_name(c.loading.specimen), c, [](const Point& p) { return 100.0 * p.eta; }, value,
                closed ? Mark::dashed : Mark::line));
        }
    return f;
}

void add_triaxial(const std::vector<Curve>& curves, std::vector<Figure>& out)
{
    const auto constant = [](const domain::Defects& d) { return d.thickness == domain::Defects::Thickness::constant; };
    struct Quantity {
        const char *id, *title, *part;
        double (*value)(const Point&);
    };
    const Quantity quantities[] = {{"pressure", "P_h [GPa]", "a", [](const Point& p) { return 1e-9 * p.pressure; }},
                                   {"bulk", "K [GPa]", "b", [](const Point& p) { return 1e-9 * p.bulk; }},
                                   {"closure", "gamma [%]", "c", [](const Point& p) { return 100.0 * p.closure; }}};
    for (const auto& q : quantities) {
        auto defects = triaxial(
            curves, eta_paper, [&](const auto& d) { return !constant(d); }, q.value);
        defects.id = fmt::format("fig21_{}", q.id);
        defects.paper = fmt::format("Fig. 21{}", q.part);
        defects.y.title = q.title;
        defects.caption = "Triaxial compression with no defects, pores, cracks, and both; dashed: closed cracks.";
        if (q.part[0] == 'b') {
            defects.guides.push_back({52.0, "paper, both, eta = 0", false});
            defects.guides.push_back({70.0, "paper, both, eta = 1.5 %", false});
        }
        out.push_back(std::move(defects));
        auto thickness = triaxial(
            curves, INFINITY,
            [&](const auto& d) {
                return !d.pores && (!d.cracks || constant(d) || d.thickness == domain::Defects::Thickness::T2);
            },
            q.value);
        thickness.id = fmt::format("fig22_{}", q.id);
        thickness.paper = fmt::format("Fig. 22{}", q.part);
        thickness.y.title = q.title;
        thickness.caption = "Cracks without pores: constant thicknesses; dashed: T2 (\"cracks\") and no cracks.";
        for (Series& one : thickness.series)
            if (one.name == "cracks" || one.name == "dense") one.mark = Mark::dashed;
        out.push_back(std::move(thickness));
    }
}

void add_fracture(const std::vector<Curve>& curves, std::vector<Figure>& out)
{
    Figure stress = blank("fig23_stress", "Fig. 23a", "axial strain [%]", "axial stress [MPa]",
                          "Pores and cracks loaded along x until failure, by strength of the bonds.");
    Figure damage = blank("fig23_damage", "Fig. 23b", "axial strain [%]", "new contact beams [%]",
                          "Bonds that became contact beams since the start [Eq. 25], along the same loadings.");
    Figure cycles = blank("fig25_cycles", "Fig. 25", "axial strain [%]", "axial stress [MPa]",
                          "Cycles of compression along x; dashed: the loading without unloading.");
    int colour = -1;
    double strength = 0.0, cycled = 0.0;
    const auto strain = [](const Point& p) { return 100.0 * p.strain.x; };
    const auto pull = [](const Point& p) { return 1e-6 * p.stress.x; };
    for (const auto& c : curves)
        if (c.loading.kind == Kind::cycles) {
            cycled = c.loading.strength;
            cycles.series.push_back(series(fmt::format("cycles, {:g} GPa", 1e-9 * cycled), c, strain, pull));
        }
    for (const auto& c : curves) {
        if (c.loading.kind != Kind::fracture || c.points.empty()) continue;
        if (c.loading.strength != strength) ++colour;
        strength = c.loading.strength;
        const auto name = in_tension(c) ? fmt::format("{:g} GPa", 1e-9 * strength) : std::string();
        const double before = c.points.front().cracked;
        stress.series.push_back(series(name, c, strain, pull, Mark::line, colour));
        damage.series.push_back(series(
            name, c, strain, [&](const Point& p) { return 100.0 * (p.cracked - before); }, Mark::line, colour));
        if (strength == cycled && !in_tension(c))
            cycles.series.push_back(series("monotonic", c, strain, pull, Mark::dashed));
    }
    out.insert(out.end(), {std::move(stress), std::move(damage), std::move(cycles)});
}

Figure strengths(const Reproduction& result)
{
    Figure f = blank("table4_strengths", "Table 4", "sigma_failure [GPa]", "strength [MPa]",
                     "Strengths along x over the strength of the bonds, mean of the seeds; points: the paper.");
    const auto ours = statistics(result.seeds);
    int colour = 0;
    for (const char* kind : {"UTS", "UCS"}) {
        Series mine{kind, {}, {}, Mark::line, colour},
            paper{fmt::format("{}, paper", kind), {}, {}, Mark::points, colour};
        ++colour;
        for (int k = 10; k <= 50; k += 10) {
            const auto key = fmt::format("{}.{}", kind, k);
            const auto found = ours.find(key);
            if (found == ours.end()) continue;
            mine.x.push_back(k), mine.y.push_back(found->second.mean);
            paper.x.push_back(k), paper.y.push_back(target(key).paper);
        }
        f.series.push_back(std::move(mine));
        f.series.push_back(std::move(paper));
    }
    return f;
}

/// UCS/UTS against another number as one thing changes: where the paper's pair lies is not on the way.
void add_trade_off(Figure& figure, const std::vector<Variant>& tried, const char* against, double paper)
{
    Series line{"ours", {}, {}, Mark::line, 0}, points{"", {}, {}, Mark::points, 0};
    for (const auto& variant : tried) {
        const auto x = first_of(variant.numbers, against), ratio = first_of(variant.numbers, "UCS/UTS.");
        if (x && ratio) line.x.push_back(*x), line.y.push_back(*ratio);
    }
    if (line.x.empty()) return;
    points.x = line.x, points.y = line.y;
    figure.series = {line, points, {"paper, 10 GPa", {paper}, {target("UCS/UTS.10").paper}, Mark::points, 1}};
}

}  // namespace

std::vector<Figure> figures(const Reproduction& result)
{
    std::vector<Figure> out;
    if (result.curves.empty()) return out;
    const auto& curves = result.curves.front().curves;
    out.push_back(stress_strain(curves));
    add_triaxial(curves, out);
    add_fracture(curves, out);
    out.push_back(strengths(result));
    out.push_back(blank("openings_ratio", "Table 4, Fig. 21b", "K at eta = 1.5 %, pores and cracks [GPa]", "UCS/UTS",
                        "All openings of the first seed times one factor, from open cracks (left) to closed ones; "
                        "point: the paper."));
    add_trade_off(out.back(), result.openings, "K.end", target("K.end").paper);
    out.push_back(blank("bending_share", "Table 4", "UTS [MPa]", "UCS/UTS",
                        "The first seed when a falling share of the bending stress counts in Eq. 24, from 1 (left, as "
                        "printed); point: the paper."));
    add_trade_off(out.back(), result.bending, "UTS.", target("UTS.10").paper);
    std::erase_if(out, [](const Figure& figure) { return figure.empty(); });
    return out;
}

}  // namespace craze::reproduce
