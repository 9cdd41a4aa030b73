#include "craze/loading/rig.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/specimen.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace craze::loading {
namespace {

/// Transverse edges of a uniaxial loading are expected to follow Poisson's ratio of the dense ceramic.
Vec3 expected_strain(const Loading& loading, double s, double nu)
{
    Vec3 strain;
    double driven = 0.0;
    for (int a = 0; a < 3; ++a)
        if (const auto& drive = loading.drive[static_cast<std::size_t>(a)]; !drive.free)
            driven += strain[a] = drive.factor * s;
    for (int a = 0; a < 3; ++a)
        if (loading.drive[static_cast<std::size_t>(a)].free) strain[a] = -nu * driven;
    return strain;
}

bool is_uniaxial(const Loading& loading)
{
    int driven = 0;
    for (const auto& drive : loading.drive) driven += drive.free ? 0 : 1;
    return driven == 1 && loading.drive[static_cast<std::size_t>(loading.axis)].factor == 1.0;
}

/// A specimen in two pieces gives a modulus of zero to all digits: say so rather than report it. In compression a curve
/// may begin so, until the crack has closed.
void expect_to_bear(const Point& p, const Loading& loading, double E_D)
{
    const bool bears_at_once =
        loading.kind == Loading::Kind::modulus || (loading.kind == Loading::Kind::uniaxial && p.program > 0.0);
    const double dense = E_D * std::abs(p.program);
    if (!bears_at_once || !is_uniaxial(loading) || std::abs(p.stress[loading.axis]) > 1e-5 * dense) return;
    throw ComputationFailed(fmt::format(
        "{}: the specimen '{}' bears nothing along {}: {:.2g} Pa at a strain of {:.2g}, where the dense one bears "
        "{:.2g} "
        "Pa. No bond connects the two sides: a crack that is open cuts it through. Look at the cracks (thresholds, "
        "resolution), take a larger or another piece of the volume, load along another axis, or close the cracks "
        "(specimen 'cracks closed')",
        loading.name, specimen_name(loading.specimen), "xyz"[loading.axis], p.stress[loading.axis], p.program, dense));
}

}  // namespace

Rig::Rig(const domain::Domain& domain, const mechanics::BeamMaterial& beam, const mechanics::DenseMaterial& dense,
         const RigOptions& options)
    : lattice_(mechanics::make_lattice(domain, beam, dense.rho_D)),
      dense_(dense),
      options_(options),
      fill_(domain.dense_volume / (domain.box.x * domain.box.y * domain.box.z)),
      faces_(find_faces(lattice_, options.face_reach)),
      gauge_(lattice_, faces_, options.interior_margin * lattice_.mean_radius),
      solver_(lattice_, {.tolerance = options.residual})
{
}

mechanics::Constraints Rig::constraints(const Loading& loading, double s) const
{
    mechanics::Constraints imposed;
    for (int a = 0; a < 3; ++a) {
        const auto& drive = loading.drive[static_cast<std::size_t>(a)];
        if (drive.free) continue;
        imposed.impose_normal(faces_.side(a, false), 0.0);
        imposed.impose_normal(faces_.side(a, true), drive.factor * s * lattice_.box[a]);
    }
    return imposed;
}

Point Rig::measure(const Loading& loading, double s, const mechanics::State& state,
                   const mechanics::Forces& forces) const
{
    Point p;
    p.program = s;
    const Deformation deformation = gauge_.measure(state);
    p.strain = deformation.box;
    p.face_strain = deformation.face;
    p.interior_strain = deformation.interior;
    const Vec3& box = lattice_.box;
    double volume = 1.0;
    for (int a = 0; a < 3; ++a) {
        const auto& drive = loading.drive[static_cast<std::size_t>(a)];
        if (!drive.free) {
            p.strain[a] = drive.factor * s;
            const double least = mechanics::face_force(faces_.side(a, false), forces.force);
            const double most = mechanics::face_force(faces_.side(a, true), forces.force);
            const double section = box[(a + 1) % 3] * box[(a + 2) % 3];
            p.stress[a] = 0.5 * (most - least) / section;  // [Eq. 16]
            const double mean = 0.5 * (std::abs(most) + std::abs(least));
            if (mean > 0.0) p.imbalance = std::max(p.imbalance, std::abs(most + least) / mean);
        }
        volume *= 1.0 + p.strain[a];  // [Eq. 21]
    }
    p.eta = 1.0 / volume - 1.0;
    p.pressure = -(p.stress.x + p.stress.y + p.stress.z) / 3.0;  // [Eq. 19]
    const auto beams = std::count(state.kind.begin(), state.kind.end(), domain::BondKind::beam);
    const auto start = std::count(lattice_.kind.begin(), lattice_.kind.end(), domain::BondKind::beam);
    const auto contact_beams = forces.closed + forces.open;
    p.closure = contact_beams > 0 ? static_cast<double>(forces.closed) / static_cast<double>(contact_beams) : 0.0;
    p.cracked = 1.0 - static_cast<double>(beams) / static_cast<double>(lattice_.bonds());
    p.broken = start - beams;
    p.elastic = forces.energy;
    return p;
}

mechanics::Equilibrium Rig::solve(const Loading& loading, double s, mechanics::State start)
{
    return solver_.solve(constraints(loading, s), std::move(start));
}

Curve Rig::rest(const Loading& loading, const Watcher& watch)
{
    check(loading);
    const Stopwatch watch_time;
    Curve curve;
    curve.loading = loading;
    auto previous = mechanics::rest_state(lattice_);
    auto forces = mechanics::forces(lattice_, previous);
    curve.points.push_back(measure(loading, 0.0, previous, forces));
    if (watch) watch({loading, curve.points.back(), 0, previous, forces, {}, false});

    mechanics::State before;  // the point before the previous one
    double peak = 0.0;
    const double residual = loading.path.size() == 1 ? options_.residual : options_.curve_residual;
    Progress progress(loading.name, static_cast<std::int64_t>(loading.path.size()));
    for (std::size_t k = 0; k < loading.path.size(); ++k) {
        const double s = loading.path[k], s_1 = k > 0 ? loading.path[k - 1] : 0.0,
                     s_2 = k > 1 ? loading.path[k - 2] : 0.0;
        mechanics::State start = previous;
        auto& small = small_[static_cast<std::size_t>(loading.axis)];
        if (k == 0 && is_uniaxial(loading) && small) {
            for (std::size_t d = 0; d < start.u.size(); ++d) start.u[d] = s * small->u[d];
        } else if (k == 0) {
            start = mechanics::affine_state(lattice_, expected_strain(loading, s, dense_.nu_D));
        } else if (k == 1 || s_1 == s_2) {
            const double scale = s_1 != 0.0 ? s / s_1 : 1.0;
            for (auto& u : start.u) u *= scale;
        } else {
            const double share = (s - s_1) / (s_1 - s_2);
            for (std::size_t d = 0; d < start.u.size(); ++d) start.u[d] += share * (previous.u[d] - before.u[d]);
        }
        mechanics::Equilibrium equilibrium;
        try {
            equilibrium = solver_.solve(constraints(loading, s), std::move(start), residual);
        } catch (const ComputationFailed& error) {
            throw ComputationFailed(fmt::format("{}: no rest found at program strain {:.4g} (reached {:.4g}): {}",
                                                loading.name, s, s_1, error.what()));
        }
        before = std::move(previous);
        previous = std::move(equilibrium.state);
        Point p = measure(loading, s, previous, equilibrium.forces);
        p.residual = equilibrium.residual;
        p.iterations = equilibrium.iterations;
        if (k == 0) expect_to_bear(p, loading, dense_.E_D);
        const Point& earlier = curve.points.back();
        p.work = earlier.work;
        for (int a = 0; a < 3; ++a)
            p.work += 0.5 * (p.stress[a] + earlier.stress[a]) * (p.strain[a] - earlier.strain[a]) * lattice_.box.x *
                      lattice_.box.y * lattice_.box.z;
        curve.points.push_back(p);
        if (k == 0 && is_uniaxial(loading) && !small) {
            small = previous;
            for (auto& u : small->u) u /= s;
        }
        const double stress = std::abs(p.stress[loading.axis]);
        peak = std::max(peak, stress);
        if (loading.stop_drop < 1.0 && stress <= (1.0 - loading.stop_drop) * peak)
            curve.stopped = fmt::format("stress fell to {:.3g} of its peak", stress / peak);
        const bool last = k + 1 == loading.path.size() || !curve.stopped.empty();
        if (watch)
            watch({loading,
                   curve.points.back(),
                   static_cast<std::int64_t>(k) + 1,
                   previous,
                   equilibrium.forces,
                   {},
                   last});
        progress.advance();
        if (last) break;
    }
    if (loading.kind == Loading::Kind::triaxial) fill_bulk_modulus(curve.points);
    curve.seconds = watch_time.seconds();
    return curve;
}

void fill_bulk_modulus(std::vector<Point>& points)
{
    const std::size_t n = points.size();
    if (n < 2) return;
    // Slope at x of the parabola through three points; of the line through two.
    const auto slope = [&](std::size_t a, std::size_t b, std::size_t c, double x) {
        const double xa = points[a].eta, xb = points[b].eta, xc = points[c].eta;
        const double ab = (points[b].pressure - points[a].pressure) / (xb - xa);
        const double bc = (points[c].pressure - points[b].pressure) / (xc - xb);
        return ab + (bc - ab) / (xc - xa) * ((x - xa) + (x - xb));
    };
    for (std::size_t k = 0; k < n; ++k) {
        const double x = points[k].eta;
        double d = 0.0;
        if (n == 2)
            d = (points[1].pressure - points[0].pressure) / (points[1].eta - points[0].eta);
        else {
            const std::size_t a = k == 0 ? 0 : std::min(k - 1, n - 3);
            d = slope(a, a + 1, a + 2, x);
        }
        points[k].bulk = (1.0 + x) * d;
    }
}

}  // namespace craze::loading
