// What theory says of pores and cracks in an elastic solid, to set beside what the virtual loadings measure.

#pragma once

namespace craze::loading {

/// An isotropic elastic solid.
struct Elastic {
    double E = 0.0;   ///< Young's modulus, Pa
    double nu = 0.0;  ///< Poisson's ratio

    double bulk() const { return E / (3.0 * (1.0 - 2.0 * nu)); }
    double shear() const { return E / (2.0 * (1.0 + nu)); }
};

/// From bulk and shear modulus, Pa.
Elastic elastic_from(double K, double G);

/// Young's modulus of a solid with a share p of spherical pores, dilute estimate, Pa.           [Eq. 18]
double porous_modulus(const Elastic& dense, double p);

/// Upper bound of Hashin and Shtrikman (1963) for a share p of voids of any shape, statistically isotropic.
Elastic hashin_shtrikman(const Elastic& dense, double p);

/// Randomly oriented, penny-shaped open cracks of density e = sum a^3 / V that do not see each other
/// (Bristow 1960; Kachanov 1992). E0/E and K0/K are linear in e.
Elastic non_interacting_pennies(const Elastic& dense, double density);

/// The same cracks, each in the cracked medium (Budiansky and O'Connell 1976).
/// @throws InvalidInput  at densities of 9/16 and above, where this theory leaves no stiffness
Elastic self_consistent_pennies(const Elastic& dense, double density);

/// Young's modulus across a family of parallel open pennies of density e, non-interacting, Pa:
/// E0/E = 1 + 16/3 (1 - nu^2) e.
double modulus_across_pennies(const Elastic& dense, double density);

}  // namespace craze::loading
