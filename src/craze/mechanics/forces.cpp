#include "craze/mechanics/forces.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/mechanics/vectors.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::mechanics {

namespace {

BeamLoads<double> loads_of(const Lattice& lattice, const State& state, std::size_t b)
{
    const std::int32_t i = lattice.i[b], j = lattice.j[b];
    return small_displacement_beam<double>(
        lattice.section, lattice.inv_length[b], {lattice.tx[b], lattice.ty[b], lattice.tz[b]},
        triple(state.displacement(j) - state.displacement(i)), triple(state.rotation(i)), triple(state.rotation(j)));
}

}  // namespace

double beam_force_square(const Lattice& lattice, const State& state)
{
    const double inv_R = 1.0 / lattice.mean_radius;
    return parallel_sum(lattice.bonds(), [&](std::int64_t bond) {
        const auto b = static_cast<std::size_t>(bond);
        if (state.kind[b] != domain::BondKind::beam) return 0.0;
        const auto loads = loads_of(lattice, state, b);
        return 2.0 * dot(loads.F_1, loads.F_1) +
               inv_R * inv_R * (dot(loads.M_1, loads.M_1) + dot(loads.M_2, loads.M_2));
    });
}

Forces forces(const Lattice& lattice, const State& state, bool free_contacts)
{
    if (state.u.size() != 6 * lattice.r.size() || state.kind.size() != lattice.i.size())
        throw InvalidInput(fmt::format("the state has {} numbers and {} bonds, the lattice needs {} and {}",
                                       state.u.size(), state.kind.size(), 6 * lattice.r.size(), lattice.i.size()));
    return forces(lattice, state, Stiffness(lattice, state.kind),
                  unilateral_contacts(lattice, state.kind, free_contacts));
}

Forces forces(const Lattice& lattice, const State& state, const Stiffness& stiffness,
              const UnilateralContacts& contacts)
{
    Forces out;
    out.force.resize(state.u.size());
    stiffness.apply(state.u, out.force, false);
    out.energy = 0.5 * dot(out.force, state.u);
    for (double& f : out.force) f = -f;

    double square = beam_force_square(lattice, state);
    std::vector<double> gap(contacts.i.size());
    gaps(contacts, state.u, gap);
    add_contact_forces(contacts, gap, out.force);
    for (std::size_t c = 0; c < gap.size(); ++c) {
        const double N = unilateral_force(contacts.k[c], gap[c]);
        out.energy += 0.5 * N * gap[c];
        square += 2.0 * N * N;
        if (contacts.is_bond[c])
            ++(gap[c] < 0.0 ? out.closed : out.open);
        else
            out.touching += gap[c] < 0.0;
    }
    out.scale = std::sqrt(square);
    return out;
}

BondLoads bond_loads(const Lattice& lattice, const State& state)
{
    BondLoads out;
    const auto m = static_cast<std::size_t>(lattice.bonds());
    for (auto* values : {&out.N, &out.T, &out.bending, &out.rankine}) values->assign(m, 0.0);
    parallel_ranges(lattice.bonds(), [&](std::int64_t begin, std::int64_t end) {
        for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
            const auto loads = loads_of(lattice, state, b);
            if (state.kind[b] == domain::BondKind::contact_beam) {
                const double gap = loads.N * lattice.length[b] / lattice.section.EA + lattice.thickness[b];
                out.N[b] = unilateral_force(lattice.section.EA * lattice.inv_length[b], gap);
                continue;
            }
            const Triple<double> t{lattice.tx[b], lattice.ty[b], lattice.tz[b]};
            const auto across = [&](const Triple<double>& moment) {
                const auto side = cross(t, moment);
                return std::sqrt(dot(side, side));
            };
            out.N[b] = loads.N, out.T[b] = loads.T;
            out.bending[b] = std::max(across(loads.M_1), across(loads.M_2));
            out.rankine[b] = rankine_stress(lattice.section, loads.N, out.bending[b], loads.T);
        }
    });
    return out;
}

}  // namespace craze::mechanics
