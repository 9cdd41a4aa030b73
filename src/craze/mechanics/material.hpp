// What beams are made of.

#pragma once

namespace craze::mechanics {

/// Micro-parameters of the cohesive beams [Table 2]; the defaults are the paper's for 8YSZ.
struct BeamMaterial {
    double E_B = 5820e9;     ///< Young's modulus of a beam, Pa
    double nu_B = 0.30;      ///< Poisson's ratio of a beam
    double r_tilde = 0.345;  ///< R_B / R_DE [Eq. 3]
};

/// Macro-parameters of the dense ceramic [Table 1]; the defaults are the paper's for 8YSZ.
struct DenseMaterial {
    double E_D = 223e9;     ///< Young's modulus, Pa
    double nu_D = 0.29;     ///< Poisson's ratio
    double rho_D = 6060.0;  ///< density, kg/m3
};

}  // namespace craze::mechanics
