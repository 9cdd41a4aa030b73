#include "craze/loading/states.hpp"

#include "craze/core/parallel.hpp"
#include "craze/io/vtu_file.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::loading {
namespace {

using mechanics::Triple;

mechanics::Turn<double> turn_of(const Vec3& rotation)
{
    const double angle = norm(rotation);
    const double share = angle > 1e-12 ? std::sin(0.5 * angle) / angle : 0.5;
    return {{share * rotation.x, share * rotation.y, share * rotation.z}, std::cos(0.5 * angle)};
}

/// Symmetric part of a (outer) b as xx yy zz xy yz xz.
std::array<double, 6> symmetric(const Vec3& a, const Vec3& b)
{
    return {a.x * b.x,
            a.y * b.y,
            a.z * b.z,
            0.5 * (a.x * b.y + a.y * b.x),
            0.5 * (a.y * b.z + a.z * b.y),
            0.5 * (a.x * b.z + a.z * b.x)};
}

template <class T>
std::vector<float> narrow(const std::vector<T>& values)
{
    return {values.begin(), values.end()};
}

}  // namespace

BornLoads born_loads(const mechanics::Lattice& lattice, const mechanics::State& state, double fill,
                     double bending_share)
{
    const auto m = static_cast<std::size_t>(lattice.bonds()), n = static_cast<std::size_t>(lattice.elements());
    BornLoads out;
    for (auto* v : {&out.N, &out.bending, &out.torque, &out.rankine}) v->assign(m, 0.0F);
    out.contact.assign(m, BornLoads::beam);
    out.broken.assign(m, 0);
    std::vector<std::array<double, 6>> moment(m);  // of the force on end i with half the branch, N m
    parallel_ranges(std::ssize(lattice.i), [&](std::int64_t begin, std::int64_t end) {
        for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
            const auto i = lattice.i[b], j = lattice.j[b];
            const Vec3 rest{lattice.tx[b], lattice.ty[b], lattice.tz[b]};
            const Vec3 du = state.displacement(j) - state.displacement(i);
            const Vec3 span = lattice.length[b] * rest + du;
            Vec3 force;  // on i
            if (state.kind[b] == domain::BondKind::beam) {
                const auto beam = mechanics::corotational_beam<double>(
                    lattice.section, lattice.inv_length[b], mechanics::triple(lattice.length[b] * rest),
                    mechanics::triple(du), turn_of(state.rotation(i)), turn_of(state.rotation(j)));
                const double bending = std::sqrt(std::max(beam.bending_1_2, beam.bending_2_2));
                force = {beam.loads.F_1.x, beam.loads.F_1.y, beam.loads.F_1.z};
                out.N[b] = static_cast<float>(beam.loads.N);
                out.bending[b] = static_cast<float>(bending);
                out.torque[b] = static_cast<float>(beam.loads.T);
                out.rankine[b] = static_cast<float>(
                    mechanics::rankine_stress(lattice.section, beam.loads.N, bending, beam.loads.T, bending_share));
            } else {
                const double thickness = lattice.kind[b] == domain::BondKind::beam ? 0.0 : lattice.thickness[b];
                const double length = norm(span);
                const double gap = length - mechanics::contact_length(lattice.length[b], thickness);
                const double N = mechanics::unilateral_force(lattice.section.EA * lattice.inv_length[b], gap);
                force = (N / length) * span;
                out.N[b] = static_cast<float>(N);
                out.contact[b] = gap < 0.0 ? BornLoads::closed : BornLoads::open;
                out.broken[b] = lattice.kind[b] == domain::BondKind::beam ? 1 : 0;
            }
            moment[b] = symmetric(0.5 * span, force);
        }
    });

    // Bonds lie sorted by their ends: sums in bond order are the same on any number of threads.
    std::vector<double> stress(6 * n, 0.0), beams(n, 0.0), broken(n, 0.0);
    for (std::size_t b = 0; b < m; ++b)
        for (const auto end : {lattice.i[b], lattice.j[b]}) {
            const auto e = static_cast<std::size_t>(end);
            for (std::size_t c = 0; c < 6; ++c) stress[6 * e + c] += moment[b][c];
            beams[e] += lattice.kind[b] == domain::BondKind::beam ? 1.0 : 0.0;
            broken[e] += out.broken[b];
        }
    for (std::size_t e = 0; e < n; ++e) {
        const double cell = 4.0 / 3.0 * std::numbers::pi * std::pow(lattice.r[e], 3) / fill;
        for (std::size_t c = 0; c < 6; ++c) stress[6 * e + c] /= cell;
        broken[e] = beams[e] > 0.0 ? broken[e] / beams[e] : 0.0;
    }
    out.stress = narrow(stress);
    out.damage = narrow(broken);
    return out;
}

void write_state(const std::filesystem::path& file, const Rig& rig, const Moment& moment)
{
    const auto& lattice = rig.lattice();
    const auto n = static_cast<std::size_t>(lattice.elements());
    const auto loads = born_loads(lattice, moment.state, rig.fill(), moment.loading.bending_share);
    std::vector<double> points(3 * n);
    std::vector<float> displacement(3 * n), rotation(3 * n), velocity;
    for (std::size_t e = 0; e < n; ++e) {
        const Vec3 c = lattice.centre(static_cast<std::int32_t>(e));
        for (std::size_t a = 0; a < 3; ++a) {
            points[3 * e + a] = c[static_cast<int>(a)];
            displacement[3 * e + a] = static_cast<float>(moment.state.u[6 * e + a]);
            rotation[3 * e + a] = static_cast<float>(moment.state.u[6 * e + 3 + a]);
        }
    }
    std::vector<float> breaking(lattice.i.size(), 0.0F);
    for (const BrokenBond& bond : moment.broken) {
        const auto begin = lattice.j.begin() + lattice.first[static_cast<std::size_t>(bond.i)],
                   end = lattice.j.begin() + lattice.first[static_cast<std::size_t>(bond.i) + 1];
        const auto found = std::find(begin, end, bond.j);
        if (found != end)
            breaking[static_cast<std::size_t>(found - lattice.j.begin())] = static_cast<float>(bond.strain);
    }
    const auto radius = narrow(lattice.r), thickness = narrow(lattice.thickness);
    std::vector<std::int32_t> lines(2 * lattice.i.size());
    for (std::size_t b = 0; b < lattice.i.size(); ++b) lines[2 * b] = lattice.i[b], lines[2 * b + 1] = lattice.j[b];

    using Floats = std::span<const float>;
    using Bytes = std::span<const std::uint8_t>;
    io::VtuGrid grid{points, lines, {}, {}};
    grid.on_points = {{"radius", 1, Floats(radius)},
                      {"displacement", 3, Floats(displacement)},
                      {"rotation", 3, Floats(rotation)},
                      {"stress", 6, Floats(loads.stress)},
                      {"damage", 1, Floats(loads.damage)}};
    if (!moment.velocity.empty()) {
        velocity.resize(3 * n);
        for (std::size_t e = 0; e < n; ++e)
            for (std::size_t a = 0; a < 3; ++a) velocity[3 * e + a] = static_cast<float>(moment.velocity[6 * e + a]);
        grid.on_points.push_back({"velocity", 3, Floats(velocity)});
    }
    grid.on_lines = {{"thickness", 1, Floats(thickness)},          {"contact", 1, Bytes(loads.contact)},
                     {"broken", 1, Bytes(loads.broken)},           {"normal_force", 1, Floats(loads.N)},
                     {"bending_moment", 1, Floats(loads.bending)}, {"torque", 1, Floats(loads.torque)},
                     {"rankine_stress", 1, Floats(loads.rankine)}, {"breaking_strain", 1, Floats(breaking)}};
    std::filesystem::create_directories(file.parent_path());
    io::write_vtu(file, grid);
}

}  // namespace craze::loading
