#include "craze/mechanics/equilibrium.hpp"

#include "craze/core/errors.hpp"
#include "craze/mechanics/contacts.hpp"
#include "craze/mechanics/inner_solver.hpp"
#include "craze/mechanics/stiffness.hpp"
#include "craze/mechanics/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace craze::mechanics {

namespace {
constexpr std::int64_t longest_search = 1000;  // in single precision, until what is left is looked at in double
}

struct EquilibriumSolver::Work {
    const Lattice& lattice;
    EquilibriumOptions options;
    double inv_radius;

    std::vector<domain::BondKind> kind;  ///< those `stiffness` and `contacts` were made for
    std::optional<Stiffness> stiffness;
    UnilateralContacts contacts;
    std::vector<std::uint8_t> closed;           ///< contacts that are springs in `stiffness`
    std::vector<std::uint8_t> closed_at_setup;  ///< and those the preconditioner knows
    std::vector<std::int64_t> imposed;
    InnerSolver inner;
    bool preconditioner_fits = false, springs_fit = false;

    std::vector<double> gap, opening, r, d, q;

    Work(const Lattice& of, EquilibriumOptions with)
        : lattice(of), options(with), inv_radius(1.0 / of.mean_radius), inner(of)
    {
        for (auto* v : {&r, &d, &q}) v->resize(6 * lattice.r.size());
    }

    void take_kinds(const std::vector<domain::BondKind>& now);
    void take_imposed(const Constraints& constraints, State& state);
    bool take_closed_set();
    void set_up_preconditioner();
    void out_of_balance(const State& state);
    double scale(const State& state) const;
    double exact_step();
    double rounding(const State& state) const;
    void check_reason(const State& state) const;
    void hold(std::vector<double>& v) const
    {
        for (const std::int64_t dof : imposed) v[static_cast<std::size_t>(dof)] = 0.0;
    }
};

void EquilibriumSolver::Work::take_kinds(const std::vector<domain::BondKind>& now)
{
    if (stiffness && now == kind) return;
    kind = now;
    stiffness.emplace(lattice, kind);
    inner.set_beams(*stiffness);
    contacts = unilateral_contacts(lattice, kind, options.free_contacts);
    gap.assign(contacts.i.size(), 0.0), opening.assign(contacts.i.size(), 0.0);
    closed.assign(contacts.i.size(), 0), closed_at_setup = closed;
    preconditioner_fits = false;
}

void EquilibriumSolver::Work::take_imposed(const Constraints& constraints, State& state)
{
    if (constraints.dof != imposed) {
        imposed = constraints.dof;
        preconditioner_fits = false;
    }
    for (std::size_t k = 0; k < imposed.size(); ++k)
        state.u[static_cast<std::size_t>(imposed[k])] = constraints.value[k];
}

/// Whether it has changed.
bool EquilibriumSolver::Work::take_closed_set()
{
    bool changed = false;
    for (std::size_t c = 0; c < gap.size(); ++c) {
        const std::uint8_t now = gap[c] < 0.0;
        changed |= now != closed[c];
        closed[c] = now;
    }
    if (!changed) return false;
    stiffness->set_springs(closed_springs(contacts, gap));
    inner.set_springs(stiffness->springs());
    // A soft piece that leans on a new contact is the worst of all that a preconditioner can be wrong about.
    springs_fit = closed == closed_at_setup;
    return true;
}

void EquilibriumSolver::Work::set_up_preconditioner()
{
    if (preconditioner_fits)
        inner.update_preconditioner(*stiffness);
    else
        inner.set_up_preconditioner(*stiffness, imposed);
    closed_at_setup = closed;
    preconditioner_fits = springs_fit = true;
}

/// r = forces on the elements, zero where imposed; gap of every contact.
void EquilibriumSolver::Work::out_of_balance(const State& state)
{
    stiffness->apply(state.u, r, false);
    for (double& f : r) f = -f;
    gaps(contacts, state.u, gap);
    add_contact_forces(contacts, gap, r);
    hold(r);
}

double EquilibriumSolver::Work::scale(const State& state) const
{
    double square = beam_force_square(lattice, state);
    for (std::size_t c = 0; c < gap.size(); ++c) {
        const double N = unilateral_force(contacts.k[c], gap[c]);
        square += 2.0 * N * N;
    }
    return std::sqrt(square);
}

/// The s >= 0 that minimises the energy along s d: its slope is monotone and piecewise linear in s.
double EquilibriumSolver::Work::exact_step()
{
    stiffness->apply(d, q, false);
    openings(contacts, d, opening);
    const double slope_0 = -dot(r, d), curvature = dot(q, d);
    const auto slope_at = [&](double s, double& curvature_at) {
        double slope = slope_0 + s * curvature;
        curvature_at = curvature;
        for (std::size_t c = 0; c < gap.size(); ++c) {
            const double before = std::min(0.0, gap[c]), after = gap[c] + s * opening[c];
            if (after < 0.0) curvature_at += contacts.k[c] * opening[c] * opening[c];
            slope += contacts.k[c] * (std::min(0.0, after) - before) * opening[c];
        }
        return slope;
    };
    double low = 0.0, high = INFINITY, s = 1.0;
    for (int trial = 0; trial < 100; ++trial) {
        double bend = 0.0;
        const double slope = slope_at(s, bend);
        if (std::abs(slope) <= 1e-10 * std::abs(slope_0)) break;
        (slope < 0.0 ? low : high) = s;
        double next = bend > 0.0 ? s - slope / bend : INFINITY;
        if (!(next > low && next < high)) next = high < INFINITY ? 0.5 * (low + high) : 2.0 * s;
        s = next;
    }
    return s;
}

/// A part that nothing holds in some direction may drift off on rounding errors alone.
void EquilibriumSolver::Work::check_reason(const State& state) const
{
    const double most = 10.0 * std::max({lattice.box.x, lattice.box.y, lattice.box.z});
    for (std::size_t k = 0; k < state.u.size(); ++k) {
        const double u = std::abs(state.u[k]);
        if (u < (k % 6 < 3 ? most : 1e3)) continue;
        throw ComputationFailed(
            fmt::format("equilibrium was not reached: element {} drifts off (number {} of its six is {:.2g}), so a "
                        "part of the specimen is held by nothing in that direction. Is it cut through entirely by "
                        "cracks, or does a fragment touch a driven side? Hold more sides, close the cracks, or load "
                        "in motion",
                        k / 6, k % 6, state.u[k]));
    }
}

/// What the last digit of every number of the state weighs, as a norm of forces.
double EquilibriumSolver::Work::rounding(const State& state) const
{
    std::vector<double> blocks(6 * state.u.size(), 0.0), last(state.u.size(), 0.0);
    stiffness->diagonal(blocks);
    for (std::size_t e = 0; e < last.size() / 6; ++e)
        for (std::size_t k = 0; k < 36; ++k)
            last[6 * e + k / 6] += std::abs(blocks[36 * e + k] * state.u[6 * e + k % 6]);
    return std::numeric_limits<double>::epsilon() * std::sqrt(weighted_square(last, inv_radius));
}

EquilibriumSolver::EquilibriumSolver(const Lattice& lattice, EquilibriumOptions options)
    : work_(std::make_unique<Work>(lattice, options))
{
}
EquilibriumSolver::~EquilibriumSolver() = default;
EquilibriumSolver::EquilibriumSolver(EquilibriumSolver&&) noexcept = default;
EquilibriumSolver& EquilibriumSolver::operator=(EquilibriumSolver&&) noexcept = default;

namespace {

void check_shapes(const Lattice& lattice, const Constraints& constraints, const State& state)
{
    const auto dofs = 6 * static_cast<std::int64_t>(lattice.elements());
    if (std::ssize(state.u) != dofs || state.kind.size() != lattice.i.size())
        throw InvalidInput(
            fmt::format("equilibrium: the start has {} numbers and {} bonds, the lattice needs {} and {}",
                        state.u.size(), state.kind.size(), dofs, lattice.i.size()));
    if (constraints.size() == 0 || constraints.value.size() != constraints.dof.size())
        throw InvalidInput("equilibrium: nothing is imposed; hold and drive at least one face");
    for (std::size_t k = 0; k < constraints.dof.size(); ++k) {
        const auto dof = constraints.dof[k];
        if (dof < 0 || dof >= dofs || (k > 0 && dof <= constraints.dof[k - 1]) || !std::isfinite(constraints.value[k]))
            throw InvalidInput(fmt::format(
                "equilibrium: imposed degree of freedom {} = {:g}: they need to ascend within [0, {}) and to be finite",
                dof, constraints.value[k], dofs));
    }
    for (std::size_t k = 0; k < state.u.size(); ++k)
        if (!std::isfinite(state.u[k]))
            throw InvalidInput(
                fmt::format("equilibrium: number {} of element {} is not finite at the start", k % 6, k / 6));
}

}  // namespace

Equilibrium EquilibriumSolver::solve(const Constraints& constraints, State start, std::optional<double> asked)
{
    Work& w = *work_;
    const double tolerance = asked.value_or(w.options.tolerance);
    check_shapes(w.lattice, constraints, start);
    Equilibrium out{std::move(start), {}, 0.0, 0, 0, 0};
    w.take_kinds(out.state.kind);
    w.take_imposed(constraints, out.state);

    enum class Search { anew, going_on, in_double } search = w.options.single ? Search::anew : Search::in_double;
    double believed = 0.0, before = INFINITY;  // norms after the last search: as it says, and before it
    double largest_scale = 0.0;
    int stalls = 0;  // searches in a row, with the same contacts closed, that did not halve what was left
    for (int round = 0;; ++round) {
        w.out_of_balance(out.state);
        const double norm = std::sqrt(weighted_square(w.r, w.inv_radius));
        // Where nothing is left to bear the load, forces are small against those met on the way.
        const double scale_now = w.scale(out.state);
        largest_scale = std::max(largest_scale, scale_now);
        const double scale = std::max(scale_now, 1e-6 * largest_scale);
        out.residual = scale > 0.0 ? norm / scale : 0.0;
        if (out.residual <= tolerance) break;
        const bool changed = w.take_closed_set();
        out.newton += changed || round == 0;
        const bool stalled = !changed && !(norm < 0.5 * before);
        stalls = stalled ? stalls + 1 : 0;
        if (search == Search::in_double) {
            if (stalled && norm <= w.rounding(out.state)) break;
        } else if (stalls > 1) {
            search = Search::in_double;
        } else if (changed || stalled || !(norm < 1.5 * believed)) {
            search = Search::anew;
        }
        if (!std::isfinite(out.residual) || out.newton > w.options.newton || round == 10 * w.options.newton ||
            out.iterations >= w.options.iterations)
            throw ComputationFailed(fmt::format(
                "equilibrium was not reached: the residual is {:.2g} where {:.2g} was asked, after {} "
                "conjugate-gradient "
                "iterations and {} changes of the closed contacts. Try smaller load steps, a looser tolerance or more "
                "iterations; a specimen cut through by cracks may have nothing left to carry the load",
                out.residual, tolerance, out.iterations, out.newton));
        if (!w.preconditioner_fits || !w.springs_fit) {
            w.set_up_preconditioner();
            if (search == Search::going_on) search = Search::anew;
        }
        const double goal = 0.7 * tolerance * scale;
        const std::int64_t most = w.options.iterations - out.iterations;
        InnerSolver::Result inner;
        if (search == Search::in_double) {
            inner = w.inner.solve_in_double(*w.stiffness, w.r,
                                            std::max(goal, w.contacts.size() > 0 ? 0.05 * norm : 0.0), most, w.d);
            out.in_double += inner.iterations;
        } else {
            // Single precision gives two or three digits at a time.
            inner = w.inner.solve(w.r, std::max(goal, 0.05 * norm), std::min(most, longest_search),
                                  search == Search::going_on, w.d);
        }
        out.iterations += inner.iterations, believed = inner.norm, before = norm;
        const double s = w.contacts.size() == 0 ? 1.0 : w.exact_step();
        if (search != Search::in_double)
            search = std::abs(s - 1.0) < 0.1 && inner.iterations > 0 ? Search::going_on : Search::anew;
        add_scaled(out.state.u, s, w.d);
        w.check_reason(out.state);
    }
    out.forces = forces(w.lattice, out.state, *w.stiffness, w.contacts);
    return out;
}

Equilibrium equilibrate(const Lattice& lattice, const Constraints& constraints, State start,
                        const EquilibriumOptions& options)
{
    return EquilibriumSolver(lattice, options).solve(constraints, std::move(start));
}

}  // namespace craze::mechanics
