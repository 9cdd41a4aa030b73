#include "craze/mechanics/contacts.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/holding.hpp"

#include <cassert>

namespace craze::mechanics {

UnilateralContacts unilateral_contacts(const Lattice& lattice, std::span<const domain::BondKind> kind,
                                       bool free_contacts)
{
    UnilateralContacts out;
    const auto add = [&](std::int32_t i, std::int32_t j, const Vec3& t, double k, double gap_0, bool is_bond) {
        out.i.push_back(i), out.j.push_back(j);
        out.tx.push_back(t.x), out.ty.push_back(t.y), out.tz.push_back(t.z);
        out.k.push_back(k), out.gap_0.push_back(gap_0), out.is_bond.push_back(is_bond);
    };
    const Holding holding(lattice);
    // Both lists are sorted by (i, j): merge them.
    const FreeContacts& free = lattice.free;
    const std::size_t m = kind.size(), n = free_contacts ? free.i.size() : 0;
    std::size_t b = 0, p = 0;
    while (b < m || p < n) {
        const bool bond_first =
            p == n || (b < m && (lattice.i[b] < free.i[p] || (lattice.i[b] == free.i[p] && lattice.j[b] <= free.j[p])));
        if (!bond_first) {
            if (holding.parted(free.i[p], free.j[p], free.cut[p] != 0, kind))
                add(free.i[p], free.j[p], {free.tx[p], free.ty[p], free.tz[p]}, lattice.contact_stiffness, free.gap[p],
                    false);
            ++p;
            continue;
        }
        if (kind[b] == domain::BondKind::contact_beam)
            add(lattice.i[b], lattice.j[b], {lattice.tx[b], lattice.ty[b], lattice.tz[b]},
                lattice.section.EA * lattice.inv_length[b], lattice.thickness[b], true);
        ++b;
    }
    return out;
}

void openings(const UnilateralContacts& contacts, std::span<const double> u, std::span<double> opening)
{
    assert(std::ssize(opening) == contacts.size());
    parallel_ranges(contacts.size(), [&](std::int64_t begin, std::int64_t end) {
        for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
            const double *p = u.data() + 6 * contacts.i[c], *q = u.data() + 6 * contacts.j[c];
            opening[c] =
                contacts.tx[c] * (q[0] - p[0]) + contacts.ty[c] * (q[1] - p[1]) + contacts.tz[c] * (q[2] - p[2]);
        }
    });
}

void gaps(const UnilateralContacts& contacts, std::span<const double> u, std::span<double> gap)
{
    openings(contacts, u, gap);
    for (std::size_t c = 0; c < gap.size(); ++c) gap[c] += contacts.gap_0[c];
}

Springs closed_springs(const UnilateralContacts& contacts, std::span<const double> gap)
{
    Springs springs;
    for (std::size_t c = 0; c < gap.size(); ++c)
        if (gap[c] < 0.0)
            springs.add(contacts.i[c], contacts.j[c], {contacts.tx[c], contacts.ty[c], contacts.tz[c]}, contacts.k[c]);
    return springs;
}

void add_contact_forces(const UnilateralContacts& contacts, std::span<const double> gap, std::span<double> force)
{
    for (std::size_t c = 0; c < gap.size(); ++c) {
        if (!(gap[c] < 0.0)) continue;
        const double N = unilateral_force(contacts.k[c], gap[c]);
        double *p = force.data() + 6 * contacts.i[c], *q = force.data() + 6 * contacts.j[c];
        const double t[3] = {contacts.tx[c], contacts.ty[c], contacts.tz[c]};
        for (int a = 0; a < 3; ++a) p[a] += N * t[a], q[a] -= N * t[a];
    }
}

}  // namespace craze::mechanics
