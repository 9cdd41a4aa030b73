#include "craze/mechanics/motion.hpp"

#include "craze/core/aligned.hpp"
#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/mechanics/inertia.hpp"
#include "craze/mechanics/motion_step.hpp"
#include "craze/mechanics/moving_bonds.hpp"
#include "craze/mechanics/neighbours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::mechanics {

namespace {

/// What one thread computes: whole chunks of elements, their bonds, and the bonds and pairs that only end there.
struct Share {
    std::int64_t begin = 0, end = 0;  ///< chunks
    std::vector<std::int32_t> border, border_pairs;
    MovingBonds border_bonds;
    std::vector<std::int32_t> broken;  ///< in this step
};

struct ChunkSums {
    StepSums step;
    double elastic = 0.0, work = 0.0;
};

/// Where a degree of freedom lies in rows of eight.
std::size_t in_eight(std::size_t dof) { return dof / 6 * 8 + dof % 6; }

void check_options(const MotionOptions& o)
{
    if (!(o.step_fraction > 0.0 && o.step_fraction <= 2.0 && o.damping >= 0.0 && std::isfinite(o.damping) &&
          o.local_damping >= 0.0 && o.local_damping < 1.0 && o.strength > 0.0 && o.bending_share >= 0.0 &&
          o.bending_share <= 1.0))
        throw InvalidInput(fmt::format(
            "motion: needs a step fraction above 0, a damping of at least 0, a local damping in [0, 1) and a "
            "positive strength with a bending share in [0, 1], got {:g}, {:g} 1/s, {:g}, {:g} Pa and {:g}",
            o.step_fraction, o.damping, o.local_damping, o.strength, o.bending_share));
}

}  // namespace

struct Motion::Work {
    const Lattice& lattice;
    MotionOptions options;
    MotionState now;
    StepConstants constants;
    Inertia masses;
    Rows6 rows;
    MovingBonds bonds;
    Neighbours neighbours;
    Aligned<double> pose, pose_next;  ///< shape (n, 8); `now` has none
    Aligned<double> force;            ///< shape (n, 8): force, moment, two unused
    std::vector<double> force_now;    ///< shape (n, 6), as measured
    bool force_is_current = false, force_is_zero = true;
    double elastic = 0.0;
    std::vector<std::int64_t> imposed;  ///< ascending
    std::vector<double> imposed_velocity;
    std::vector<std::int64_t> imposed_first;  ///< per chunk, shape (chunks + 1,)
    std::vector<std::int64_t> pair_first;     ///< per chunk
    std::vector<Share> shares;
    std::vector<ChunkSums> sums;
    double largest_r = 0.0, moved = 0.0;

    Work(const Lattice& of, const MotionOptions& with, MotionState from);
    std::int64_t elements() const { return lattice.elements(); }
    std::int64_t chunks() const { return (elements() + chunk_rows - 1) / chunk_rows; }
    /// Threads that are worth their start.
    std::int64_t team_size() const
    {
        return std::clamp<std::int64_t>(bonds.count / 512, 1, std::min<std::int64_t>(threads(), chunks()));
    }
    std::int64_t first_bond(std::int64_t chunk) const
    {
        return lattice.first[static_cast<std::size_t>(std::min(chunk * chunk_rows, elements()))];
    }
    void share_out();
    void share_pairs();
    void follow_neighbours();
    void forces_of(Share& share, std::int64_t chunk, bool measure);
    void border_forces(const Share& share);
    void step_chunk(std::int64_t chunk);
    void pass(bool measure);
    void break_beams();
    void step();
    void measure();
};

Motion::Work::Work(const Lattice& of, const MotionOptions& with, MotionState from)
    : lattice(of),
      options(with),
      now(std::move(from)),
      masses(inertia(of, with.mass)),
      bonds(moving_bonds(of, now.kind)),
      neighbours(of, with.geometry, now.pressed)
{
    check_options(options);
    const Stiffness intact(lattice, std::vector<domain::BondKind>(lattice.i.size(), domain::BondKind::beam));
    constants.geometry = options.geometry;
    // Local damping stiffens what turns back.
    constants.dt =
        options.step_fraction * 2.0 / std::sqrt((1.0 + options.local_damping) * largest_eigenvalue(intact, masses));
    constants.damping = options.damping, constants.local_damping = options.local_damping;

    const auto padded = static_cast<std::size_t>(chunks() * chunk_rows);
    for (auto* v : {&rows.mass, &rows.inv_mass, &rows.moment, &rows.inv_moment, &rows.x, &rows.y, &rows.z})
        v->assign(padded, 0.0);
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const auto k = static_cast<std::size_t>(e);
        const Vec3 from_centre = lattice.centre(e) - 0.5 * lattice.box;
        rows.x[k] = from_centre.x, rows.y[k] = from_centre.y, rows.z[k] = from_centre.z;
        rows.mass[k] = masses.mass[k], rows.moment[k] = masses.moment[k];
        rows.inv_mass[k] = 1.0 / masses.mass[k], rows.inv_moment[k] = 1.0 / masses.moment[k];
        largest_r = std::max(largest_r, lattice.r[k]);
    }
    pose.assign(now.pose.begin(), now.pose.end());
    now.pose = {};
    pose.resize(8 * padded, 0.0), now.velocity.resize(6 * padded, 0.0);
    for (std::size_t k = lattice.r.size(); k < padded; ++k) pose[8 * k + 7] = 1.0;
    pose_next = pose;
    force.assign(8 * padded, 0.0);
    sums.resize(static_cast<std::size_t>(chunks()));
    imposed_first.assign(static_cast<std::size_t>(chunks()) + 1, 0);
    share_out();
}

void Motion::Work::share_out()
{
    const std::int64_t team = team_size();
    shares.assign(static_cast<std::size_t>(team), {});
    std::int64_t begin = 0;
    for (std::int64_t s = 0; s < team; ++s) {
        Share& share = shares[static_cast<std::size_t>(s)];
        const std::int64_t until = bonds.count * (s + 1) / team;
        std::int64_t end = s + 1 == team ? chunks() : begin;
        while (end < chunks() && first_bond(end) < until) ++end;
        share.begin = begin, share.end = begin = end;
        for (std::int64_t b = 0; b < first_bond(share.begin); ++b) {
            const std::int64_t chunk = bonds.j[static_cast<std::size_t>(b)] / chunk_rows;
            if (chunk >= share.begin && chunk < share.end) share.border.push_back(static_cast<std::int32_t>(b));
        }
    }
    for (Share& share : shares) share.border_bonds = selected(bonds, share.border);
    share_pairs();
}

void Motion::Work::share_pairs()
{
    const Pairs& pairs = neighbours.active();
    pair_first.assign(static_cast<std::size_t>(chunks()) + 1, 0);
    for (const std::int32_t i : pairs.i) ++pair_first[static_cast<std::size_t>(i / chunk_rows) + 1];
    for (std::size_t c = 1; c < pair_first.size(); ++c) pair_first[c] += pair_first[c - 1];
    for (Share& share : shares) {
        share.border_pairs.clear();
        for (std::int64_t p = 0; p < pair_first[static_cast<std::size_t>(share.begin)]; ++p) {
            const std::int64_t chunk = pairs.j[static_cast<std::size_t>(p)] / chunk_rows;
            if (chunk >= share.begin && chunk < share.end) share.border_pairs.push_back(static_cast<std::int32_t>(p));
        }
    }
}

void Motion::Work::follow_neighbours()
{
    if (std::ssize(shares) != team_size()) share_out();
    if (!options.free_contacts) return;
    if (neighbours.follow(pose, now.kind, moved)) share_pairs();
    moved = 0.0;
}

/// Bonds and pairs that begin before the share and end in it, chunk by chunk of where they begin: the order in which
/// one thread alone would have added them.
void Motion::Work::border_forces(const Share& share)
{
    const Pairs& pairs = neighbours.active();
    std::int64_t b = 0;
    std::size_t p = 0;
    const MovingBonds& own = share.border_bonds;
    const auto bond_chunk = [&](std::int64_t k) {
        return k < own.count ? own.i[static_cast<std::size_t>(k)] / chunk_rows : chunks();
    };
    const auto pair_chunk = [&](std::size_t k) {
        return k < share.border_pairs.size() ? pairs.i[static_cast<std::size_t>(share.border_pairs[k])] / chunk_rows
                                             : chunks();
    };
    const auto next_chunk = [&] { return std::min(bond_chunk(b), pair_chunk(p)); };
    BondPass pass{options.geometry, share.begin * chunk_rows, share.end * chunk_rows, INFINITY, false, 0.0, {}};
    for (std::int64_t chunk = next_chunk(); chunk < chunks(); chunk = next_chunk()) {
        const std::int64_t b_0 = b;
        const std::size_t p_0 = p;
        while (bond_chunk(b) == chunk) ++b;
        while (pair_chunk(p) == chunk) ++p;
        add_bonds(lattice.section, own, b_0, b, pose.data(), force.data(), pass);
        add_border_pairs(pairs, std::span<const std::int32_t>(share.border_pairs).subspan(p_0, p - p_0),
                         lattice.contact_stiffness, options.geometry, pose.data(), force.data());
    }
}

void Motion::Work::forces_of(Share& share, std::int64_t chunk, bool measuring)
{
    const auto c = static_cast<std::size_t>(chunk);
    BondPass pass{
        options.geometry, share.begin * chunk_rows, share.end * chunk_rows, options.strength, measuring, 0.0, {}};
    if (measuring) pass.strength = INFINITY;
    pass.bending_share = options.bending_share;
    add_bonds(lattice.section, bonds, first_bond(chunk), first_bond(chunk + 1), pose.data(), force.data(), pass);
    pass.energy += add_pairs(neighbours.active(), pair_first[c], pair_first[c + 1], lattice.contact_stiffness,
                             options.geometry, share.end * chunk_rows, pose.data(), force.data());
    sums[c].elastic = pass.energy;
    share.broken.insert(share.broken.end(), pass.broken.begin(), pass.broken.end());
}

/// All forces on the chunk are known: move it.
void Motion::Work::step_chunk(std::int64_t chunk)
{
    const auto c = static_cast<std::size_t>(chunk);
    ChunkSums& sum = sums[c];
    sum.work = 0.0;
    const auto first = static_cast<std::size_t>(imposed_first[c]),
               last = static_cast<std::size_t>(imposed_first[c + 1]);
    double free_of_damping = 0.0;
    for (std::size_t k = first; k < last; ++k) {
        const auto dof = static_cast<std::size_t>(imposed[k]);
        sum.work -= force[in_eight(dof)] * 0.5 * (now.velocity[dof] + imposed_velocity[k]) * constants.dt;
    }
    // The free step would spoil these velocities and count their damping.
    double kept[6 * chunk_rows];
    for (std::size_t k = first; k < last; ++k) {
        const auto dof = static_cast<std::size_t>(imposed[k]);
        kept[k - first] = now.velocity[dof];
        force[in_eight(dof)] = 0.0;
    }
    sum.step = step_rows(constants, rows, chunk * chunk_rows, (chunk + 1) * chunk_rows, force.data(),
                         now.velocity.data(), pose.data(), pose_next.data());
    for (std::size_t k = first; k < last; ++k) {
        const auto dof = static_cast<std::size_t>(imposed[k]), e = dof / 6, a = dof % 6;
        const double mid = 0.5 * (kept[k - first] + now.velocity[dof]);
        const double affine = a == 0   ? constants.rate.x * rows.x[e]
                              : a == 1 ? constants.rate.y * rows.y[e]
                              : a == 2 ? constants.rate.z * rows.z[e]
                                       : 0.0;
        free_of_damping += (a < 3 ? rows.mass[e] : rows.moment[e]) * (mid - affine) * mid;
        now.velocity[dof] = imposed_velocity[k];
        if (k + 1 == last || static_cast<std::size_t>(imposed[k + 1]) / 6 != e)
            move_row(constants, now.velocity.data() + 6 * e, pose.data() + 8 * e, pose_next.data() + 8 * e);
    }
    sum.step.damping -= constants.damping * constants.dt * free_of_damping;
    std::fill_n(force.begin() + 8 * chunk_rows * chunk, 8 * chunk_rows, 0.0);
}

/// Forces of all; unless measuring, each chunk moves as soon as its forces are complete.
void Motion::Work::pass(bool measuring)
{
    const auto work = [&](std::int64_t s) {
        Share& share = shares[static_cast<std::size_t>(s)];
        share.broken.clear();
        // Chunks that have moved left zeros behind, still warm in the cache.
        if (!force_is_zero)
            std::fill(force.begin() + 8 * chunk_rows * share.begin, force.begin() + 8 * chunk_rows * share.end, 0.0);
        border_forces(share);
        for (std::int64_t chunk = share.begin; chunk < share.end; ++chunk) {
            forces_of(share, chunk, measuring);
            if (!measuring) step_chunk(chunk);
        }
    };
    parallel_ranges(std::ssize(shares), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t s = begin; s < end; ++s) work(s);
    });
    force_is_zero = !measuring;
}

/// From the next step on. In between both ends move by dt times their velocity while the beam pushes for the first half
/// of the step and what is left of it for the second: what it held less that work is set free.
void Motion::Work::break_beams()
{
    std::vector<std::int32_t> ends;
    for (const Share& share : shares)
        for (const std::int32_t b : share.broken) {
            const auto k = static_cast<std::size_t>(b);
            const double* moving[2] = {now.velocity.data() + 6 * std::int64_t{bonds.i[k]},
                                       now.velocity.data() + 6 * std::int64_t{bonds.j[k]}};
            const BondEnergy before = bond_energy(lattice.section, bonds, b, options.geometry, pose.data(), moving);
            const BondEnergy after = bond_energy(lattice.section, bonds, b, options.geometry, pose_next.data(), moving);
            now.fracture_energy +=
                before.beam - after.contact - 0.5 * constants.dt * (before.beam_power + after.contact_power);
            now.kind[k] = domain::BondKind::contact_beam;
            bonds.slack[k] = 0.0;
            now.broken.push_back({b, now.step});
            ends.push_back(bonds.i[k]), ends.push_back(bonds.j[k]);
        }
    if (ends.empty()) return;
    for (Share& share : shares)
        for (std::size_t k = 0; k < share.border.size(); ++k)
            share.border_bonds.slack[k] = bonds.slack[static_cast<std::size_t>(share.border[k])];
    if (options.free_contacts && neighbours.part(pose_next, now.kind, ends)) share_pairs();
}

void Motion::Work::step()
{
    follow_neighbours();
    pass(false);
    break_beams();
    pose.swap(pose_next);
    double fastest = 0.0, all = 0.0;
    for (const ChunkSums& sum : sums) {
        now.damping_energy += sum.step.damping, now.work += sum.work;
        fastest = std::max(fastest, sum.step.speed_2), all += sum.step.all_speeds;
    }
    fastest = std::sqrt(fastest) * constants.dt;
    const double stretch =
        std::max({std::abs(constants.rate.x), std::abs(constants.rate.y), std::abs(constants.rate.z)});
    moved = 2.0 * fastest + 3.0 * largest_r * stretch * constants.dt;
    ++now.step, now.time += constants.dt;
    force_is_current = false;
    if (!(std::isfinite(all) && fastest < lattice.mean_radius))
        throw ComputationFailed(
            fmt::format("the motion ran away at step {} ({:.3g} s): an element moved by more than a radius in one "
                        "step. Try a smaller step fraction, a lower loading rate or a smaller strain",
                        now.step, now.time));
}

void Motion::Work::measure()
{
    if (force_is_current) return;
    follow_neighbours();
    pass(true);
    elastic = 0.0;
    for (const ChunkSums& sum : sums) elastic += sum.elastic;
    force_now.resize(6 * lattice.r.size());
    for (std::size_t k = 0; k < force_now.size(); ++k) force_now[k] = force[in_eight(k)];
    force_is_current = true;
}

namespace {

MotionState started(const Lattice& lattice, const MotionOptions& options, const State& start)
{
    if (start.u.size() != 6 * lattice.r.size() || start.kind.size() != lattice.i.size())
        throw InvalidInput(fmt::format("motion: the start has {} numbers and {} bonds, the lattice needs {} and {}",
                                       start.u.size(), start.kind.size(), 6 * lattice.r.size(), lattice.i.size()));
    MotionState out;
    out.pose.assign(8 * lattice.r.size(), 0.0), out.velocity.assign(start.u.size(), 0.0);
    out.kind = start.kind;
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const Vec3 u = start.displacement(e), w = start.rotation(e);
        double* row = out.pose.data() + 8 * static_cast<std::int64_t>(e);
        if (!std::isfinite(u.x + u.y + u.z + w.x + w.y + w.z))
            throw InvalidInput(fmt::format("motion: the start of element {} is not finite", e));
        row[0] = u.x, row[1] = u.y, row[2] = u.z;
        if (options.geometry == Geometry::small_displacement) {
            row[4] = w.x, row[5] = w.y, row[6] = w.z;
            continue;
        }
        const double angle = norm(w), half = angle > 1e-9 ? std::sin(0.5 * angle) / angle : 0.5;
        row[4] = half * w.x, row[5] = half * w.y, row[6] = half * w.z, row[7] = std::cos(0.5 * angle);
    }
    return out;
}

MotionState checked(const Lattice& lattice, MotionState stopped)
{
    const auto n = lattice.r.size();
    if (stopped.pose.size() != 8 * n || stopped.velocity.size() != 6 * n || stopped.kind.size() != lattice.i.size())
        throw InvalidInput(fmt::format("motion: the restart has {} elements and {} bonds, the lattice {} and {}",
                                       stopped.pose.size() / 8, stopped.kind.size(), n, lattice.i.size()));
    return stopped;
}

}  // namespace

Motion::Motion(const Lattice& lattice, const MotionOptions& options, const State& start)
    : work_(std::make_unique<Work>(lattice, options, started(lattice, options, start)))
{
    set_velocity(std::vector<double>(6 * lattice.r.size(), 0.0));
}
Motion::Motion(const Lattice& lattice, const MotionOptions& options, MotionState stopped)
    : work_(std::make_unique<Work>(lattice, options, checked(lattice, std::move(stopped))))
{
}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;
Motion& Motion::operator=(Motion&&) noexcept = default;

void Motion::set_velocity(std::span<const double> velocity)
{
    Work& w = *work_;
    if (velocity.size() != 6 * w.lattice.r.size()) throw InvalidInput("motion: six velocities are needed per element");
    w.measure();
    for (std::size_t k = 0; k < velocity.size(); ++k)
        w.now.velocity[k] = velocity[k] - 0.5 * w.constants.dt * w.force_now[k] *
                                              (k % 6 < 3 ? w.rows.inv_mass[k / 6] : w.rows.inv_moment[k / 6]);
}

void Motion::drive(const Constraints& velocities)
{
    Work& w = *work_;
    for (std::size_t k = 0; k < velocities.dof.size(); ++k)
        if (velocities.dof[k] < 0 || velocities.dof[k] >= 6 * w.elements() ||
            (k > 0 && velocities.dof[k] <= velocities.dof[k - 1]) || !std::isfinite(velocities.value[k]))
            throw InvalidInput(fmt::format(
                "motion: imposed degree of freedom {} = {:g} m/s: they need to ascend within [0, {}) and to be finite",
                velocities.dof[k], velocities.value[k], 6 * w.elements()));
    w.imposed = velocities.dof, w.imposed_velocity = velocities.value;
    std::fill(w.imposed_first.begin(), w.imposed_first.end(), 0);
    for (const std::int64_t dof : w.imposed) ++w.imposed_first[static_cast<std::size_t>(dof / 6 / chunk_rows) + 1];
    for (std::size_t c = 1; c < w.imposed_first.size(); ++c) w.imposed_first[c] += w.imposed_first[c - 1];
}

void Motion::set_affine_rate(const Vec3& rate) { work_->constants.rate = rate; }
void Motion::set_damping(double alpha)
{
    work_->options.damping = work_->constants.damping = alpha;
    check_options(work_->options);
}
void Motion::set_strength(double sigma_failure)
{
    work_->options.strength = sigma_failure;
    check_options(work_->options);
}

void Motion::advance(std::int64_t steps)
{
    for (std::int64_t k = 0; k < steps; ++k) {
        check_interrupt();
        work_->step();
    }
}

double Motion::step_length() const { return work_->constants.dt; }
double Motion::time() const { return work_->now.time; }
std::int64_t Motion::steps() const { return work_->now.step; }
const std::vector<BrokenBond>& Motion::broken() const { return work_->now.broken; }

std::span<const double> Motion::force() const
{
    work_->measure();
    return work_->force_now;
}

std::vector<double> Motion::velocity() const
{
    Work& w = *work_;
    w.measure();
    const double half = 0.5 * w.constants.dt, alpha = w.constants.damping;
    std::vector<double> out(6 * w.lattice.r.size());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const std::size_t e = k / 6, c = k % 6;
        const double affine = c == 0   ? w.constants.rate.x * w.rows.x[e]
                              : c == 1 ? w.constants.rate.y * w.rows.y[e]
                              : c == 2 ? w.constants.rate.z * w.rows.z[e]
                                       : 0.0;
        const double inverse = c < 3 ? w.rows.inv_mass[e] : w.rows.inv_moment[e];
        const double off = w.now.velocity[k] - affine, beta = w.constants.local_damping;
        const double drag = off > 0.0   ? -beta * std::abs(w.force_now[k])
                            : off < 0.0 ? beta * std::abs(w.force_now[k])
                                        : 0.0;
        out[k] =
            (w.now.velocity[k] + half * ((w.force_now[k] + drag) * inverse + alpha * affine)) / (1.0 + half * alpha);
    }
    for (const std::int64_t dof : w.imposed)
        out[static_cast<std::size_t>(dof)] = w.now.velocity[static_cast<std::size_t>(dof)];
    return out;
}

Energies Motion::energies() const
{
    Work& w = *work_;
    std::vector<double> v = velocity();
    Energies out{w.elastic, 0.0, w.now.damping_energy, w.now.fracture_energy, w.now.work};
    const double half = 0.5 * w.constants.dt, alpha = w.constants.damping;
    // The work of the half step up to now.
    for (const std::int64_t dof : w.imposed) {
        const auto k = static_cast<std::size_t>(dof);
        out.work -= w.force_now[k] * half * w.now.velocity[k];
        v[k] = 0.0;
    }
    // The product of the velocities half a step ago and ahead: with it leapfrog keeps the energy of a linear lattice to
    // the last digit at any stable step, where the square of the velocity now swings with dt^2.
    std::vector<std::uint8_t> held(v.size(), 0);
    for (const std::int64_t dof : w.imposed) held[static_cast<std::size_t>(dof)] = 1;
    out.kinetic = parallel_sum(std::ssize(v), [&](std::int64_t at) {
        const auto k = static_cast<std::size_t>(at);
        const double m = k % 6 < 3 ? w.rows.mass[k / 6] : w.rows.moment[k / 6];
        return held[k] != 0 ? 0.0 : m * w.now.velocity[k] * (v[k] - 0.5 * w.now.velocity[k]);
    });
    // And what damping takes of this half step.
    if (alpha > 0.0)
        out.damping += alpha * half * parallel_sum(std::ssize(v), [&](std::int64_t at) {
                           const auto k = static_cast<std::size_t>(at), e = k / 6, c = k % 6;
                           const double affine = c == 0   ? w.constants.rate.x * w.rows.x[e]
                                                 : c == 1 ? w.constants.rate.y * w.rows.y[e]
                                                 : c == 2 ? w.constants.rate.z * w.rows.z[e]
                                                          : 0.0;
                           const double m = c < 3 ? w.rows.mass[e] : w.rows.moment[e];
                           return held[k] != 0 ? 0.0 : m * (v[k] - affine) * w.now.velocity[k];
                       });
    return out;
}

State Motion::state() const
{
    const Work& w = *work_;
    State out{std::vector<double>(6 * w.lattice.r.size()), w.now.kind};
    for (std::size_t e = 0; e < w.lattice.r.size(); ++e) {
        const double* row = w.pose.data() + 8 * e;
        double* u = out.u.data() + 6 * e;
        for (int c = 0; c < 3; ++c) u[c] = row[c], u[3 + c] = row[4 + c];
        if (w.options.geometry == Geometry::small_displacement) continue;
        const double s = std::sqrt(row[4] * row[4] + row[5] * row[5] + row[6] * row[6]);
        const double per_sine = s > 1e-12 ? 2.0 * std::atan2(s, row[7]) / s : 2.0;
        for (int c = 3; c < 6; ++c) u[c] *= per_sine;
    }
    return out;
}

MotionState Motion::stopped() const
{
    MotionState out = work_->now;
    out.pressed = work_->neighbours.pressed();
    out.pose.assign(work_->pose.begin(), work_->pose.begin() + 8 * std::ssize(work_->lattice.r));
    out.velocity.resize(6 * work_->lattice.r.size());
    return out;
}

}  // namespace craze::mechanics
