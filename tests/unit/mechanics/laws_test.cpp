#include "craze/mechanics/laws.hpp"

#include "craze/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace craze::mechanics {
namespace {

using T3 = Triple<double>;
using Q = Turn<double>;

// Table 2 of the paper and R_DE = 200 nm.
constexpr BeamMaterial ceramic{};
constexpr double R_DE = 200e-9, L_0 = 400e-9;
constexpr BeamSection section = beam_section(ceramic, R_DE);

double length(const T3& a) { return std::sqrt(dot(a, a)); }
void expect_near(const T3& a, const T3& b, double tolerance)
{
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

T3 random_vector(Random& random, double size)
{
    return {size * random.uniform(-1, 1), size * random.uniform(-1, 1), size * random.uniform(-1, 1)};
}
T3 random_direction(Random& random)
{
    const T3 v = random_vector(random, 1.0);
    return (1.0 / length(v)) * v;
}
Q turn(const T3& axis, double angle) { return {std::sin(0.5 * angle) * axis, std::cos(0.5 * angle)}; }
Q after(const Q& second, const Q& first)
{
    return {second.w * first.v + first.w * second.v + cross(second.v, first.v),
            second.w * first.w - dot(second.v, first.v)};
}
Q small_turn(const T3& w)
{
    const double angle = length(w);
    return angle > 0.0 ? turn((1.0 / angle) * w, angle) : Q{{0, 0, 0}, 1.0};
}

/// A bond of arbitrary direction whose ends are displaced and turned.
struct Pose {
    T3 t, u_1, u_2;
    Q q_1, q_2;
    double L_0 = 400e-9;

    CorotationalBeam<double> beam() const
    {
        return corotational_beam(section, 1.0 / L_0, L_0 * t, u_2 - u_1, q_1, q_2);
    }
    double energy() const
    {
        const auto b = beam();
        return 0.5 * L_0 * (b.loads.N * b.loads.N / section.EA + b.loads.T * b.loads.T / section.GJ) + b.bending_energy;
    }
};
Pose random_pose(Random& random, double strain, double angle)
{
    const T3 t = random_direction(random);
    return {t, random_vector(random, strain * L_0), random_vector(random, strain * L_0),
            turn(random_direction(random), angle * random.uniform()),
            turn(random_direction(random), angle * random.uniform())};
}

TEST(ContactStiffness, IsEquation6OfTheMeanBeam)
{
    const double K_C = contact_stiffness(ceramic.E_B, R_DE, ceramic.r_tilde);
    EXPECT_NEAR(K_C / axial_stiffness(ceramic.E_B, ceramic.r_tilde * R_DE, 2 * R_DE), 1.0, 1e-14);
    EXPECT_NEAR(K_C, 2.176e5, 0.001e5);  // N/m, by hand from Table 2
}

TEST(ContactBeam, PushesBelowItsContactLengthAndNeverPulls)
{
    const double K_B = axial_stiffness(ceramic.E_B, section.R_B, 400e-9), L_C = contact_length(400e-9, 40e-9);
    EXPECT_EQ(unilateral_force(K_B, 500e-9 - L_C), 0.0);
    EXPECT_EQ(unilateral_force(K_B, 400e-9 - L_C), 0.0);
    EXPECT_EQ(unilateral_force(K_B, 361e-9 - L_C), 0.0);
    EXPECT_NEAR(unilateral_force(K_B, 350e-9 - L_C) / (-K_B * 10e-9), 1.0, 1e-12);
}

TEST(ContactBeam, OfZeroThicknessIsTheCompressiveHalfOfTheBeam)
{
    const double K_B = axial_stiffness(ceramic.E_B, section.R_B, L_0);
    for (const double opening : {-10e-9, -1e-9, 1e-9, 10e-9}) {
        const auto beam = small_displacement_beam<double>(section, 1.0 / L_0, {1, 0, 0}, {opening, 0, 0}, {}, {});
        EXPECT_NEAR(unilateral_force(K_B, opening + L_0 - contact_length(L_0, 0.0)), std::min(0.0, beam.N),
                    1e-12 * std::abs(beam.N));
    }
}

TEST(FreeContact, StartsAtZeroForceHoweverMuchElementsOverlapAtRest)
{
    EXPECT_EQ(contact_distance(200e-9, 210e-9, 405e-9, 0.0), 405e-9);
    EXPECT_EQ(contact_distance(200e-9, 210e-9, 450e-9, 0.0), 410e-9);
    EXPECT_NEAR(contact_distance(200e-9, 210e-9, 405e-9, 40e-9), 365e-9, 1e-20);  // the crack has to close first
}

// Textbook values of one clamped beam: N = EA d / L, T = GJ phi / L, and of bending and shear 12 EI/L^3, 6 EI/L^2, 4
// EI/L.
TEST(Beam, BearsTensionTorsionBendingAndShearAsByHand)
{
    const double inv = 1.0 / L_0, EI = section.EI;
    const T3 x{1, 0, 0}, none{0, 0, 0};
    const auto pulled = small_displacement_beam<double>(section, inv, x, {1e-9, 0, 0}, none, none);
    EXPECT_NEAR(pulled.N, section.EA * 1e-9 / L_0, 1e-18);
    expect_near(pulled.F_1, {pulled.N, 0, 0}, 1e-18);

    const auto twisted = small_displacement_beam<double>(section, inv, x, none, none, {1e-3, 0, 0});
    EXPECT_NEAR(twisted.T / (section.GJ * 1e-3 / L_0), 1.0, 1e-14);
    expect_near(twisted.M_1, {twisted.T, 0, 0}, 1e-25);
    expect_near(twisted.M_2, {-twisted.T, 0, 0}, 1e-25);

    const auto sheared = small_displacement_beam<double>(section, inv, x, {0, 1e-9, 0}, none, none);
    const double Q_y = 12 * EI * 1e-9 / std::pow(L_0, 3), M_z = 6 * EI * 1e-9 / std::pow(L_0, 2);
    expect_near(sheared.F_1, {0, Q_y, 0}, 1e-12 * Q_y);
    expect_near(sheared.M_1, {0, 0, M_z}, 1e-12 * M_z);
    expect_near(sheared.M_2, {0, 0, M_z}, 1e-12 * M_z);

    const auto bent = small_displacement_beam<double>(section, inv, x, none, none, {0, 0, 1e-3});
    expect_near(bent.M_2, {0, 0, -4 * EI * 1e-3 / L_0}, 1e-12 * EI / L_0);
    expect_near(bent.M_1, {0, 0, -2 * EI * 1e-3 / L_0}, 1e-12 * EI / L_0);
    expect_near(bent.F_1, {0, -6 * EI * 1e-3 / (L_0 * L_0), 0}, 1e-12 * EI / (L_0 * L_0));
}

TEST(Rankine, IsTensionForPureTensionAndTheTorsionStressForPureTorsion)
{
    const double A = std::numbers::pi * section.R_B * section.R_B;
    EXPECT_NEAR(rankine_stress(section, 1e-3, 0, 0) / (1e-3 / A), 1.0, 1e-14);
    EXPECT_NEAR(rankine_stress(section, -1e-3, 0, 0), 0.0, 1e-3 / A * 1e-14);  // compression alone never breaks
    const double R3 = std::pow(section.R_B, 3);
    EXPECT_NEAR(rankine_stress(section, 0, 0, 1e-12) / (2e-12 / (std::numbers::pi * R3)), 1.0, 1e-14);
    EXPECT_NEAR(rankine_stress(section, 0, 1e-12, 0) / (4e-12 / (std::numbers::pi * R3)), 1.0, 1e-14);
    EXPECT_NEAR(rankine_stress(section, 1e-3, 1e-12, 0, 0.25) / (1e-3 / A + 1e-12 / (std::numbers::pi * R3)), 1.0,
                1e-14);
    // sigma = 3, tau = 2 in units of one Pa: (3 + 5) / 2.
    EXPECT_NEAR(rankine_stress(section, 3.0 * A, 0, 2.0 * std::numbers::pi * R3 / 2.0), 4.0, 1e-12);
}

TEST(CorotationalBeam, ForcesAreMinusTheGradientOfTheEnergy)
{
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const Pose pose = random_pose(random, 0.3, trial < 10 ? 0.05 : 1.2);
        const auto loads = pose.beam().loads;
        const auto slope = [&](const std::function<void(Pose&, double)>& move, double h) {
            Pose plus = pose, minus = pose;
            move(plus, h), move(minus, -h);
            return (plus.energy() - minus.energy()) / (2 * h);
        };
        const double force = length(loads.F_1), moment = length(loads.M_1) + length(loads.M_2);
        for (int axis = 0; axis < 3; ++axis) {
            const T3 e{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
            const double h = 1e-5 * L_0;
            EXPECT_NEAR(slope([&](Pose& p, double s) { p.u_1 = p.u_1 + s * e; }, h), -dot(loads.F_1, e), 1e-7 * force);
            EXPECT_NEAR(slope([&](Pose& p, double s) { p.u_2 = p.u_2 + s * e; }, h), dot(loads.F_1, e), 1e-7 * force);
            EXPECT_NEAR(slope([&](Pose& p, double s) { p.q_1 = after(small_turn(s * e), p.q_1); }, 1e-4),
                        -dot(loads.M_1, e), 1e-6 * moment);
            EXPECT_NEAR(slope([&](Pose& p, double s) { p.q_2 = after(small_turn(s * e), p.q_2); }, 1e-4),
                        -dot(loads.M_2, e), 1e-6 * moment);
        }
    }
}

TEST(CorotationalBeam, IsFreeUnderRigidMotionOfAnySize)
{
    Random random(5);
    const double scale = section.EA;
    for (int trial = 0; trial < 20; ++trial) {
        const T3 t = random_direction(random), jump = random_vector(random, 1e-6);
        const Q q = turn(random_direction(random), 3.0 * random.uniform());
        const T3 end = L_0 * t;
        const Pose pose{t, jump, jump + turned(q, end) - end, q, q};
        const auto loads = pose.beam().loads;
        EXPECT_LT(length(loads.F_1), 1e-13 * scale);
        EXPECT_LT(length(loads.M_1) + length(loads.M_2), 1e-13 * scale * L_0);
    }
}

TEST(CorotationalBeam, GivesTheSameWhenItsEndsAreExchanged)
{
    Random random(7);
    for (int trial = 0; trial < 20; ++trial) {
        const Pose pose = random_pose(random, 0.2, 1.0);
        const Pose other{-1.0 * pose.t, pose.u_2, pose.u_1, pose.q_2, pose.q_1};
        const auto a = pose.beam(), b = other.beam();
        const double force = length(a.loads.F_1), moment = length(a.loads.M_1);
        expect_near(a.loads.F_1, -1.0 * b.loads.F_1, 1e-12 * force);
        expect_near(a.loads.M_1, b.loads.M_2, 1e-12 * moment);
        expect_near(a.loads.M_2, b.loads.M_1, 1e-12 * moment);
        EXPECT_NEAR(a.bending_1_2, b.bending_2_2, 1e-12 * a.bending_1_2);
    }
}

TEST(CorotationalBeam, TurnsWithItsFrame)
{
    Random random(9);
    for (int trial = 0; trial < 20; ++trial) {
        const Pose pose = random_pose(random, 0.2, 1.0);
        const Q frame = turn(random_direction(random), 2.0);
        const Q back{-1.0 * frame.v, frame.w};
        const auto seen = [&](const Q& q) { return after(after(frame, q), back); };
        const Pose moved{turned(frame, pose.t), turned(frame, pose.u_1), turned(frame, pose.u_2), seen(pose.q_1),
                         seen(pose.q_2)};
        const auto a = pose.beam().loads, b = moved.beam().loads;
        expect_near(turned(frame, a.F_1), b.F_1, 1e-12 * length(a.F_1));
        expect_near(turned(frame, a.M_1), b.M_1, 1e-12 * length(a.M_1));
        expect_near(turned(frame, a.M_2), b.M_2, 1e-12 * length(a.M_2));
    }
}

TEST(CorotationalBeam, LeavesNoForceAndNoMomentOnItsPair)
{
    Random random(11);
    const Pose pose = random_pose(random, 0.2, 1.0);
    const auto loads = pose.beam().loads;
    const T3 arm = L_0 * pose.t + pose.u_2 - pose.u_1;
    expect_near(loads.M_1 + loads.M_2, cross(arm, loads.F_1), 1e-12 * length(loads.M_1));
}

// The difference between the two geometries must vanish with the square of the motion.
TEST(CorotationalBeam, BecomesTheSmallDisplacementBeam)
{
    std::array<double, 2> difference{};
    for (std::size_t k = 0; k < 2; ++k) {
        const double size = k == 0 ? 1e-3 : 1e-4;
        Random random(13);
        const T3 t = random_direction(random), du = random_vector(random, size * L_0),
                 w_1 = random_vector(random, size), w_2 = random_vector(random, size);
        const auto small = small_displacement_beam<double>(section, 1.0 / L_0, t, du, w_1, w_2);
        const auto large = corotational_beam(section, 1.0 / L_0, L_0 * t, du, small_turn(w_1), small_turn(w_2)).loads;
        difference[k] =
            length(small.F_1 - large.F_1) + length(small.M_1 - large.M_1) / L_0 + length(small.M_2 - large.M_2) / L_0;
    }
    EXPECT_GT(difference[0], 0.0);
    EXPECT_NEAR(difference[0] / difference[1], 100.0, 5.0);
}

TEST(SmallDisplacementBeam, IsFreeUnderItsSixRigidModes)
{
    Random random(15);
    for (int trial = 0; trial < 20; ++trial) {
        const T3 t = random_direction(random), w = random_vector(random, 1e-3);
        const auto loads = small_displacement_beam<double>(section, 1.0 / L_0, t, cross(w, L_0 * t), w, w);
        EXPECT_LT(length(loads.F_1), 1e-15 * section.EA);
        EXPECT_LT(length(loads.M_1) + length(loads.M_2), 1e-15 * section.EA * L_0);
    }
}

}  // namespace
}  // namespace craze::mechanics
