// The paper's tables and figures beside ours, in one call: docs/reproduction.md.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/reproduce/candidate.hpp"
#include "craze/reproduce/fit.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace craze::reproduce {

enum class Size {
    small,  ///< a cube of 8 um, about 9000 elements: minutes
    paper,  ///< 17.61 x 13.24 x 21.22 um, about 92 000 elements
};

/// Section [reproduce].
struct Settings {
    Size size = Size::small;
    std::vector<std::int64_t> seeds{1, 2, 3};
    bool images = true;     ///< the first seed through the image chain too: stack, threshold, classes, mesh, T2
    bool calibrate = true;  ///< beams for each packing; else Table 2's
    std::int64_t triaxial_points = 15;
    std::vector<double> thicknesses{20e-9, 30e-9, 40e-9, 50e-9, 70e-9};  ///< constant, cracks only [Fig. 22]
    std::vector<double> strengths{10e9, 20e9, 30e9, 40e9, 50e9};         ///< sigma_failure, Pa [Table 4]
    double crossings = 40.0;                                             ///< wave crossings of a fracture loading
    double damping = 1.0;
    bool near_contacts = false;                               ///< see Study
    std::vector<std::string> fitted = FitSettings{}.targets;  ///< which numbers the recipe was fitted to
};
void describe(Schema& schema, Settings& settings);
/// @throws InvalidInput  naming the key
void check(const Settings& settings);

/// Edges of the box of a size, in voxels of the recipe.
std::vector<std::int64_t> shape_of(Size size, double voxel_size);

struct Reproduction {
    Settings settings;
    std::vector<Numbers> seeds;             ///< by the short way
    std::vector<loading::Response> curves;  ///< of each seed
    Numbers images;                         ///< first seed through the image chain; empty when not asked for
    double E_eq18 = 0.0, E_bound = 0.0;     ///< E for the pores alone at the mean p_DE: Eq. 18, Hashin-Shtrikman, GPa
    double seconds = 0.0;
};

/// Packs, calibrates and loads one coating for each seed. The recipe's box is set by the size.
/// @param folder  curves of every seed go to folder/seed_<n> as they come; empty: nowhere
Reproduction reproduce(const synth::Settings& recipe, const Settings& settings,
                       const std::filesystem::path& folder = {});

/// Each number: paper, ours with its spread, fitted or predicted, difference. Markdown.
std::string page(const Reproduction& result);
Json summary(const Reproduction& result);
/// reproduction.md, summary as reproduction.json, Figs. 21 and 22 as SVG and CSV.
void save(const Reproduction& result, const std::filesystem::path& folder);

}  // namespace craze::reproduce
