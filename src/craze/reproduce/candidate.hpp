// One coating put through the virtual laboratory: a recipe and a seed in, the paper's numbers out.

#pragma once

#include "craze/domain/room.hpp"
#include "craze/loading/loading.hpp"
#include "craze/reproduce/targets.hpp"
#include "craze/synth/synth.hpp"

#include <filesystem>

namespace craze::reproduce {

/// Radii of the classification [2.4.3], m.
constexpr double R_C = 8.5 * 23.6e-9, R_E = 4.5 * 23.6e-9;

/// The normalised density up to which the paper reports K [4.2.2].
constexpr double eta_paper = 0.015;

/// The coating fitted to the paper's numbers: examples/coating.toml, docs/reproduction.md.
synth::Settings recipe();

/// What is measured, and how.
struct Study {
    std::vector<std::string> specimens{"dense", "pores", "cracks", "both"};
    bool moduli = true;                 ///< Table 3
    std::int64_t uniaxial_points = 0;   ///< points of each stress-strain curve; 0: none [Fig. 18]
    std::int64_t triaxial_points = 15;  ///< points to `eta`; 0: none [Fig. 21]
    double eta = eta_paper;             ///< largest normalised density of the triaxial curves
    bool closed = false;                ///< dense and closed cracks under triaxial compression too [Fig. 21]
    std::vector<double> thicknesses;    ///< constant thicknesses, cracks only, m [Fig. 22]
    std::vector<double> strengths;      ///< sigma_failure, Pa, along x [Table 4]
    double tension = 1.5e-3;            ///< strain at the end of a tension with bonds of 10 GPa; others in proportion
    double compression = 4.5e-3;        ///< and of a compression
    double crossings = 40.0;            ///< of fracture loadings: wave crossings per strain of sigma_failure / E_B
    double damping = 0.0;               ///< mass damping beside the local one
    double bending_share = 1.0;         ///< of a beam's bending stress that counts towards its strength [Eq. 24]
    std::vector<double>
        cycles;  ///< peaks of strain of a cycled loading at the first strength; none: no cycles [Fig. 25]
    /// Let unbonded neighbours push [Eq. 5]. Our reading: off in states of rest. The paper's dense and porous samples
    /// are linear in compression; with these contacts they stiffen by a tenth (docs/reproduction.md).
    bool near_contacts = false;
    /// Thickness and cuts as the image chain would see them: thin openings lost, cracks drawn back from their rims by
    /// two voxels, and counted as pores within R_E of one. Else as they are.
    bool as_seen = true;
    double threshold = 111.0;  ///< S that the microscope's gray levels lead to
    double residual = 1e-5;    ///< of equilibrium
    domain::Settings domain;
};

/// A dense domain of the recipe's box and the beams that make it as stiff as the ceramic: shared by all candidates.
struct Bench {
    domain::Domain dense;
    loading::Calibration calibration;
    double R_DE = 0.0;  ///< m
};
/// @param calibrate  false: Table 2's beams
Bench make_bench(const Vec3& box, const Study& study, std::int64_t seed, bool calibrate);

/// The elastic loadings of a study, with the bench's beams.
loading::Settings laboratory(const Study& study, const loading::Calibration& calibration);
/// One laboratory for each strength of the bonds, and one for cycles.
std::vector<loading::Settings> fracture_laboratories(const Study& study, const loading::Calibration& calibration);

struct Candidate {
    domain::Discretisation discretisation;
    loading::Response response;
    Numbers numbers;  ///< keys of targets()
};

/// Where the loadings of a coating are kept as they come, so that stopped work can go on.
struct Keep {
    std::filesystem::path folder;  ///< empty: nowhere
    std::string key;               ///< of all that decides them
    bool resume = false;           ///< take what was finished under the same key
};

/// The recipe and its seed, by the short way.
Candidate measure(const synth::Settings& recipe, const Bench& bench, const Study& study, const Keep& keep = {});
/// The numbers of a discretisation and of what its loadings gave, without porosities.
Numbers numbers_of(const domain::Discretisation& discretisation, const loading::Response& response, const Study& study);

/// One specimen when one thing is changed.
struct Variant {
    double value = 1.0;  ///< of what is changed
    Numbers numbers;     ///< of that specimen
};
/// The specimen with pores and cracks when all openings are a factor times what they are (0: closed cracks): T2, K and
/// the strengths of the study. What cannot be had together: open cracks are soft, closed ones make a specimen stronger
/// in compression than in tension. By the short way, for each factor.
std::vector<Variant> by_opening(const synth::Settings& recipe, const Bench& bench, const Study& study,
                                const std::vector<double>& factors, const Keep& keep = {});

/// The strengths of the same specimen when only a share of a beam's bending stress counts [Eq. 24].
std::vector<Variant> by_bending_share(const synth::Settings& recipe, const Bench& bench, const Study& study,
                                      const std::vector<double>& shares, const Keep& keep = {});

/// The constant thickness whose P(eta) is nearest to the T2 curve of the cracks-only specimen up to a density, m: least
/// squares, P taken as linear between the thicknesses tried. 0 where the response has no such curves. [4.2.3]
/// Our reading: the paper does not say up to which density it compares; the thickness grows with it, because T2's thin
/// openings close first and its wide ones last.
double equivalent_thickness(const loading::Response& response, std::vector<double> thicknesses, double eta);

}  // namespace craze::reproduce
