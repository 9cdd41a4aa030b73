// What two elements do to each other: pure functions of numbers, for one pair or for several at a time.
//
// Longchamp et al., J. Eur. Ceram. Soc. 44 (2024) 2522, sections 3.1, 3.4.1 and 4.3.1; the beam is that of Andre et
// al., Comput. Methods Appl. Mech. Eng. 213-216 (2012) 113. SI units. End 1 is element i, end 2 is element j of a bond,
// and t points from 1 to 2; exchanging the ends changes no result. `Real` is double or a pack of doubles (lanes.hpp).

#pragma once

#include "craze/core/multiversion.hpp"
#include "craze/core/vec3.hpp"
#include "craze/mechanics/lanes.hpp"
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
/// @param s       EA, EI and GJ in the precision of Real
/// @param inv_L0  1 / L_0, 1/m     @param du  u_2 - u_1, m     @param w_1, w_2  rotations of the ends, rad
template <class Real, class Section>
CRAZE_INLINE BeamLoads<Real> small_displacement_beam(const Section& s, Real inv_L0, const Triple<Real>& t,
                                                     const Triple<Real>& du, const Triple<Real>& w_1,
                                                     const Triple<Real>& w_2)
{
    const Real stretch = dot(t, du), a_1 = dot(t, w_1), a_2 = dot(t, w_2);
    const Real bend = 2.0F * s.EI * inv_L0;
    const Triple<Real> psi = inv_L0 * cross(t, du);  // the turn of the chord
    const Triple<Real> sum = w_1 + w_2 - (psi + psi);
    BeamLoads<Real> out;
    out.N = s.EA * inv_L0 * stretch;
    out.T = s.GJ * inv_L0 * (a_2 - a_1);
    out.F_1 = out.N * t + (3.0F * bend * inv_L0) * cross(t, sum);
    const Real along_1 = bend * (2.0F * a_1 + a_2), along_2 = bend * (a_1 + 2.0F * a_2);
    out.M_1 = (along_1 + out.T) * t - bend * (sum + w_1 - psi);
    out.M_2 = (along_2 - out.T) * t - bend * (sum + w_2 - psi);
    return out;
}

/// A rotation: unit quaternion w + v.
template <class Real>
struct Turn {
    Triple<Real> v;
    Real w;
};
template <class Real>
CRAZE_INLINE Triple<Real> turned(const Turn<Real>& q, const Triple<Real>& a)
{
    const Triple<Real> half = cross(q.v, a), c = half + half;
    return a + q.w * c + cross(q.v, c);
}

/// Rotations of any size. Each end carries an axis b_a, the direction of the beam at rest turned with its element;
/// bending is the angle of b_1 and b_2 with the chord t, torsion the turn of one end against the other about the axis.
///
/// The loads are minus the gradient of the energy
///     EA (L - L_0)^2 / 2 L_0 + GJ phi^2 / 2 L_0 + (2 EI / L_0) (5 - 3 t.b_1 - 3 t.b_2 + b_1.b_2),
/// phi = 2 vec(q_1* q_2) . t_0, which is that of the small-displacement beam to leading order (bending as in the
/// vector-based model of Kuzkin and Asonov, Phys. Rev. E 86 (2012) 051301): energy is conserved, rigid motion is free.
template <class Real>
struct CorotationalBeam {
    BeamLoads<Real> loads;
    Triple<Real> t;                 ///< direction 1 -> 2 now
    Real length;                    ///< L, m
    Real bending_1_2, bending_2_2;  ///< squared bending moments of the ends, N2 m2
    Real bending_energy;            ///< J
};
/// @param d_0  from end 1 to end 2 at rest, m     @param du  u_2 - u_1, m     @param q_1, q_2  rotations of the ends
template <class Real>
CRAZE_INLINE CorotationalBeam<Real> corotational_beam(const BeamSection& s, Real inv_L0, const Triple<Real>& d_0,
                                                      const Triple<Real>& du, const Turn<Real>& q_1,
                                                      const Turn<Real>& q_2)
{
    CorotationalBeam<Real> out;
    const Triple<Real> t_0 = inv_L0 * d_0, d = d_0 + du;
    out.length = root(dot(d, d));
    const Real inv_L = 1.0 / out.length;
    const Triple<Real> t = inv_L * d;
    out.t = t;
    const Triple<Real> b_1 = turned(q_1, t_0);
    // q_2 t_0 = v + c_t, of which both the turned axis and the twist are made.
    const Triple<Real> half_2 = cross(q_2.v, t_0), c_2 = half_2 + half_2;
    const Triple<Real> b_2 = t_0 + q_2.w * c_2 + cross(q_2.v, c_2);
    const Real bend = 2.0 * s.EI * inv_L0;

    const Triple<Real> sum = b_1 + b_2;
    const Real along = dot(t, sum);
    out.loads.N = s.EA * (out.length * inv_L0 - 1.0);
    const Real shear = 3.0 * bend * inv_L;
    out.loads.F_1 = (out.loads.N + shear * along) * t - shear * sum;

    // b_1 x (3 t - b_2) and b_2 x (3 t - b_1)
    const Triple<Real> chord = (3.0 * bend) * t, between = bend * cross(b_1, b_2);
    const Triple<Real> bending_1 = cross(b_1, chord) - between, bending_2 = cross(b_2, chord) + between;
    out.bending_1_2 = dot(bending_1, bending_1), out.bending_2_2 = dot(bending_2, bending_2);
    out.bending_energy = bend * (5.0 - 3.0 * along + dot(b_1, b_2));

    // The turn of end 2 in the frame of end 1, and its gradient with respect to the turn of end 2.
    const Triple<Real> v = q_2.w * t_0 + half_2;
    const Real c_t = dot(q_2.v, t_0);
    const Triple<Real> axis = c_t * q_1.v + q_1.w * v - cross(v, q_1.v);
    const Real half_phi = q_1.w * c_t - dot(q_1.v, v);
    out.loads.T = s.GJ * inv_L0 * (half_phi + half_phi);
    const Triple<Real> twist = out.loads.T * axis;
    out.loads.M_1 = bending_1 + twist;
    out.loads.M_2 = bending_2 - twist;
    return out;
}

/// Rankine stress of a beam, Pa. [Eq. 24]
/// @param N  normal force, N, signed     @param M_b  larger of the end bending moments, N m     @param T  torque, N m
/// @param bending_share  of the bending stress that counts, MotionOptions::bending_share
inline double rankine_stress(const BeamSection& s, double N, double M_b, double T, double bending_share = 1.0)
{
    const double sigma = N / s.area + bending_share * std::abs(M_b) * s.R_B / s.I_B, tau = T * s.R_B / s.J_B;
    return 0.5 * (sigma + std::sqrt(sigma * sigma + 4.0 * tau * tau));
}

}  // namespace craze::mechanics
