#include "craze/core/errors.hpp"
#include "craze/core/units.hpp"
#include "craze/reproduce/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace {

double total_density(const synth::Settings& s) { return s.cracks[0].density + s.cracks[1].density; }

void scale(synth::Length& length, double factor)
{
    length.median *= factor;
    length.least *= factor;
    length.most *= factor;
}

/// A change of the median that leaves the physical bounds of openings where they are.
void set_aperture(synth::Settings& s, double value)
{
    const double factor = value / s.cracks[0].aperture.median;
    for (auto& c : s.cracks) {
        c.aperture.median *= factor;
        c.aperture.least = std::min(c.aperture.least, c.aperture.median);
        c.aperture.most = std::max(c.aperture.most, c.aperture.median);
    }
}

}  // namespace

const std::vector<Parameter>& parameters()
{
    static const std::vector<Parameter> list{
        {"density", "sum a^3 / V of all cracks", 0.02, 1.5, total_density,
         [](synth::Settings& s, double v) {
             const double factor = v / total_density(s);
             for (auto& c : s.cracks) c.density *= factor;
         }},
        {"radius", "median radius of upright cracks; lying ones in proportion, m", 0.3e-6, 4e-6,
         [](const synth::Settings& s) { return s.cracks[0].radius.median; },
         [](synth::Settings& s, double v) {
             const double factor = v / s.cracks[0].radius.median;
             for (auto& c : s.cracks) scale(c.radius, factor);
         }},
        {"across_y", "upright cracks with normals about y over those about x", 0.2, 8.0,
         [](const synth::Settings& s) { return s.cracks[0].normals[1] / s.cracks[0].normals[0]; },
         [](synth::Settings& s, double v) {
             s.cracks[0].normals = {1.0 / (1.0 + v), v / (1.0 + v), 0.0};
         }},
        {"lying", "share of the density in lying cracks", 0.02, 0.7,
         [](const synth::Settings& s) { return s.cracks[1].density / total_density(s); },
         [](synth::Settings& s, double v) {
             const double all = total_density(s);
             s.cracks[0].density = (1.0 - v) * all;
             s.cracks[1].density = v * all;
         }},
        {"aperture", "median of the greatest opening of a crack, m", 5e-9, 400e-9,
         [](const synth::Settings& s) { return s.cracks[0].aperture.median; }, set_aperture},
        {"aperture_spread", "standard deviation of its logarithm", 0.1, 1.5,
         [](const synth::Settings& s) { return s.cracks[0].aperture.spread; },
         [](synth::Settings& s, double v) {
             for (auto& c : s.cracks) c.aperture.spread = v;
         }},
    };
    return list;
}

std::vector<std::string> fitted_numbers()
{
    auto keys = FitSettings{}.targets;
    keys.emplace_back("E.pores.z");
    return keys;
}

void describe(Schema& schema, FitSettings& s)
{
    std::string known;
    for (const auto& p : parameters()) known += (known.empty() ? "" : ", ") + p.name;
    schema.texts("parameters", s.parameters, "what is searched: " + known);
    schema.texts("targets", s.targets, "keys of the numbers that are fitted; all others are predicted");
    schema.integers("seeds", s.seeds, {0, 9e15}, "coatings over which each candidate is averaged");
    schema.quantity("box", s.box, Dimension::length, {2e-6, 1e-3}, "edge of the cube on which candidates are tried");
    schema.quantity("slope_box", s.slope_box, Dimension::length, {2e-6, 1e-3}, "the same for sensitivities");
    schema.integer("rounds", s.rounds, {0, 50}, "rounds of the search; 0: sensitivities only");
    schema.number("step", s.step, {0.01, 1}, "relative change that sensitivities are measured with");
    schema.integer("triaxial_points", s.triaxial_points, {3, 200}, "points of the triaxial curves");
    schema.number("crossings", s.crossings, {0, 1000}, "wave crossings of fracture loadings; 0: none");
}

void check(const FitSettings& s)
{
    for (const auto& key : s.targets) target(key);
    for (const auto& name : s.parameters)
        if (std::none_of(parameters().begin(), parameters().end(),
                         [&](const Parameter& p) { return p.name == name; })) {
            std::vector<std::string> names;
            for (const auto& p : parameters()) names.push_back(p.name);
            const std::string near = nearest_name(name, names.data(), names.data() + names.size());
            throw InvalidInput(fmt::format("fit.parameters: \"{}\" is not known{}", name,
                                           near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
        }
    if (s.parameters.empty() || s.parameters.size() > 6)
        throw InvalidInput(fmt::format("fit.parameters: one to six are searched, got {}", s.parameters.size()));
    if (s.targets.size() < s.parameters.size())
        throw InvalidInput(
            fmt::format("fit.targets: {} numbers cannot decide {} parameters", s.targets.size(), s.parameters.size()));
    if (s.seeds.empty()) throw InvalidInput("fit.seeds: needs at least one");
}

}  // namespace craze::reproduce
