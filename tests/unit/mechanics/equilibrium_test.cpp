#include "craze/mechanics/equilibrium.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/mechanics/coarse_space.hpp"
#include "craze/mechanics/multilevel.hpp"
#include "craze/mechanics/single_stiffness.hpp"
#include "craze/mechanics/stiffness.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

namespace craze::mechanics {
namespace {

const bool alone = (set_threads(1), true);

domain::Domain cracked(int n, std::uint64_t seed)
{
    auto d = support::small_packing(n, seed);
    for (std::size_t b = 0; b < d.bonds.i.size(); b += 6) {
        d.bonds.kind[b] = domain::BondKind::contact_beam;
        d.bonds.thickness[b] = b % 4 == 0 ? 0.0 : 0.2e-9;
    }
    return d;
}

Constraints squeezed(const Lattice& lattice, double strain)
{
    Constraints c;
    c.impose_normal(find_face(lattice, 2, false), 0.0);
    c.impose_normal(find_face(lattice, 2, true), -strain * lattice.box.z);
    return c;
}

State shaken(const Lattice& lattice, double size)
{
    State state = rest_state(lattice);
    Random random(7);
    for (std::size_t k = 0; k < state.u.size(); ++k)
        state.u[k] = size * (k % 6 < 3 ? lattice.mean_radius : 1.0) * random.uniform(-1, 1);
    return state;
}

TEST(Forces, AreMinusTheGradientOfTheEnergy)
{
    ASSERT_TRUE(alone);
    const Lattice lattice = make_lattice(cracked(60, 1), {});
    State state = shaken(lattice, 0.01);
    const Forces at = forces(lattice, state);
    EXPECT_GT(at.closed, 5);
    for (std::size_t k = 0; k < state.u.size(); k += 7) {
        const double h = 1e-6 * (k % 6 < 3 ? lattice.mean_radius : 1.0), u = state.u[k];
        state.u[k] = u + h;
        const double more = forces(lattice, state).energy;
        state.u[k] = u - h;
        const double less = forces(lattice, state).energy;
        state.u[k] = u;
        EXPECT_NEAR(at.force[k], -(more - less) / (2 * h), 1e-5 * at.scale * (k % 6 < 3 ? 1.0 : lattice.mean_radius))
            << k;
    }
}

TEST(Stiffness, IsSymmetricAndGivesTheSameBitsOnAnyNumberOfThreads)
{
    const Lattice lattice = make_lattice(cracked(900, 2), {});
    const State a = shaken(lattice, 0.01);
    State b = a;
    std::reverse(b.u.begin(), b.u.end());
    std::vector<double> first(a.u.size()), f(a.u.size()), g(a.u.size());
    for (const int team : {1, 2, 3}) {
        set_threads(team);
        Stiffness stiffness(lattice, lattice.kind);
        Springs springs;
        for (std::int32_t p = 0; p < lattice.free.size(); p += 2) {
            const auto k = static_cast<std::size_t>(p);
            springs.add(lattice.free.i[k], lattice.free.j[k],
                        {lattice.free.tx[k], lattice.free.ty[k], lattice.free.tz[k]}, 1e5);
        }
        stiffness.set_springs(springs);
        stiffness.apply(a.u, f);
        stiffness.apply(b.u, g);
        if (team == 1) first = f;
        EXPECT_EQ(std::memcmp(first.data(), f.data(), f.size() * sizeof(double)), 0) << team;
    }
    set_threads(1);
    const double bfa = std::inner_product(b.u.begin(), b.u.end(), f.begin(), 0.0);
    const double afb = std::inner_product(a.u.begin(), a.u.end(), g.begin(), 0.0);
    EXPECT_NEAR(bfa / afb, 1.0, 1e-11);
}

/// Solves the free degrees of freedom by elimination on the dense matrix.
std::vector<double> eliminated(const Lattice& lattice, const Constraints& c)
{
    const auto n = 6 * lattice.r.size();
    const Stiffness stiffness(lattice, lattice.kind);
    std::vector<double> u(n, 0.0), column(n), unit(n, 0.0);
    std::vector<std::vector<double>> K(n, std::vector<double>(n + 1, 0.0));
    for (std::size_t k = 0; k < n; ++k) {
        unit[k] = 1.0;
        stiffness.apply(unit, column);
        unit[k] = 0.0;
        for (std::size_t r = 0; r < n; ++r) K[r][k] = column[r];
    }
    for (std::size_t m = 0; m < c.dof.size(); ++m) {
        const auto k = static_cast<std::size_t>(c.dof[m]);
        for (std::size_t r = 0; r < n; ++r) K[r][n] -= K[r][k] * c.value[m], K[r][k] = K[k][r] = 0.0;
    }
    for (std::size_t m = 0; m < c.dof.size(); ++m) {
        const auto k = static_cast<std::size_t>(c.dof[m]);
        K[k][k] = 1.0, K[k][n] = c.value[m];
    }
    for (std::size_t k = 0; k < n; ++k) {
        if (K[k][k] == 0.0) K[k][k] = 1.0;  // without bonds
        for (std::size_t r = k + 1; r < n; ++r) {
            const double s = K[r][k] / K[k][k];
            if (s == 0.0) continue;
            for (std::size_t m = k; m <= n; ++m) K[r][m] -= s * K[k][m];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        double sum = K[k][n];
        for (std::size_t m = k + 1; m < n; ++m) sum -= K[k][m] * u[m];
        u[k] = sum / K[k][k];
    }
    return u;
}

TEST(Equilibrium, IsThatOfEliminationOnTheDenseMatrix)
{
    const Lattice lattice = make_lattice(support::small_packing(70, 3), {});
    Constraints c = squeezed(lattice, 1e-3);
    for (int axis = 0; axis < 2; ++axis) c.impose_normal(find_face(lattice, axis, false), 0.0);
    const auto expected = eliminated(lattice, c);
    const auto solved = equilibrate(lattice, c, rest_state(lattice), {.tolerance = 1e-12, .free_contacts = false});
    double largest = 0.0;
    for (std::size_t k = 0; k < expected.size(); k += 6) largest = std::max(largest, std::abs(expected[k + 2]));
    for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(solved.state.u[k], expected[k], 1e-7 * largest / (k % 6 < 3 ? 1.0 : lattice.mean_radius)) << k;
    EXPECT_LE(solved.newton, 2);  // at the end of double precision a second pass may be due
}

// The minimum of a convex energy: no small step in any free direction goes lower, though many contacts closed on the
// way.
TEST(Equilibrium, IsTheMinimumOfTheEnergyWithCracksThatClose)
{
    const Lattice lattice = make_lattice(cracked(400, 4), {});
    const Constraints c = squeezed(lattice, 3e-3);
    const auto solved = equilibrate(lattice, c, rest_state(lattice), {.tolerance = 1e-9});
    EXPECT_GT(solved.newton, 1);
    EXPECT_GT(solved.forces.closed, 20);
    EXPECT_GT(solved.forces.open, 5);
    EXPECT_LE(solved.residual, 1e-9);
    Random random(5);
    for (int trial = 0; trial < 10; ++trial) {
        State other = solved.state;
        for (double& u : other.u) u += 1e-13 * random.uniform(-1, 1);
        for (std::size_t k = 0; k < c.dof.size(); ++k) other.u[static_cast<std::size_t>(c.dof[k])] = c.value[k];
        EXPECT_GE(forces(lattice, other).energy, solved.forces.energy * (1 - 1e-12));
    }
}

TEST(Equilibrium, DoesNotDependOnWhereItStarts)
{
    const Lattice lattice = make_lattice(cracked(400, 4), {});
    const Constraints c = squeezed(lattice, 3e-3);
    const auto a = equilibrate(lattice, c, rest_state(lattice), {.tolerance = 1e-9});
    const auto b = equilibrate(lattice, c, shaken(lattice, 1e-3), {.tolerance = 1e-9});
    EXPECT_NEAR(a.forces.energy / b.forces.energy, 1.0, 1e-8);
    const Face face = find_face(lattice, 2, true);
    EXPECT_NEAR(face_force(face, a.forces.force) / face_force(face, b.forces.force), 1.0, 1e-6);
}

TEST(Equilibrium, GivesTheSameBitsOnAnyNumberOfThreads)
{
    const Lattice lattice = make_lattice(cracked(900, 2), {});
    const Constraints c = squeezed(lattice, 2e-3);
    const auto one = equilibrate(lattice, c, rest_state(lattice));
    set_threads(2);
    const auto two = equilibrate(lattice, c, rest_state(lattice));
    set_threads(1);
    EXPECT_EQ(one.iterations, two.iterations);
    EXPECT_EQ(std::memcmp(one.state.u.data(), two.state.u.data(), one.state.u.size() * sizeof(double)), 0);
}

// Numbering the elements backwards exchanges the ends of every bond and reverses their order.
TEST(Equilibrium, DoesNotDependOnTheOrderOfBondsAndOfTheirEnds)
{
    const auto domain = cracked(400, 6);
    domain::Domain back = domain;
    const std::int32_t n = domain.elements.size();
    for (auto* v : {&back.elements.x, &back.elements.y, &back.elements.z, &back.elements.r})
        std::reverse(v->begin(), v->end());
    const auto turned_round = [&](auto& from, auto&& carry) {
        std::vector<std::size_t> order(from.i.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto key = [&](std::size_t b) { return std::pair{n - 1 - from.j[b], n - 1 - from.i[b]}; };
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
        const auto old = from;
        for (std::size_t b = 0; b < order.size(); ++b) {
            from.i[b] = n - 1 - old.j[order[b]], from.j[b] = n - 1 - old.i[order[b]];
            from.thickness[b] = old.thickness[order[b]];
            carry(old, b, order[b]);
        }
    };
    turned_round(back.bonds, [&](const auto& old, std::size_t b, std::size_t o) { back.bonds.kind[b] = old.kind[o]; });
    turned_round(back.near, [](const auto&, std::size_t, std::size_t) {});
    const auto energy = [](const domain::Domain& d) {
        const Lattice lattice = make_lattice(d, {});
        return equilibrate(lattice, squeezed(lattice, 2e-3), rest_state(lattice), {.tolerance = 1e-10}).forces.energy;
    };
    EXPECT_NEAR(energy(domain) / energy(back), 1.0, 1e-10);
}

// A free element, and a fragment that nothing holds but a crack's face pushes.
TEST(Equilibrium, BearsRattlersAndFragments)
{
    auto domain = support::small_packing(400, 8);
    domain::Bonds kept;
    const auto outside = [&](std::int32_t e) {
        return norm(domain.elements.centre(e) - 0.5 * domain.box) > 0.25 * domain.box.x;
    };
    for (std::size_t b = 0; b < domain.bonds.i.size(); ++b) {
        const bool cut = outside(domain.bonds.i[b]) != outside(domain.bonds.j[b]);
        if (domain.bonds.i[b] == 7 || domain.bonds.j[b] == 7) continue;
        kept.i.push_back(domain.bonds.i[b]), kept.j.push_back(domain.bonds.j[b]);
        kept.kind.push_back(cut ? domain::BondKind::contact_beam : domain::BondKind::beam);
        kept.thickness.push_back(cut ? 0.3e-9 : 0.0);
    }
    domain.bonds = kept;
    const Lattice lattice = make_lattice(domain, {});
    const auto pressed = equilibrate(lattice, squeezed(lattice, 5e-3), rest_state(lattice));
    EXPECT_LE(pressed.residual, 1e-6);
    EXPECT_GT(pressed.forces.closed, 3);
    const auto stretched = equilibrate(lattice, squeezed(lattice, -5e-3), rest_state(lattice));
    EXPECT_LE(stretched.residual, 1e-6);
}

TEST(Equilibrium, OfASpecimenCutInTwoBearsNothing)
{
    auto domain = support::small_packing(300, 9);
    for (std::size_t b = 0; b < domain.bonds.i.size(); ++b) {
        const double p = domain.elements.centre(domain.bonds.i[b]).z, q = domain.elements.centre(domain.bonds.j[b]).z;
        if ((p - 0.5 * domain.box.z) * (q - 0.5 * domain.box.z) < 0.0)
            domain.bonds.kind[b] = domain::BondKind::contact_beam;
    }
    const Lattice lattice = make_lattice(domain, {});
    const auto solved =
        equilibrate(lattice, squeezed(lattice, -1e-3), affine_state(lattice, {0, 0, 1e-3}), {.tolerance = 1e-9});
    const double whole = 200e9 * 1e-3 * lattice.box.x * lattice.box.y;
    EXPECT_LT(std::abs(face_force(find_face(lattice, 2, true), solved.forces.force)), 1e-6 * whole);
}

TEST(Equilibrium, IsTheSameInSingleAndInDoublePrecision)
{
    const Lattice lattice = make_lattice(cracked(3000, 2), {});
    const auto at_rest = [&](bool single) {
        return equilibrate(lattice, squeezed(lattice, 2e-3), rest_state(lattice),
                           {.tolerance = 1e-9, .single = single});
    };
    const Equilibrium a = at_rest(true), b = at_rest(false);
    EXPECT_EQ(a.in_double, 0);
    EXPECT_EQ(b.in_double, b.iterations);
    EXPECT_LE(a.residual, 1e-9);
    EXPECT_LE(b.residual, 1e-9);
    EXPECT_NEAR(a.forces.energy / b.forces.energy, 1.0, 1e-10);
    EXPECT_EQ(a.forces.closed, b.forces.closed);
}

// Every third piece of a cantilever is a hundred times shorter than its neighbours, a million times stiffer: the last
// digit of a displacement weighs more than the tolerance.
TEST(Equilibrium, EndsInDoublePrecisionAtTheLastDigitWhereSingleStalls)
{
    constexpr std::int32_t pieces = 90;
    std::vector<Vec3> at{{}};
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (std::int32_t e = 0; e < pieces; ++e) {
        at.push_back(at.back() + Vec3{e % 3 == 1 ? 0.01 : 1.0, 0.0, 0.0});
        pairs.emplace_back(e, e + 1);
    }
    const double length = at.back().x;
    const Lattice lattice = make_lattice(
        support::bonded({length, 1.0, 1.0}, at, std::vector<double>(at.size(), 1.0), pairs), {200.0, 0.3, 0.3});
    Constraints c;
    for (int k = 0; k < 6; ++k) c.impose(0, k, 0.0);
    c.impose(pieces, 1, 1.0);
    const Equilibrium solved = equilibrate(lattice, c, rest_state(lattice), {.tolerance = 1e-8});
    EXPECT_GT(solved.in_double, 0);
    EXPECT_LT(solved.in_double, solved.iterations);
    EXPECT_GT(solved.residual, 1e-8);
    EXPECT_LT(solved.residual, 1e-5);
    const double force = 3.0 * lattice.section.EI / std::pow(length, 3);
    EXPECT_NEAR(-solved.forces.force[6 * pieces + 1] / force, 1.0, 1e-4);
    EXPECT_NEAR(solved.state.rotation(pieces).z / (1.5 / length), 1.0, 1e-4);
}

TEST(SingleStiffness, AgreesWithDoublePrecisionAndGivesTheSameBitsOnAnyNumberOfThreads)
{
    const Lattice lattice = make_lattice(cracked(3000, 2), {});
    const State a = shaken(lattice, 0.01);
    const Stiffness stiffness(lattice, lattice.kind);
    std::vector<double> f(a.u.size());
    stiffness.apply(a.u, f);
    const double R = lattice.mean_radius, EA = lattice.section.EA;
    std::vector<float> first;
    for (const int team : {1, 2, 3}) {
        set_threads(team);
        SingleStiffness single;
        single.set_beams(stiffness, R);
        const auto rows = static_cast<std::size_t>(single.blocks() * block_rows);
        std::vector<float> p(8 * rows, 0.0F), q(p);
        for (std::size_t k = 0; k < a.u.size(); ++k)
            p[8 * (k / 6) + k % 6] = static_cast<float>(a.u[k] / (k % 6 < 3 ? R : 1.0));
        for (std::int64_t part = 0; part < single.parts(); ++part) {
            single.add_border(part, p.data(), q.data());
            for (auto b = single.begin_block(part); b < single.begin_block(part + 1); ++b)
                single.add_block(b, p.data(), q.data());
        }
        double worst = 0.0, largest = 0.0;
        for (std::size_t k = 0; k < a.u.size(); ++k) {
            const double expected = f[k] / EA / (k % 6 < 3 ? 1.0 : R);
            worst = std::max(worst, std::abs(double{q[8 * (k / 6) + k % 6]} - expected));
            largest = std::max(largest, std::abs(expected));
        }
        EXPECT_LT(worst, 2e-6 * largest);
        if (first.empty()) first = q;
        EXPECT_EQ(std::memcmp(first.data(), q.data(), sizeof(float) * q.size()), 0) << team;
    }
    set_threads(1);
}

// Groups that move rigidly as told, in a packing with a held face: their loads, solved for, give the motion back.
TEST(CoarseSpace, GivesTheRigidMotionsThatLoadsComeFrom)
{
    const Lattice lattice = make_lattice(cracked(900, 2), {});
    Stiffness stiffness(lattice, lattice.kind);
    const Aggregates groups = grow_aggregates(lattice, stiffness.beams(), 30);
    Constraints held;
    held.impose_normal(find_face(lattice, 2, false), 0.0);
    held.impose_normal(find_face(lattice, 0, true), 0.0);
    held.impose_normal(find_face(lattice, 1, true), 0.0);
    CoarseSpace coarse;
    coarse.set_up(lattice, stiffness, held.dof, groups);
    Springs springs;  // told of later
    for (std::size_t k = 0; k < lattice.free.i.size(); k += 5)
        springs.add(lattice.free.i[k], lattice.free.j[k], {lattice.free.tx[k], lattice.free.ty[k], lattice.free.tz[k]},
                    lattice.contact_stiffness);
    stiffness.set_springs(springs);
    coarse.update(stiffness);

    const double R = lattice.mean_radius, EA = lattice.section.EA;
    const auto group_of = [&](std::int32_t e) { return groups.of[static_cast<std::size_t>(e)]; };
    const auto arm = [&](std::int32_t e) {
        return (lattice.centre(e) - groups.centre[static_cast<std::size_t>(group_of(e))]) / R;
    };
    std::vector<double> motion(8 * groups.centre.size(), 0.0), u(6 * lattice.r.size(), 0.0), f(u.size());
    Random random(6);
    for (std::size_t k = 0; k < motion.size(); ++k) motion[k] = k % 8 < 6 ? random.uniform(-1, 1) : 0.0;
    const auto triple_at = [](const std::vector<double>& v, std::size_t at) {
        return Vec3{v[at], v[at + 1], v[at + 2]};
    };
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        if (group_of(e) < 0) continue;
        const auto g = static_cast<std::size_t>(8 * group_of(e)), k = static_cast<std::size_t>(6 * e);
        const Vec3 turn = triple_at(motion, g + 3), shift = (triple_at(motion, g) + cross(turn, arm(e))) * R;
        for (std::size_t c = 0; c < 3; ++c) {
            u[k + c] = shift[static_cast<int>(c)];
            u[k + 3 + c] = turn[static_cast<int>(c)];
        }
    }
    for (const auto dof : held.dof) u[static_cast<std::size_t>(dof)] = 0.0;
    stiffness.apply(u, f);
    for (const auto dof : held.dof) f[static_cast<std::size_t>(dof)] = 0.0;
    std::vector<float> load(motion.size(), 0.0F);
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        if (group_of(e) < 0) continue;
        const auto g = static_cast<std::size_t>(8 * group_of(e)), k = static_cast<std::size_t>(6 * e);
        const Vec3 force = triple_at(f, k) / EA, moment = triple_at(f, k + 3) / (EA * R) + cross(arm(e), force);
        for (int c = 0; c < 3; ++c) {
            load[g + static_cast<std::size_t>(c)] += static_cast<float>(force[c]);
            load[g + 3 + static_cast<std::size_t>(c)] += static_cast<float>(moment[c]);
        }
    }
    coarse.solve(load);
    for (std::size_t k = 0; k < motion.size(); ++k) {
        if (k % 8 < 6) {
            EXPECT_NEAR(load[k], motion[k], 2e-3) << k;
        }
    }
}

TEST(Multilevel, IsSymmetricPositiveAndLeavesImposedDegreesOfFreedomAlone)
{
    const Lattice lattice = make_lattice(cracked(3000, 2), {});
    const Stiffness stiffness(lattice, lattice.kind);
    const Constraints held = squeezed(lattice, 1e-3);
    Multilevel preconditioner;
    preconditioner.set_up(lattice, stiffness, held.dof);
    const std::int64_t blocks = (lattice.elements() + block_rows - 1) / block_rows;
    const auto rows = static_cast<std::size_t>(blocks * block_rows);
    const auto answer = [&](const std::vector<float>& r, double& rz) {
        std::vector<float> z(r.size(), 0.0F), p(z), d(z);
        rz = 0.0;
        for (std::int64_t b = 0; b < blocks; ++b) rz += preconditioner.descend(b, r.data(), z.data());
        rz += preconditioner.solve_coarse();
        for (std::int64_t b = 0; b < blocks; ++b) preconditioner.ascend(b, z.data(), 0.0F, d.data(), 0.0F, p.data());
        return p;
    };
    const auto load = [&](std::uint64_t seed) {
        Random random(seed);
        std::vector<float> r(8 * rows, 0.0F);
        for (std::size_t k = 0; k < 6 * lattice.r.size(); ++k)
            r[8 * (k / 6) + k % 6] = static_cast<float>(random.uniform(-1, 1));
        for (const auto dof : held.dof) r[static_cast<std::size_t>(8 * (dof / 6) + dof % 6)] = 0.0F;
        return r;
    };
    const auto dot = [](const std::vector<float>& a, const std::vector<float>& b) {
        return std::inner_product(
            a.begin(), a.end(), b.begin(), 0.0, [](double s, double x) { return s + x; },
            [](float x, float y) { return double{x} * double{y}; });
    };
    const auto a = load(1), b = load(2);
    double aa = 0.0, bb = 0.0;
    const auto on_a = answer(a, aa), on_b = answer(b, bb);
    EXPECT_NEAR(dot(a, on_a) / aa, 1.0, 1e-4);
    EXPECT_GT(aa, 0.0);
    EXPECT_NEAR(dot(a, on_b), dot(b, on_a), 1e-4 * std::sqrt(aa * bb));
    for (const auto dof : held.dof) EXPECT_EQ(on_a[static_cast<std::size_t>(8 * (dof / 6) + dof % 6)], 0.0F);
}

// A spring that leans a hair out of an axis is ten thousand times softer along the others than along that axis.
TEST(Multilevel, AnswersLoadsOnElementsThatBarelyLeanOnAnything)
{
    auto domain = cracked(900, 2);
    std::int32_t loose = 0;
    const auto off_centre = [&](std::int32_t e) { return norm(domain.elements.centre(e) - 0.5 * domain.box); };
    for (std::int32_t e = 0; e < domain.elements.size(); ++e)
        if (off_centre(e) < off_centre(loose)) loose = e;
    for (std::size_t b = 0; b < domain.bonds.i.size(); ++b)
        if (domain.bonds.i[b] == loose || domain.bonds.j[b] == loose)
            domain.bonds.kind[b] = domain::BondKind::contact_beam;
    const Lattice lattice = make_lattice(domain, {});
    Stiffness stiffness(lattice, lattice.kind);
    Springs springs;
    springs.add(loose, lattice.elements() - 1, normalized(Vec3{1.0, 1e-4, -1e-4}), lattice.contact_stiffness);
    stiffness.set_springs(springs);
    Multilevel preconditioner;
    preconditioner.set_up(lattice, stiffness, squeezed(lattice, 1e-3).dof);
    const std::int64_t blocks = (lattice.elements() + block_rows - 1) / block_rows;
    for (std::size_t c = 0; c < 6; ++c) {
        std::vector<float> r(static_cast<std::size_t>(8 * blocks * block_rows), 0.0F), z(r);
        r[8 * static_cast<std::size_t>(loose) + c] = 1.0F;
        double rz = 0.0;
        for (std::int64_t b = 0; b < blocks; ++b) rz += preconditioner.descend(b, r.data(), z.data());
        EXPECT_GT(rz + preconditioner.solve_coarse(), 0.1) << c;
    }
}

TEST(Multilevel, ToldOfOtherSpringsAnswersAsIfMadeAnew)
{
    const Lattice lattice = make_lattice(cracked(3000, 2), {});
    Stiffness stiffness(lattice, lattice.kind);
    const Constraints held = squeezed(lattice, 1e-3);
    const auto springs_of = [&](std::int32_t first, double stiffer) {
        Springs springs;
        for (std::int32_t p = first; p < lattice.free.size(); p += 3) {
            const auto k = static_cast<std::size_t>(p);
            springs.add(lattice.free.i[k], lattice.free.j[k],
                        {lattice.free.tx[k], lattice.free.ty[k], lattice.free.tz[k]},
                        lattice.contact_stiffness * (p % 2 == 0 ? stiffer : 1.0));
        }
        return springs;
    };
    const std::int64_t blocks = (lattice.elements() + block_rows - 1) / block_rows;
    std::vector<float> r(static_cast<std::size_t>(8 * blocks * block_rows), 0.0F);
    Random random(3);
    for (std::size_t k = 0; k < 6 * lattice.r.size(); ++k)
        r[8 * (k / 6) + k % 6] = static_cast<float>(random.uniform(-1, 1));
    const auto answer = [&](Multilevel& preconditioner) {
        std::vector<float> z(r.size(), 0.0F), p(z), d(z);
        for (std::int64_t b = 0; b < blocks; ++b) preconditioner.descend(b, r.data(), z.data());
        preconditioner.solve_coarse();
        for (std::int64_t b = 0; b < blocks; ++b) preconditioner.ascend(b, z.data(), 0.0F, d.data(), 0.0F, p.data());
        return p;
    };
    Multilevel told, anew;
    stiffness.set_springs(springs_of(0, 1.0));
    told.set_up(lattice, stiffness, held.dof);
    const auto before = answer(told);
    for (const double stiffer : {1.0, 2.0}) {  // others; then the same pairs with other values
        stiffness.set_springs(springs_of(1, stiffer));
        told.update(lattice, stiffness);
        anew.set_up(lattice, stiffness, held.dof);
        EXPECT_EQ(answer(told), answer(anew));
        EXPECT_NE(answer(told), before);
    }
}

TEST(Aggregates, HoldEveryBondedElementOnceAndAreConnected)
{
    const Lattice lattice = make_lattice(cracked(900, 2), {});
    const Stiffness stiffness(lattice, lattice.kind);
    const Aggregates groups = grow_aggregates(lattice, stiffness.beams(), 60);
    EXPECT_GT(groups.count(), 8);
    EXPECT_LT(groups.count(), 40);
    std::vector<int> seen(lattice.r.size(), 0);
    for (const auto e : groups.elements) ++seen[static_cast<std::size_t>(e)];
    for (std::size_t e = 0; e < seen.size(); ++e) EXPECT_EQ(seen[e], groups.of[e] >= 0 ? 1 : 0);
}

TEST(MakeLattice, NamesWhatIsWrong)
{
    const auto good = support::small_packing(60, 1);
    const auto refused = [](const domain::Domain& d, const std::string& word, BeamMaterial material = {}) {
        try {
            make_lattice(d, material);
            ADD_FAILURE() << "accepted: " << word;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    auto bad = good;
    bad.elements.x[5] = NAN;
    refused(bad, "element 5");
    bad = good, bad.bonds.thickness[4] = 1.0;
    refused(bad, "bond 4");
    bad = good, std::swap(bad.bonds.i[3], bad.bonds.j[3]);
    refused(bad, "bond 3");
    bad = good, bad.bonds = {};
    refused(bad, "nothing is connected");
    refused(domain::Domain{}, "no element");
    refused(good, "E_B", {.E_B = -1.0});
    Lattice lattice = make_lattice(good, {});
    State state = rest_state(lattice);
    state.u[9] = NAN;
    EXPECT_THROW(equilibrate(lattice, squeezed(lattice, 1e-3), state), InvalidInput);
}

}  // namespace
}  // namespace craze::mechanics
