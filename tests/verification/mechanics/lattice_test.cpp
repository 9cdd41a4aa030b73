// Small packings against what mechanics demands of them.

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/mechanics/equilibrium.hpp"
#include "craze/mechanics/motion.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::mechanics {
namespace {

const bool alone = (set_threads(1), true);

/// Bonds that cross the disc of radius `radius` about the middle, normal to an axis, become contact beams.
domain::Domain with_penny(domain::Domain d, double radius, double T, int axis = 0)
{
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) {
        const Vec3 p = d.elements.centre(d.bonds.i[b]) - 0.5 * d.box, q = d.elements.centre(d.bonds.j[b]) - 0.5 * d.box;
        if (p[axis] * q[axis] > 0.0) continue;
        Vec3 at = p + (q - p) * (p[axis] / (p[axis] - q[axis]));
        at[axis] = 0.0;
        if (norm(at) > radius) continue;
        d.bonds.kind[b] = domain::BondKind::contact_beam;
        d.bonds.thickness[b] = T;
    }
    // Elements that straddle the crack touch when it is used up.
    for (std::size_t p = 0; p < d.near.i.size(); ++p)
        if ((d.elements.centre(d.near.i[p]) - 0.5 * d.box)[axis] *
                (d.elements.centre(d.near.j[p]) - 0.5 * d.box)[axis] <
            0.0)
            d.near.thickness[p] = T;
    return d;
}

domain::Domain without_contact_beams(domain::Domain d)
{
    domain::Bonds kept;
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) {
        if (d.bonds.kind[b] == domain::BondKind::contact_beam) continue;
        kept.i.push_back(d.bonds.i[b]), kept.j.push_back(d.bonds.j[b]);
        kept.kind.push_back(d.bonds.kind[b]), kept.thickness.push_back(0.0);
    }
    d.bonds = kept;
    return d;
}

struct Pull {
    double stress, imbalance;
    Equilibrium solved;
};
/// Stress along `axis` when the box is stretched by `strain`, sides free.
Pull pulled(const Lattice& lattice, int axis, double strain, double tolerance = 1e-8)
{
    const Face low = find_face(lattice, axis, false), high = find_face(lattice, axis, true);
    Constraints c;
    c.impose_normal(low, 0.0);
    c.impose_normal(high, strain * lattice.box[axis]);
    Vec3 affine{-0.3 * strain, -0.3 * strain, -0.3 * strain};
    affine[axis] = strain;
    auto solved = equilibrate(lattice, c, affine_state(lattice, affine), {.tolerance = tolerance});
    const double up = face_force(high, solved.forces.force), down = face_force(low, solved.forces.force);
    const double area = lattice.box.x * lattice.box.y * lattice.box.z / lattice.box[axis];
    return {0.5 * (up - down) / area, std::abs(up + down) / std::abs(up), std::move(solved)};
}

Constraints squeezed_faces(const Lattice& lattice, double strain)
{
    Constraints c;
    for (int axis = 0; axis < 3; ++axis) {
        c.impose_normal(find_face(lattice, axis, false), 0.5 * strain * lattice.box[axis]);
        c.impose_normal(find_face(lattice, axis, true), -0.5 * strain * lattice.box[axis]);
    }
    return c;
}
double pressure(const Lattice& lattice, std::span<const double> force)
{
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double area = lattice.box.x * lattice.box.y * lattice.box.z / lattice.box[axis];
        sum +=
            0.5 *
            (face_force(find_face(lattice, axis, false), force) - face_force(find_face(lattice, axis, true), force)) /
            area;
    }
    return sum / 3.0;
}

class Packing : public testing::Test {
protected:
    static void SetUpTestSuite() { dense_ = new domain::Domain(support::small_packing(1200, 11)); }
    static void TearDownTestSuite() { delete dense_; }
    static const domain::Domain& dense() { return *dense_; }
    static double half_edge() { return 0.5 * dense().box.x; }

private:
    inline static domain::Domain* dense_ = nullptr;
};

TEST_F(Packing, PullsBothFacesAlike)
{
    EXPECT_TRUE(alone);
    const Lattice lattice = make_lattice(dense(), {});
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(pulled(lattice, axis, 1e-3).imbalance, 1e-6);
}

TEST_F(Packing, IsAsStiffAsItsBeams)
{
    const double once = pulled(make_lattice(dense(), {}), 0, 1e-3).stress;
    const double twice = pulled(make_lattice(dense(), {.E_B = 2 * 5820e9}), 0, 1e-3).stress;
    EXPECT_NEAR(twice / once, 2.0, 1e-6);
    EXPECT_GT(once, 0.5 * 200e6);
}

TEST_F(Packing, InTensionFeelsContactBeamsAsIfTheyWereRemoved)
{
    const auto cracked = with_penny(dense(), 0.6 * half_edge(), 20e-9);  // wider than anything moves
    const Pull with = pulled(make_lattice(cracked, {}), 0, 1e-3);
    const Pull without = pulled(make_lattice(without_contact_beams(cracked), {}), 0, 1e-3);
    EXPECT_EQ(with.solved.forces.closed, 0);
    EXPECT_GT(with.solved.forces.open, 20);
    EXPECT_NEAR(with.stress / without.stress, 1.0, 1e-6);
    EXPECT_LT(with.stress, 0.9 * pulled(make_lattice(dense(), {}), 0, 1e-3).stress);
}

TEST_F(Packing, WithClosedCracksResistsPressureAsIfItWereDense)
{
    const Lattice whole = make_lattice(dense(), {}),
                  cracked = make_lattice(with_penny(dense(), 0.6 * half_edge(), 0.0), {});
    const auto squeeze = [](const Lattice& lattice) {
        const auto solved = equilibrate(lattice, squeezed_faces(lattice, 1e-3),
                                        affine_state(lattice, {-1e-3, -1e-3, -1e-3}, 0.5 * lattice.box));
        return pressure(lattice, solved.forces.force);
    };
    EXPECT_NEAR(squeeze(cracked) / squeeze(whole), 1.0, 0.02);
}

TEST(ContactBeam, ClosesAtExactlyItsThickness)
{
    using support::bonded;
    constexpr double T = 40e-9;
    auto d = bonded({1e-6, 4e-7, 4e-7}, {{2e-7, 2e-7, 2e-7}, {6e-7, 2e-7, 2e-7}, {10e-7, 2e-7, 2e-7}},
                    {2e-7, 2e-7, 2e-7}, {{0, 1}, {1, 2}});
    d.bonds.kind[0] = domain::BondKind::contact_beam;
    d.bonds.thickness[0] = T;
    const Lattice lattice = make_lattice(d, {});
    const double k = lattice.section.EA * lattice.inv_length[1];
    for (const double closing : {0.5 * T, T * (1 - 1e-9), T * (1 + 1e-9), 1.5 * T}) {
        Constraints c;
        for (int dof = 0; dof < 6; ++dof) c.impose(0, dof, 0.0), c.impose(2, dof, 0.0);
        c.impose(2, 0, -closing);
        const auto solved = equilibrate(lattice, c, rest_state(lattice), {.tolerance = 1e-12});
        // Two equal springs one after the other.
        EXPECT_NEAR(solved.forces.force[0], -0.5 * k * std::max(0.0, closing - T), 1e-9 * k * T) << closing;
        EXPECT_EQ(solved.forces.closed, closing > T ? 1 : 0);
    }
}

// Three pennies of different thickness close one after the other: the same curve by Newton and by slow damped motion.
TEST_F(Packing, ClosesAlongTheSameCurveInEquilibriumAndInSlowMotion)
{
    auto domain = with_penny(dense(), 0.8 * half_edge(), 2e-9, 0);
    domain = with_penny(domain, 0.7 * half_edge(), 5e-9, 1);
    const Lattice lattice = make_lattice(domain, {});

    EquilibriumSolver solver(lattice);
    State state = rest_state(lattice);
    MotionOptions options{.geometry = Geometry::small_displacement};
    const double edge = lattice.box.x, crossing = edge / 5700.0;
    options.damping = 3.0 / crossing;
    Motion motion(lattice, options, rest_state(lattice));
    const double strain_step = 1e-3, rate = strain_step / (25.0 * crossing);
    motion.set_affine_rate({-rate, -rate, -rate});
    motion.set_velocity(affine_state(lattice, {-rate, -rate, -rate}, 0.5 * lattice.box).u);
    motion.drive(squeezed_faces(lattice, rate));

    double first = 0.0, last = 0.0;
    for (int point = 1; point <= 6; ++point) {
        while (motion.time() * rate < point * strain_step) motion.advance(1);
        const double strain = motion.time() * rate;
        auto solved = solver.solve(squeezed_faces(lattice, strain), std::move(state));
        const double rest = pressure(lattice, solved.forces.force);
        EXPECT_NEAR(pressure(lattice, motion.force()) / rest, 1.0, 0.005) << strain;
        if (point == 1) first = rest / strain;
        last = rest / strain;
        state = std::move(solved.state);
    }
    EXPECT_GT(last, 1.1 * first);  // it did close
}

TEST_F(Packing, HeldNowhereIsRefused)
{
    const Lattice lattice = make_lattice(dense(), {});
    EXPECT_THROW(equilibrate(lattice, {}, rest_state(lattice)), InvalidInput);
    Lattice floating = lattice;
    for (double& x : floating.x) x += 1e-6;
    EXPECT_THROW(find_face(floating, 0, false), ComputationFailed);
}

TEST_F(Packing, ASolverThatMayNotIterateSaysHowFarItCame)
{
    const Lattice lattice = make_lattice(dense(), {});
    try {
        equilibrate(lattice, squeezed_faces(lattice, 1e-3), rest_state(lattice), {.iterations = 2});
        FAIL();
    } catch (const ComputationFailed& error) {
        EXPECT_NE(std::string(error.what()).find("the residual is"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("Try"), std::string::npos);
    }
}

}  // namespace
}  // namespace craze::mechanics
