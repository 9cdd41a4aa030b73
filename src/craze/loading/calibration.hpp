// Which beams make the packing as stiff as the dense ceramic [3.1.2].

#pragma once

#include "craze/domain/domain.hpp"
#include "craze/loading/response.hpp"
#include "craze/loading/rig.hpp"

#include <optional>

namespace craze::loading {

struct CalibrationOptions {
    double nu_B = 0.30;                 ///< kept as it is: it hardly matters
    std::optional<double> first_guess;  ///< r~; empty: what packings of the paper's cardinality need
    double tolerance = 1e-3;            ///< on the means of E and nu over the three axes, relative
    double strain = 1e-3;               ///< of the uniaxial loadings
    RigOptions rig;                     ///< its residual is tightened to 1e-6
};

/// E_B and r~ for which uniaxial tension of the dense packing gives E_D (box strain) and nu_D (interior strain), as
/// means over x, y and z. nu depends on r~ alone and is found by secants inside a bracket, loosely until the
/// last trial; E is proportional to E_B, which follows without a trial of its own.
/// @throws ComputationFailed  when no r~ in [0.05, 1] gives nu_D, with the range there is
Calibration calibrate(const domain::Domain& dense, const mechanics::DenseMaterial& target,
                      const CalibrationOptions& options);

/// What given beams make of the packing: the same loadings, nothing changed.
Calibration measure_given(const domain::Domain& dense, const mechanics::DenseMaterial& target,
                          const mechanics::BeamMaterial& beam, const CalibrationOptions& options);

}  // namespace craze::loading
