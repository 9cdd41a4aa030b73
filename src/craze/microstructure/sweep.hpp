// The radii R_C and R_E chosen by measures instead of by eye [2.4.3].
//
// First R_C = R_E run over all radii, then R_E alone at the chosen R_C, as in the paper. The measures are what the eye
// looks for there: thin elongated objects left among the pores, and parasitic shells of cracks around pores.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/images/gray.hpp"
#include "craze/microstructure/microstructure.hpp"
#include "craze/microstructure/porosity.hpp"

#include <filesystem>
#include <vector>

namespace craze::microstructure {

/// One classification.
struct SweepRow {
    double R_C = 0.0, R_E = 0.0;  ///< px
    Porosity porosity;
    std::int64_t pores = 0, cracks = 0;  ///< 26-connected objects
    /// Share of the closed pores (img. 1a) in objects whose longest semi-axis exceeds 4 times their inscribed radius.
    double thin_share = 0.0;
    /// Share of the cracks in objects that as a whole lie within 0.75 R_C of the closed pores: what a ball cannot reach
    /// at edges and corners of a pore ends nearer than that.
    double shell_share = 0.0;
};

struct Sweep {
    std::vector<SweepRow> closing;  ///< R_C = R_E
    std::vector<SweepRow> erosion;  ///< R_E at the proposed R_C
    double R_C = 0.0, R_E = 0.0;    ///< px, proposed
};

/// Proposes the smallest R_C whose thin share is at most `sweep.thin_share`, then the smallest R_E up to it whose shell
/// share is at most `sweep.shell_share`. Where none is, the radius with the smallest share, with a notice.
/// @throws InvalidInput  when there is no void at all
Sweep swept(const Mask& matter, const Settings& settings);

/// `sweep_R_C.csv`, `sweep_R_E.csv` and pictures of the middle slice of all classifications, `sweep_R_C.png`,
/// `sweep_R_E.png`: pores blue, cracks red, the proposed radius framed.
void save(const Sweep& sweep, const images::Gray& gray, const Mask& matter, const Settings& settings,
          const std::filesystem::path& folder);

Json summary(const Sweep& sweep);

}  // namespace craze::microstructure
