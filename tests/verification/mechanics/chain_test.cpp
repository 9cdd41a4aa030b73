// Chains of beams against closed forms: Euler-Bernoulli beams end to end are exact at their nodes.

#include "craze/core/parallel.hpp"
#include "craze/mechanics/equilibrium.hpp"
#include "craze/mechanics/inertia.hpp"
#include "craze/mechanics/motion.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace craze::mechanics {
namespace {

const bool alone = (set_threads(1), true);

// L = 1 m, E = 200 Pa, nu = 0.3, R = 0.05 m, loads of 1e-3 N and N m.
constexpr BeamMaterial soft{200.0, 0.3, 0.05};

Constraints clamped_root()
{
    Constraints c;
    for (int k = 0; k < 6; ++k) c.impose(0, k, 0.0);
    return c;
}

class ChainOf : public testing::TestWithParam<int> {
protected:
    Lattice lattice = make_lattice(support::chain(GetParam()), soft);
    std::int32_t tip = GetParam();
    Equilibrium with(int dof, double value) const
    {
        EXPECT_TRUE(alone);
        Constraints c = clamped_root();
        c.impose(tip, dof, value);
        return equilibrate(lattice, c, rest_state(lattice), {.tolerance = 1e-12});
    }
    /// What has to act on the tip.
    double load(const Equilibrium& solved, int dof) const
    {
        return -solved.forces.force[static_cast<std::size_t>(6 * tip + dof)];
    }
};
INSTANTIATE_TEST_SUITE_P(Beams, ChainOf, testing::Values(1, 5, 20));

TEST_P(ChainOf, BendsAsACantilever)
{
    const auto solved = with(1, 0.3395305453);  // F L^3 / 3 EI
    EXPECT_NEAR(load(solved, 1) / 1e-3, 1.0, 1e-9);
    EXPECT_NEAR(solved.state.rotation(tip).z / 0.5092958179, 1.0, 1e-9);  // F L^2 / 2 EI
}

TEST_P(ChainOf, StretchesAsABar)
{
    EXPECT_NEAR(load(with(0, 6.366197724e-4), 0) / 1e-3, 1.0, 1e-9);  // F L / EA
}

TEST_P(ChainOf, TwistsAsAShaft)
{
    EXPECT_NEAR(load(with(3, 1.324169127), 3) / 1e-3, 1.0, 1e-9);  // T L / GJ
}

// The elastica, by slow driving and damping near the critical one of the first bending mode.
class Elastica : public testing::Test {
protected:
    static constexpr int beams = 40;
    // Slender, because the elastica does not stretch.
    Lattice lattice = make_lattice(support::chain(beams), {200.0, 0.3, 0.02});
    double EI = lattice.section.EI;

    Motion driven(int dof, double value) const
    {
        double mass = 0.0;
        for (const double m : inertia(lattice, Mass::uniform).mass) mass += m;
        MotionOptions options{.damping = 2.0 * 3.516 * std::sqrt(EI / mass), .free_contacts = false};
        Motion motion(lattice, options, rest_state(lattice));
        const std::int64_t steps = 30000;
        Constraints c = clamped_root();
        c.impose(beams, dof, value / (static_cast<double>(steps) * motion.step_length()));
        motion.drive(c);
        motion.advance(steps);
        c.impose(beams, dof, 0.0);
        motion.drive(c);
        motion.advance(steps);
        return motion;
    }
};

TEST_F(Elastica, UnderAnEndMomentIsAnArcOfACircle)
{
    for (const double angle : {std::numbers::pi / 2, std::numbers::pi}) {
        const Motion motion = driven(5, angle);
        const State state = motion.state();
        EXPECT_NEAR(1.0 + state.displacement(beams).x, std::sin(angle) / angle, 1e-3);
        EXPECT_NEAR(state.displacement(beams).y, (1.0 - std::cos(angle)) / angle, 1e-3);
        EXPECT_NEAR(state.rotation(beams).z, angle, 1e-6);
        EXPECT_NEAR(-motion.force()[6 * beams + 5] / (EI * angle), 1.0, 2e-3);
    }
}

// Mattiasson, Int. J. Numer. Methods Eng. 17 (1981) 145: elliptic integrals evaluated.
TEST_F(Elastica, UnderAnEndForceMeetsTheTabulatedCurve)
{
    struct Row {
        double load, shortening, deflection, rotation;
    };
    for (const Row& row : {Row{2.0, 0.16064, 0.49346, 0.78175}, Row{5.0, 0.38763, 0.71379, 1.21537}}) {
        const Motion motion = driven(1, row.deflection);
        const State state = motion.state();
        EXPECT_NEAR(-motion.force()[6 * beams + 1] / (row.load * EI), 1.0, 5e-3);
        EXPECT_NEAR(-state.displacement(beams).x, row.shortening, 1e-3);
        EXPECT_NEAR(state.rotation(beams).z, row.rotation, 2e-3);
    }
}

// A pulse along a chain of masses and springs travels at spacing sqrt(k / m) in the long-wave limit.
TEST(Chain, CarriesAWaveAtItsSpeed)
{
    constexpr int beams = 400;
    const Lattice lattice = make_lattice(support::chain(beams), soft);
    const double m = inertia(lattice, Mass::uniform).mass[0], c = std::sqrt(lattice.section.EA / (m * beams));
    Motion motion(lattice, {.step_fraction = 0.5, .free_contacts = false}, rest_state(lattice));
    // A narrow bell of velocity about the middle parts in two.
    std::vector<double> v(6 * lattice.r.size(), 0.0);
    for (std::int32_t e = 0; e <= beams; ++e)
        v[static_cast<std::size_t>(6 * e)] = 1e-6 * c * std::exp(-std::pow((lattice.centre(e).x - 0.5) / 0.03, 2));
    motion.set_velocity(v);
    while (motion.time() < 0.3 / c) motion.advance(1);
    const auto now = motion.velocity();
    double weight = 0.0, where = 0.0;
    for (std::int32_t e = beams / 2; e <= beams; ++e) {
        const double square = std::pow(now[static_cast<std::size_t>(6 * e)], 2);
        weight += square, where += square * lattice.centre(e).x;
    }
    EXPECT_NEAR((where / weight - 0.5) / motion.time() / c, 1.0, 0.002);
}

}  // namespace
}  // namespace craze::mechanics
