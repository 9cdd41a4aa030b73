// What two elements do to each other: pure functions of numbers, for one pair or for several at a time.
//
// Longchamp et al., J. Eur. Ceram. Soc. 44 (2024) 2522, sections 3.1, 3.4.1 and 4.3.1; the beam is that of Andre et
// al., Comput. Methods Appl. Mech. Eng. 213-216 (2012) 113. SI units. End 1 is element i, end 2 is element j of a bond,
// and t points from 1 to 2; exchanging the ends changes no result. `Real` is double or a pack of doubles (lanes.hpp).

#pragma once

#include "craze/core/multiversion.hpp"
#include "craze/core/vec3.hpp"
#include "craze/mechanics/material.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::mechanics {

/// A vector of space whose components are `Real`.
template <class Real>
struct Triple {
    Real x, y, z;

    friend CRAZE_INLINE Triple operator+(const Triple& a, const Triple& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend CRAZE_INLINE Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend CRAZE_INLINE Triple operator*(const Real& s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <class Real>
CRAZE_INLINE Real dot(const Triple<Real>& a, const Triple<Real>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
CRAZE_INLINE Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Triple<double> triple(const Vec3& a) { return {a.x, a.y, a.z}; }

/// Axial stiffness of a cylindrical beam, E pi R^2 / L. Pa, m, m -> N/m. [Eq. 6]
constexpr double axial_stiffness(double E, double R, double L) { return E * std::numbers::pi * R * R / L; }

/// Contact stiffness of two free elements, E_B R_DE pi r~^2 / 2. Pa, m, - -> N/m. [Eq. 7]
constexpr double contact_stiffness(double E_B, double R_DE, double r_tilde)
{
    return 0.5 * E_B * R_DE * std::numbers::pi * r_tilde * r_tilde;
}

/// Length below which the faces of a crack touch, L_C = L_0 - T. m. [Eq. 13]
constexpr double contact_length(double L_0, double T) { return L_0 - T; }

/// Distance below which two unbonded elements touch, m. Our reading: elements that overlap at rest start at zero force,
/// and where a crack of thickness T lies between them it has to close first.
constexpr double contact_distance(double r_1, double r_2, double d_0, double T) { return std::min(r_1 + r_2, d_0) - T; }

/// Normal force of anything that pushes and never pulls, K min(0, gap): negative where it pushes, as in a compressed
/// beam. N/m, m -> N. [Eq. 5; Fig. 14b]
template <class Real>
CRAZE_INLINE Real unilateral_force(Real K, Real gap)
{
    return gap < 0.0 ? Real(K * gap) : Real(0.0 * gap);
}

/// The section that all beams share [Eq. 3].
struct BeamSection {
    double R_B = 0.0;                         ///< radius, m
    double EA = 0.0, EI = 0.0, GJ = 0.0;      ///< N, N m2, N m2
    double area = 0.0, I_B = 0.0, J_B = 0.0;  ///< m2, m4, m4
};
constexpr BeamSection beam_section(const BeamMaterial& material, double R_DE)
{
    const double R = material.r_tilde * R_DE, A = std::numbers::pi * R * R, I = 0.25 * A * R * R;
    const double G = material.E_B / (2.0 * (1.0 + material.nu_B));
    return {R, material.E_B * A, material.E_B * I, 2.0 * G * I, A, I, 2.0 * I};
}

/// What a beam does to its ends (the force on end 2 is -F_1) and what it bears.
template <class Real>
struct BeamLoads {
    Triple<Real> F_1;       ///< force on end 1, N
    Triple<Real> M_1, M_2;  ///< moments on ends 1 and 2, N m
    Real N;                 ///< normal force, N, positive in tension
    Real T;                 ///< torque, N m
};

/// Small displacements: frame t and length L_0 of the beam at rest. Linear in its arguments.
/// @param inv_L0  1 / L_0, 1/m     @param du  u_2 - u_1, m     @param w_1, w_2  rotations of the ends, rad
template <class Real>
CRAZE_INLINE BeamLoads<Real> small_displacement_beam(const BeamSection& s, Real inv_L0, const Triple<Real>& t,
                                                     const Triple<Real>& du, const Triple<Real>& w_1,
                                                     const Triple<Real>& w_2)
{
    const Real stretch = dot(t, du), a_1 = dot(t, w_1), a_2 = dot(t, w_2);
    const Real bend = 2.0 * s.EI * inv_L0;
    const Triple<Real> psi = inv_L0 * cross(t, du);  // the turn of the chord
    const Triple<Real> sum = w_1 + w_2 - (psi + psi);
    BeamLoads<Real> out;
    out.N = s.EA * inv_L0 * stretch;
    out.T = s.GJ * inv_L0 * (a_2 - a_1);
    out.F_1 = out.N * t + (3.0 * bend * inv_L0) * cross(t, sum);
    const Real along_1 = bend * (2.0 * a_1 + a_2), along_2 = bend * (a_1 + 2.0 * a_2);
    out.M_1 = (along_1 + out.T) * t - bend * (sum + w_1 - psi);
    out.M_2 = (along_2 - out.T) * t - bend * (sum + w_2 - psi);
    return out;
}

/// Rankine stress of a beam, Pa. [Eq. 24]
/// @param N  normal force, N, signed     @param M_b  larger of the end bending moments, N m     @param T  torque, N m
inline double rankine_stress(const BeamSection& s, double N, double M_b, double T)
{
    const double sigma = N / s.area + std::abs(M_b) * s.R_B / s.I_B, tau = T * s.R_B / s.J_B;
    return 0.5 * (sigma + std::sqrt(sigma * sigma + 4.0 * tau * tau));
}

}  // namespace craze::mechanics
