#include "craze/reproduce/fit.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/hash.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/version.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/pipeline/settings_file.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace {

std::vector<Parameter> chosen(const FitSettings& settings)
{
    std::vector<Parameter> list;
    for (const auto& name : settings.parameters)
        list.push_back(*std::find_if(parameters().begin(), parameters().end(),
                                     [&](const Parameter& p) { return p.name == name; }));
    return list;
}

class Search {
public:
    Search(const synth::Settings& start, const FitSettings& settings, double box, const Place& place)
        : recipe_(start), settings_(settings), parameters_(chosen(settings)), place_(place)
    {
        const auto edge = std::max<std::int64_t>(16, std::lround(box / recipe_.voxel_size));
        recipe_.shape = {edge, edge, edge};
        study_.triaxial_points = settings.triaxial_points;
        study_.residual = 1e-4;
        // The search turns cracks: specimens without them stay as they are.
        study_.specimens = {"cracks", "both"};
        for (const char* other : {"dense", "pores"})
            if (std::any_of(settings.targets.begin(), settings.targets.end(), [&](const std::string& key) {
                    return key.find(fmt::format(".{}", other)) != std::string::npos;
                }))
                study_.specimens.emplace_back(other);
        if (settings.crossings > 0.0) {
            study_.strengths = {10e9};
            study_.crossings = settings.crossings;
        }
        for (const auto seed : settings.seeds)
            benches_.push_back(make_bench(synth::box_of(recipe_), study_, seed, false));
    }

    std::vector<double> start() const
    {
        std::vector<double> values;
        for (const auto& p : parameters_) values.push_back(p.get(recipe_));
        return values;
    }

    synth::Settings recipe_with(const std::vector<double>& values, synth::Settings recipe) const
    {
        for (std::size_t p = 0; p < parameters_.size(); ++p) parameters_[p].set(recipe, values[p]);
        return recipe;
    }

    Trial tried(const std::vector<double>& values, Progress& progress) const
    {
        synth::Settings recipe = recipe_with(values, recipe_);
        std::vector<Numbers> seeds;
        for (std::size_t s = 0; s < benches_.size(); ++s) {
            recipe.seed = settings_.seeds[s];
            seeds.push_back(candidate(recipe, benches_[s]));
            progress.advance();
        }
        Trial trial{values, statistics(seeds), 0.0};
        for (const double r : residuals(trial)) trial.misfit += r * r;
        trial.misfit = std::sqrt(trial.misfit / static_cast<double>(settings_.targets.size()));
        return trial;
    }

    std::vector<double> residuals(const Trial& trial) const
    {
        std::vector<double> r;
        for (const auto& key : settings_.targets) {
            const Target& t = target(key);
            const auto found = trial.numbers.find(key);
            if (found == trial.numbers.end())
                throw InvalidInput(fmt::format("fit.targets: \"{}\" is not measured by the short way of a fit", key));
            r.push_back((found->second.mean / t.paper - 1.0) / t.goal);
        }
        return r;
    }

    double bounded(std::size_t p, double value) const
    {
        return std::clamp(value, parameters_[p].least, parameters_[p].most);
    }
    std::size_t size() const { return parameters_.size(); }

private:
    /// Measured, or taken from where an earlier search left it.
    Numbers candidate(synth::Settings recipe, const Bench& bench) const
    {
        if (place_.folder.empty()) return measure(recipe, bench, study_).numbers;
        const auto text = pipeline::settings_json([&](Schema& schema) { describe(schema, recipe); }, false).dump();
        const auto how = fmt::format("{} {} {} {}", study_.triaxial_points, study_.crossings, study_.strengths.size(),
                                     study_.specimens.size());
        const auto file = place_.folder / "candidates" / (Hash().add(version).add(text).add(how).digest() + ".json");
        if (place_.resume && std::filesystem::exists(file))
            if (const Json kept = Json::parse(io::read_text(file), nullptr, false); kept.is_object())
                return kept.get<Numbers>();
        Numbers numbers = measure(recipe, bench, study_).numbers;
        io::write_text(file, Json(numbers).dump(1) + "\n");
        return numbers;
    }

    synth::Settings recipe_;
    FitSettings settings_;
    std::vector<Parameter> parameters_;
    std::vector<Bench> benches_;
    Study study_;
    Place place_;
};

}  // namespace

Fit fit_coating(const synth::Settings& start, const FitSettings& settings, const Place& place)
{
    check(settings);
    synth::check(start);
    if (start.generator != synth::Generator::populations || start.cracks.size() != 2 ||
        !(start.cracks[0].density > 0.0 && start.cracks[1].density > 0.0 && start.cracks[0].normals[0] > 0.0))
        throw InvalidInput(
            "fit-coating needs a recipe of the generator \"populations\" with two populations of cracks given by "
            "density: the first upright (normals about x and y), the second lying (about z)");
    synth::Settings from = start;
    for (auto& c : from.cracks) c.porosity = 0.0;  // openings as drawn: their median is a parameter
    const Search search(from, settings, settings.box, place);
    const Search slopes(from, settings, settings.slope_box, place);
    const auto per_round = static_cast<std::int64_t>((search.size() + 3) * settings.seeds.size());
    Progress progress("fit-coating: candidates", std::max<std::int64_t>(1, settings.rounds) * per_round);

    Fit fit{from, {search.tried(search.start(), progress)}, {}, settings};
    double shift = 0.05;
    for (std::int64_t round = 0; round < std::max<std::int64_t>(1, settings.rounds); ++round) {
        const Trial base = fit.path.back();
        const std::vector<double> r0 = search.residuals(base);
        // On the same seeds differences are not noise, so that slopes need no large box.
        const Trial flat = slopes.tried(base.parameters, progress);
        const std::vector<double> flat_r = slopes.residuals(flat);
        Eigen::MatrixXd J(static_cast<Eigen::Index>(r0.size()), static_cast<Eigen::Index>(search.size()));
        fit.sensitivity.clear();
        for (const auto& [key, value] : flat.numbers) fit.sensitivity[key].assign(search.size(), 0.0);
        for (std::size_t p = 0; p < search.size(); ++p) {
            auto values = base.parameters;
            values[p] = search.bounded(p, values[p] * std::exp(settings.step));
            double step = std::log(values[p] / base.parameters[p]);
            if (step < 0.5 * settings.step) {  // at its upper bound: look the other way
                values[p] = base.parameters[p] * std::exp(-settings.step);
                step = -settings.step;
            }
            const Trial turned = slopes.tried(values, progress);
            const auto r = slopes.residuals(turned);
            for (std::size_t k = 0; k < r.size(); ++k)
                J(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(p)) = (r[k] - flat_r[k]) / step;
            for (auto& [key, row] : fit.sensitivity)
                if (const auto found = turned.numbers.find(key);
                    found != turned.numbers.end() && found->second.mean > 0.0 && flat.numbers.at(key).mean > 0.0)
                    row[p] = std::log(found->second.mean / flat.numbers.at(key).mean) / step;
        }
        if (settings.rounds == 0) break;
        // Damped normal equations; a step that does not help is tried again shorter.
        const Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(r0.data(), static_cast<Eigen::Index>(r0.size()));
        bool better = false;
        for (int attempt = 0; attempt < 3 && !better; ++attempt) {
            Eigen::MatrixXd A = J.transpose() * J;
            A.diagonal() += shift * A.diagonal() + Eigen::VectorXd::Constant(A.rows(), 1e-6 * A.trace());
            const Eigen::VectorXd move = -A.ldlt().solve(J.transpose() * r);
            auto values = base.parameters;
            for (std::size_t p = 0; p < values.size(); ++p)
                values[p] =
                    search.bounded(p, values[p] * std::exp(std::clamp(move(static_cast<Eigen::Index>(p)), -0.5, 0.5)));
            const Trial next = search.tried(values, progress);
            better = next.misfit < base.misfit;
            shift *= better ? 0.3 : 8.0;
            if (better) fit.path.push_back(next);
        }
        say(fmt::format("fit-coating: round {}, misfit {:.2f} of the goals", round + 1, fit.path.back().misfit));
        if (!better) break;
    }
    fit.recipe = search.recipe_with(fit.path.back().parameters, from);
    return fit;
}

Json summary(const Fit& fit)
{
    Json path = Json::array();
    for (const auto& trial : fit.path) {
        Json numbers;
        for (const auto& [key, s] : trial.numbers) numbers[key] = {{"mean", s.mean}, {"deviation", s.deviation}};
        path.push_back({{"parameters", trial.parameters}, {"misfit", trial.misfit}, {"numbers", numbers}});
    }
    return {{"parameters", fit.settings.parameters}, {"targets", fit.settings.targets},
            {"seeds", fit.settings.seeds},           {"box_m", fit.settings.box},
            {"slope_box_m", fit.settings.slope_box}, {"path", path},
            {"sensitivity", fit.sensitivity}};
}

std::string page(const Fit& fit)
{
    const Trial& first = fit.path.front();
    const Trial& last = fit.path.back();
    std::string md = fmt::format(
        "# Fit of a coating\n\n{} seeds, cubes of {:g} um, slopes on {:g} um. Misfit {:.2f} -> {:.2f} of the "
        "goals.\n\n",
        fit.settings.seeds.size(), 1e6 * fit.settings.box, 1e6 * fit.settings.slope_box, first.misfit, last.misfit);
    md += "| parameter | meaning | start | fitted |\n|---|---|---|---|\n";
    const auto list = chosen(fit.settings);
    for (std::size_t p = 0; p < list.size(); ++p)
        md += fmt::format("| {} | {} | {:.4g} | {:.4g} |\n", list[p].name, list[p].meaning, first.parameters[p],
                          last.parameters[p]);
    md +=
        "\n| number | paper | start | fitted recipe | spread | difference | goal | "
        "|\n|---|---|---|---|---|---|---|---|\n";
    for (const auto& t : targets()) {
        const auto found = last.numbers.find(t.key);
        if (found == last.numbers.end() || t.key == "elements" || t.key == "bonds") continue;
        const bool fitted = std::count(fit.settings.targets.begin(), fit.settings.targets.end(), t.key) > 0;
        md +=
            fmt::format("| {} | {:.4g} {} | {:.4g} | {:.4g} | {:.2g} | {:+.0f} % | {:.0f} % | {} |\n", t.what, t.paper,
                        t.unit, first.numbers.at(t.key).mean, found->second.mean, found->second.deviation,
                        100.0 * (found->second.mean / t.paper - 1.0), 100.0 * t.goal, fitted ? "fitted" : "predicted");
    }
    md += "\nSensitivities d ln(number) / d ln(parameter):\n\n| number |";
    for (const auto& p : list) md += fmt::format(" {} |", p.name);
    md += "\n|---|";
    for (std::size_t p = 0; p < list.size(); ++p) md += "---|";
    for (const auto& t : targets()) {
        const auto row = fit.sensitivity.find(t.key);
        if (row == fit.sensitivity.end() || t.key == "elements" || t.key == "bonds") continue;
        md += fmt::format("\n| {} |", t.what);
        for (const double s : row->second) md += fmt::format(" {:+.2f} |", s);
    }
    return md + "\n";
}

void save(const Fit& fit, const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    io::write_text(folder / "fit.json", summary(fit).dump(1) + "\n");
    synth::Settings recipe = fit.recipe;
    io::write_text(folder / "recipe.toml", pipeline::write_settings([&](Schema& schema) {
                       schema.group("synth", "fitted coating", [&] { describe(schema, recipe); });
                   }));
    io::write_text(folder / "fit.md", page(fit));
}

}  // namespace craze::reproduce
