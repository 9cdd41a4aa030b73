// Which coating has the paper's numbers? A search over few parameters of its cracks, by the short way:
// the authors' volume is not public. Says what was fitted, what is left, and what hangs on what.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/reproduce/candidate.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace craze::reproduce {

/// Something of a recipe that can be turned: positive, and worked on through its logarithm.
struct Parameter {
    std::string name;
    std::string meaning;
    double least, most;
    double (*get)(const synth::Settings&);
    void (*set)(synth::Settings&, double);
};
/// density, radius, across_y, lying, aperture, aperture_spread. They ask for a recipe with two populations of cracks:
/// the first stands upright (normals about x and y), the second lies (normals about z).
const std::vector<Parameter>& parameters();

struct FitSettings {
    std::vector<std::string> parameters{"density", "radius", "across_y", "lying", "aperture", "aperture_spread"};
    std::vector<std::string> targets{"porosity.cracks", "T2.median",    "T2.most",  "E.cracks.x",
                                     "E.cracks.y",      "E.cracks.z",   "E.both.x", "E.both.y",
                                     "E.both.z",        "ratio.cracks", "K.start",  "K.end"};
    std::vector<std::int64_t> seeds{1, 2};
    double box = 12e-6;       ///< edge of the cube on which candidates are tried, m
    double slope_box = 7e-6;  ///< and of the one on which a parameter is turned to see what hangs on it
    std::int64_t rounds = 2;  ///< of the search; 0: sensitivities at the start only
    double step = 0.25;       ///< change of the logarithm of a parameter that its sensitivity is measured with
    std::int64_t triaxial_points = 4;
    double crossings = 0.0;  ///< above 0: strengths at 10 GPa too, in every candidate
};
/// The numbers that recipe() was chosen with an eye on: those of the search, and E along z of the pores, which made the
/// irregular ones lie any way.
std::vector<std::string> fitted_numbers();
void describe(Schema& schema, FitSettings& settings);
/// @throws InvalidInput  naming the key
void check(const FitSettings& settings);

/// One candidate: parameters and the mean of its numbers over the seeds.
struct Trial {
    std::vector<double> parameters;  ///< as FitSettings::parameters
    std::map<std::string, Statistic> numbers;
    double misfit = 0.0;  ///< root mean square over the targets of (ours / paper - 1) / goal
};

/// Where work stands on disk.
struct Place {
    std::filesystem::path folder;  ///< empty: nothing is written
    bool resume = false;           ///< take what was finished with the same recipe and settings
};

struct Fit {
    synth::Settings recipe;   ///< the best, with the box that the search was given
    std::vector<Trial> path;  ///< best so far, after each round; the first is the start
    /// d ln(number) / d ln(parameter) at the last but one of the path: row per number, column per parameter.
    std::map<std::string, std::vector<double>> sensitivity;
    FitSettings settings;
};

/// Least squares on the logarithms of the parameters (Gauss-Newton, damped by Levenberg and Marquardt), each candidate
/// on the same seeds so that differences are not noise; slopes are measured on a smaller cube.
/// @param place  candidates are kept in <folder>/candidates as they come; a search that goes on takes them from there
/// @throws InvalidInput  when the recipe has not the populations that the parameters ask for
Fit fit_coating(const synth::Settings& start, const FitSettings& settings, const Place& place = {});

/// fit.json, recipe.toml (section [synth], ready for use) and fit.md in `folder`.
void save(const Fit& fit, const std::filesystem::path& folder);
Json summary(const Fit& fit);
/// A table of what was fitted, the residuals and the sensitivities, in Markdown.
std::string page(const Fit& fit);

}  // namespace craze::reproduce
