#include "craze/loading/moving.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/restart.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/loading/states.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::loading {
namespace {

constexpr double gain = 1.5;              // of the rate, per chunk, while all is calm
constexpr double chunk_crossings = 0.25;  // of a wave: how often the drive is looked after

/// Contact beams in compression: current length below L_0 - T [Eqs. 13, 23].
void count_closed(const mechanics::Lattice& lattice, const mechanics::State& state, mechanics::Forces& forces)
{
    for (std::size_t b = 0; b < lattice.i.size(); ++b) {
        if (state.kind[b] == domain::BondKind::beam) continue;
        const auto i = lattice.i[b], j = lattice.j[b];
        const Vec3 span = lattice.centre(j) + state.displacement(j) - lattice.centre(i) - state.displacement(i);
        ++(norm(span) < lattice.length[b] - lattice.thickness[b] ? forces.closed : forces.open);
    }
}

class Mover {
public:
    Mover(Rig& rig, const Loading& loading, const MovingOptions& options, const Watcher& watch)
        : rig_(rig), loading_(loading), options_(options), watch_(watch)
    {
        const auto& dense = rig.dense();
        const double speed = std::sqrt(dense.E_D / dense.rho_D);
        crossing_ = rig.lattice().box[loading.axis] / speed;
        double length = 0.0, at = 0.0;
        for (const double s : loading.path) {
            length += std::abs(s - at);
            at = s;
        }
        if (std::isfinite(loading.strength)) length = loading.strength / rig.lattice().material.E_B;
        full_rate_ = length / (loading.crossings * crossing_);
        motion_options_.geometry = options.geometry;
        motion_options_.strength = loading.strength;
        motion_options_.bending_share = loading.bending_share;
        motion_options_.local_damping = loading.local_damping;
        motion_options_.damping = loading.damping * 0.4 * 2.0 * std::numbers::pi / crossing_;
    }

    Curve run()
    {
        const Stopwatch watch;
        Progress progress(loading_.name, std::ssize(loading_.path));
        start_or_go_on();
        progress.advance(progress_.waypoint);
        last_file_ = watch.seconds();
        while (progress_.waypoint < std::ssize(loading_.path) && curve_.stopped.empty()) {
            step_towards(loading_.path[static_cast<std::size_t>(progress_.waypoint)]);
            const bool late = options_.checkpoint > 0.0 && watch.seconds() - last_file_ > options_.checkpoint;
            const bool stop = interrupted() || motion_->steps() >= options_.stop_after;
            if (!options_.restart.empty() && (late || stop)) {
                write_restart(options_.restart, rig_, loading_, {progress_, curve_, motion_->stopped()});
                last_file_ = watch.seconds();
            }
            if (stop) throw Interrupted();
            if (progress_.s != loading_.path[static_cast<std::size_t>(progress_.waypoint)]) continue;
            ++progress_.waypoint;
            record();
            progress.advance();
        }
        if (!options_.restart.empty()) std::filesystem::remove(options_.restart);
        curve_.seconds += watch.seconds();
        return std::move(curve_);
    }

private:
    void start_or_go_on()
    {
        if (!options_.restart.empty() && std::filesystem::exists(options_.restart)) {
            auto kept = read_restart(options_.restart, rig_, loading_);
            progress_ = kept.progress;
            curve_ = std::move(kept.curve);
            motion_.emplace(rig_.lattice(), motion_options_, std::move(kept.motion));
        } else {
            curve_.loading = loading_;
            progress_.share = options_.slowest;
            const mechanics::State unloaded = mechanics::rest_state(rig_.lattice());
            record_rest({unloaded, mechanics::forces(rig_.lattice(), unloaded), 0.0, 0, 0});
            if (!std::isfinite(loading_.strength) || !start_near_the_first_break())
                motion_.emplace(rig_.lattice(), motion_options_, unloaded);
        }
    }

    /// Largest Rankine stress of the beams over their strength.
    double stress_ratio(const mechanics::State& state) const
    {
        const auto loads = born_loads(rig_.lattice(), state, rig_.fill(), loading_.bending_share);
        return static_cast<double>(*std::max_element(loads.rankine.begin(), loads.rankine.end())) / loading_.strength;
    }

    /// Before a bond breaks all is elastic: states of rest lead to 0.9 of the first break, or of the first turn.
    bool start_near_the_first_break()
    {
        constexpr double near = 0.9, most_growth = 3.0;
        double turn = 0.0;
        for (const double p : loading_.path) {
            if (std::abs(p) < std::abs(turn) || p * turn < 0.0) break;
            turn = p;
        }
        if (turn == 0.0) return false;
        std::vector<mechanics::Equilibrium> found;
        std::vector<double> strains;
        double s = 0.02 * turn;
        try {
            mechanics::State start = mechanics::rest_state(rig_.lattice());
            for (int trial = 0; trial < 12; ++trial) {
                found.push_back(rig_.solve(loading_, s, std::move(start)));
                strains.push_back(s);
                const double ratio = stress_ratio(found.back().state);
                if (!(ratio < 1.0)) return false;
                const double growth = std::min(most_growth, 0.98 * near / ratio);
                if (growth < 1.1 || std::abs(s) >= near * std::abs(turn)) break;
                const double next = std::copysign(std::min(std::abs(s * growth), near * std::abs(turn)), turn);
                start = found.back().state;
                for (auto& u : start.u) u *= next / s;
                s = next;
            }
        } catch (const ComputationFailed&) {
            return false;  // a specimen that hardly holds together: move it from the start
        }
        for (std::size_t k = 0; k < found.size(); ++k) {
            progress_.s = strains[k];
            record_rest(found[k]);
        }
        start_moving(std::move(found.back().state), s);
        while (std::abs(loading_.path[static_cast<std::size_t>(progress_.waypoint)]) <= std::abs(s))
            ++progress_.waypoint;
        return true;
    }

    void start_moving(mechanics::State state, double s)
    {
        // At rest the least side is held; in motion both move apart.
        for (std::size_t a = 0; a < 3; ++a)
            if (const auto& d = loading_.drive[a]; !d.free)
                for (std::size_t k = a; k < state.u.size(); k += 6)
                    state.u[k] -= 0.5 * d.factor * s * rig_.lattice().box[static_cast<int>(a)];
        motion_.emplace(rig_.lattice(), motion_options_, state);
        const double rate = std::copysign(full_rate_, s);
        drive(rate);
        std::vector<double> velocity = state.u;
        const auto bearing = load_bearing(rig_.lattice());
        for (std::size_t k = 0; k < velocity.size(); ++k) {
            const std::size_t e = k / 6, a = k % 6;
            const auto& d = loading_.drive[std::min<std::size_t>(a, 2)];
            const bool driven = a < 3 && !d.free;
            // Loose crumbs may turn far for little: they are swept along instead.
            if (bearing[e])
                velocity[k] *= rate / s;
            else
                velocity[k] = driven ? d.factor * rate *
                                           (rig_.lattice().centre(static_cast<std::int32_t>(e))[static_cast<int>(a)] -
                                            0.5 * rig_.lattice().box[static_cast<int>(a)])
                                     : 0.0;
        }
        motion_->set_velocity(velocity);
        const auto e = motion_->energies();
        progress_.energy_before = e.elastic + e.kinetic - e.work;  // that of the half step before
        progress_.share = 1.0;
    }

    /// Full rate, less while cracking runs away, after a start and before a turn.
    double rate_towards(double target) const
    {
        double rate = full_rate_ * progress_.share;
        const auto next = static_cast<std::size_t>(progress_.waypoint) + 1;
        if (next < loading_.path.size() && (loading_.path[next] - target) * (target - progress_.s) < 0.0) {
            const double left = std::abs(target - progress_.s), ramp = 2.0 * full_rate_ * crossing_;
            rate = std::min(rate, full_rate_ * std::max(options_.slowest, std::sqrt(left / ramp)));
        }
        return rate;
    }

    void step_towards(double target)
    {
        const double dt = motion_->step_length(), left = target - progress_.s;
        if (left == 0.0) return;
        double rate = rate_towards(target);
        const auto chunk = std::max<std::int64_t>(1, std::llround(chunk_crossings * crossing_ / dt));
        auto steps = static_cast<std::int64_t>(std::ceil(std::abs(left) / (rate * dt) - 1e-9));
        const bool arrives = steps <= chunk;
        steps = std::clamp<std::int64_t>(steps, 1, chunk);
        if (arrives) rate = std::abs(left) / (static_cast<double>(steps) * dt);
        rate = std::copysign(rate, left);
        drive(rate);

        const std::int64_t first = motion_->steps();
        const double from = progress_.s;
        motion_->advance(steps);
        progress_.s = arrives ? target : from + rate * dt * static_cast<double>(steps);
        note_broken(first, from, rate * dt);

        const auto e = motion_->energies();
        const bool runs_away = e.kinetic > options_.kinetic_limit * std::max(e.elastic, progress_.calm_energy);
        progress_.calm_energy = std::max(progress_.calm_energy, runs_away ? 0.0 : 0.25 * e.elastic);
        progress_.share =
            runs_away ? std::max(options_.slowest, 0.5 * progress_.share) : std::min(1.0, gain * progress_.share);
        if (turned(target)) progress_.share = options_.slowest;
    }

    bool turned(double target) const
    {
        const auto next = static_cast<std::size_t>(progress_.waypoint) + 1;
        if (progress_.s != target || next >= loading_.path.size()) return false;
        const double before =
            progress_.waypoint > 0 ? loading_.path[static_cast<std::size_t>(progress_.waypoint) - 1] : 0.0;
        return (loading_.path[next] - target) * (target - before) < 0.0;
    }

    /// Sides move apart about the middle of the box; free axes are expected to follow Poisson's ratio.
    void drive(double rate)
    {
        mechanics::Constraints velocities;
        Vec3 affine;
        double driven = 0.0;
        for (int a = 0; a < 3; ++a) {
            const auto& d = loading_.drive[static_cast<std::size_t>(a)];
            if (d.free) continue;
            affine[a] = d.factor * rate;
            driven += affine[a];
            const double half = 0.5 * affine[a] * rig_.lattice().box[a];
            velocities.impose_normal(rig_.faces().side(a, false), -half);
            velocities.impose_normal(rig_.faces().side(a, true), half);
        }
        for (int a = 0; a < 3; ++a)
            if (loading_.drive[static_cast<std::size_t>(a)].free) affine[a] = -rig_.dense().nu_D * driven;
        motion_->drive(velocities);
        motion_->set_affine_rate(affine);
    }

    void note_broken(std::int64_t first, double from, double per_step)
    {
        const auto& broken = motion_->broken();
        const auto& lattice = rig_.lattice();
        const double stress = curve_.points.back().stress[loading_.axis];
        for (std::size_t k = curve_.broken.size(); k < broken.size(); ++k) {
            const auto b = static_cast<std::size_t>(broken[k].bond);
            const auto i = lattice.i[b], j = lattice.j[b];
            curve_.broken.push_back({i, j, 0.5 * (lattice.centre(i) + lattice.centre(j)),
                                     from + per_step * static_cast<double>(broken[k].step - first), stress,
                                     std::ssize(curve_.points)});
        }
    }

    /// A state of rest before the motion; nothing is lost in it, so that work is what is stored.
    void record_rest(const mechanics::Equilibrium& rest)
    {
        Point p = rig_.measure(loading_, progress_.s, rest.state, rest.forces);
        p.work = p.elastic;
        p.residual = rest.residual, p.iterations = rest.iterations;
        curve_.points.push_back(p);
        progress_.peak = std::max(progress_.peak, std::abs(p.stress[loading_.axis]));
        if (watch_)
            watch_({loading_, curve_.points.back(), std::ssize(curve_.points) - 1, rest.state, rest.forces, {}, false});
    }

    void record()
    {
        const mechanics::State state = motion_->state();
        mechanics::Forces forces;
        forces.force.assign(motion_->force().begin(), motion_->force().end());
        count_closed(rig_.lattice(), state, forces);
        Point p = rig_.measure(loading_, progress_.s, state, forces);
        const auto e = motion_->energies();
        p.elastic = e.elastic, p.kinetic = e.kinetic, p.damped = e.damping, p.fracture = e.fracture;
        p.work = progress_.energy_before + e.work;
        p.time = motion_->time();
        p.iterations = motion_->steps() - progress_.steps_before;
        progress_.steps_before = motion_->steps();
        curve_.points.push_back(p);
        const double stress = std::abs(p.stress[loading_.axis]);
        progress_.peak = std::max(progress_.peak, stress);
        const double new_share = static_cast<double>(p.broken) / static_cast<double>(rig_.lattice().bonds());
        // Before the first bond breaks a fall is a wave or a turn of the path, not a failure.
        if (loading_.stop_drop < 1.0 && p.broken > 0 && stress <= (1.0 - loading_.stop_drop) * progress_.peak)
            curve_.stopped = fmt::format("stress fell to {:.3g} of its peak", stress / progress_.peak);
        else if (new_share >= loading_.stop_damage)
            curve_.stopped = fmt::format("{:.3g} % of the bonds had broken", 100.0 * new_share);
        if (!watch_) return;
        const auto velocity = motion_->velocity();
        const bool last = progress_.waypoint == std::ssize(loading_.path) || !curve_.stopped.empty();
        watch_({loading_, curve_.points.back(), std::ssize(curve_.points) - 1, state, forces, velocity, last,
                curve_.broken});
    }

    Rig& rig_;
    const Loading& loading_;
    const MovingOptions& options_;
    const Watcher& watch_;
    mechanics::MotionOptions motion_options_;
    double crossing_ = 0.0;   // s, of the axial edge
    double full_rate_ = 0.0;  // of program strain, 1/s
    double last_file_ = 0.0;
    std::optional<mechanics::Motion> motion_;
    DriveProgress progress_;
    Curve curve_;
};

}  // namespace

Curve move(Rig& rig, const Loading& loading, const MovingOptions& options, const Watcher& watch)
{
    check(loading);
    return Mover(rig, loading, options, watch).run();
}

Strength strength_of(const Curve& curve)
{
    const Loading& loading = curve.loading;
    Strength s;
    s.loading = loading.name;
    s.specimen = specimen_name(loading.specimen);
    s.axis = loading.axis;
    s.tension = !loading.path.empty() && loading.path.front() > 0.0;
    s.sigma_failure = loading.strength;
    const double sign = s.tension ? 1.0 : -1.0;
    for (const auto& p : curve.points)
        if (const double stress = sign * p.stress[loading.axis]; stress > s.strength) {
            s.strength = stress;
            s.strain = sign * p.strain[loading.axis];
        }
    s.new_cracks = curve.points.back().cracked - curve.points.front().cracked;
    return s;
}

}  // namespace craze::loading
