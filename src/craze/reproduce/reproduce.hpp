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
    bool images = true;                 ///< the first seed through the whole image chain too
    std::int64_t search = 21;           ///< window of non-local means, px; smaller is faster [2.3 (3)]
    bool calibrate = true;              ///< beams for each packing; else Table 2's
    std::int64_t uniaxial_points = 8;   ///< 0: none [Fig. 18]
    std::int64_t triaxial_points = 30;  ///< [Figs. 21, 22]
    double eta = 3.0 * eta_paper;       ///< largest normalised density of the triaxial curves; Fig. 21 shows eta_paper
    std::vector<double> thicknesses{2e-9,  10e-9, 20e-9, 30e-9,
                                    40e-9, 60e-9, 100e-9};        ///< constant, cracks only [Fig. 22]
    std::vector<double> strengths{10e9, 20e9, 30e9, 40e9, 50e9};  ///< sigma_failure, Pa [Table 4]
    double tension = 1.5e-3, compression = 4.5e-3;                ///< see Study
    double crossings = 40.0;  ///< of a fracture loading: wave crossings per strain of sigma_failure / E_B
    double damping = 0.0;     ///< mass damping beside the local one
    std::vector<double> cycles{-1e-3, -2e-3, -3e-3};     ///< peaks of strain, first seed only [Fig. 25]
    double bending_share = 1.0;                          ///< see Study
    std::vector<double> openings;                        ///< factors for by_opening, first seed; none: not run
    std::vector<double> bending_shares;                  ///< for by_bending_share, first seed; none: not run
    bool near_contacts = false;                          ///< see Study
    double threshold = Study{}.threshold;                ///< S of the short way, gray level; see Study
    std::vector<std::string> fitted = fitted_numbers();  ///< which numbers the recipe was fitted to
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
    std::vector<Variant> openings;          ///< by factor: the first seed at the first strength of bonds
    std::vector<Variant> bending;           ///< by share: likewise
    Numbers images;                         ///< first seed through the image chain; empty when not asked for
    double E_eq18 = 0.0, E_bound = 0.0;     ///< E for the pores alone at the mean p_DE: Eq. 18, Hashin-Shtrikman, GPa
    double seconds = 0.0;
};

/// Packs, calibrates and loads one coating for each seed by the short way, into <folder>/reproduce/seed_<n>; the first
/// seed goes through the image chain too, into the folder's rooms. The recipe's box is set by the size.
/// @throws InvalidInput  when the settings are wrong, before any work starts
Reproduction reproduce(const synth::Settings& recipe, const Settings& settings, const Place& place = {});

/// Each number: paper, ours with its spread, fitted or predicted, difference. Markdown.
std::string page(const Reproduction& result);
Json summary(const Reproduction& result);
/// reproduction.md, summary as reproduction.json, Figs. 18 and 21 to 25 as SVG and CSV.
void save(const Reproduction& result, const std::filesystem::path& folder);

}  // namespace craze::reproduce
