#include "craze/mechanics/moving_bonds.hpp"

#include "craze/mechanics/lanes.hpp"

#include <algorithm>
#include <cmath>

namespace craze::mechanics {

namespace {

using Pack = Triple<Lanes>;

struct BondBlock {
    Pack t;
    Lanes length, inv_length, slack;
};

CRAZE_INLINE BondBlock load_block(const MovingBonds& bonds, std::int64_t b)
{
    return {{load(bonds.tx.data() + b), load(bonds.ty.data() + b), load(bonds.tz.data() + b)},
            load(bonds.length.data() + b),
            load(bonds.inv_length.data() + b),
            load(bonds.slack.data() + b)};
}

/// What a bond of either kind does, lane by lane.
struct BondResult {
    BeamLoads<Lanes> loads;
    Lanes energy;
    Lanes bending_2;  ///< square of the larger end moment
};

CRAZE_INLINE Lanes square(const Pack& a) { return dot(a, a); }

template <Geometry geometry>
CRAZE_INLINE BondResult bond_result(const BeamSection& s, const BondBlock& bond, const Seven& one, const Seven& two)
{
    const Pack du{two.a - one.a, two.b - one.b, two.c - one.c};
    const Lanes zero{};
    const auto is_beam = bond.slack < 0.0;
    BondResult out;
    Lanes opening;  // L - L_0
    Pack t;
    if constexpr (geometry == Geometry::corotational) {
        const auto beam = corotational_beam<Lanes>(s, bond.length, bond.inv_length, bond.t, du,
                                                   {{one.e, one.f, one.g}, one.h}, {{two.e, two.f, two.g}, two.h});
        out.loads = beam.loads;
        out.energy = beam.bending_energy;
        out.bending_2 = beam.bending_1_2 > beam.bending_2_2 ? beam.bending_1_2 : beam.bending_2_2;
        opening = beam.length - bond.length;
        t = (1.0 / beam.length) * (bond.length * bond.t + du);
    } else {
        const Pack w_1{one.e, one.f, one.g}, w_2{two.e, two.f, two.g};
        out.loads = small_displacement_beam<Lanes>(s, bond.inv_length, bond.t, du, w_1, w_2);
        opening = dot(bond.t, du);
        t = bond.t;
        const Pack b_1 = cross(t, out.loads.M_1), b_2 = cross(t, out.loads.M_2);
        const Lanes m_1 = square(b_1), m_2 = square(b_2);
        out.bending_2 = m_1 > m_2 ? m_1 : m_2;
        out.energy = (m_1 + m_2 - dot(b_1, b_2)) / (6.0 * s.EI * bond.inv_length);
    }
    out.energy += (0.5 / s.GJ) * out.loads.T * out.loads.T / bond.inv_length;
    // A contact beam bears N alone, and only while it is closed.
    const Lanes gap = opening + bond.slack;
    const Lanes push = gap < 0.0 ? s.EA * bond.inv_length * gap : zero;
    out.loads.N = is_beam ? out.loads.N : push;
    const Lanes normal_energy = out.loads.N * out.loads.N * (0.5 / s.EA) / bond.inv_length;
    out.energy = is_beam ? out.energy + normal_energy : normal_energy;
    const auto choose = [&](Pack& a, const Pack& b) {
        a.x = is_beam ? a.x : b.x, a.y = is_beam ? a.y : b.y, a.z = is_beam ? a.z : b.z;
    };
    choose(out.loads.F_1, push * t);
    choose(out.loads.M_1, {zero, zero, zero});
    choose(out.loads.M_2, {zero, zero, zero});
    return out;
}

CRAZE_INLINE Rows rows_1(const BeamLoads<Lanes>& l)
{
    return rows_of({l.F_1.x, l.F_1.y, l.F_1.z, l.M_1.x, l.M_1.y, l.M_1.z});
}
CRAZE_INLINE Rows rows_2(const BeamLoads<Lanes>& l)
{
    return rows_of({-l.F_1.x, -l.F_1.y, -l.F_1.z, l.M_2.x, l.M_2.y, l.M_2.z});
}

/// Eq. 24 without roots: sigma_R >= S where sigma S + tau^2 >= S^2; negative where the beam holds.
CRAZE_INLINE Lanes distance_to_failure(const BeamSection& s, const BondResult& r, double S)
{
    const Lanes tau = r.loads.T * (s.R_B / s.J_B);
    const Lanes room = S - tau * tau / S - r.loads.N / s.area;  // left for bending; at or below 0 it fails anyway
    const Lanes bending = room * (s.I_B / s.R_B);
    const Lanes over = r.bending_2 - bending * bending;
    return bending > 0.0 ? over : spread(1.0);
}

template <Geometry geometry>
CRAZE_INLINE void add_bonds_of(const BeamSection& s, const MovingBonds& bonds, std::int64_t begin, std::int64_t end,
                               const double* pose, double* force, BondPass& pass)
{
    const bool can_break = std::isfinite(pass.strength);
    const std::int64_t low = pass.low, limit = pass.limit;
    for (std::int64_t b = begin; b < end; b += lanes) {
        const std::int32_t *i = bonds.i.data() + b, *j = bonds.j.data() + b;
        const BondBlock bond = load_block(bonds, b);
        const Seven one = gather_seven(pose + 8 * i[0], pose + 8 * i[1], pose + 8 * i[2], pose + 8 * i[3]);
        const Seven two = gather_seven(pose + 8 * j[0], pose + 8 * j[1], pose + 8 * j[2], pose + 8 * j[3]);
        const BondResult result = bond_result<geometry>(s, bond, one, two);
        const Rows row_1 = rows_1(result.loads), row_2 = rows_2(result.loads);
        const int count = static_cast<int>(std::min<std::int64_t>(lanes, end - b));
        for (int k = 0; k < count; ++k) {
            if (i[k] >= low) add_row(force + 6 * i[k], row_1, k);
            if (j[k] < limit) add_row(force + 6 * j[k], row_2, k);
        }
        if (can_break) {
            const Lanes over = distance_to_failure(s, result, pass.strength);
            for (int k = 0; k < count; ++k)
                if (over[k] >= 0.0 && bond.slack[k] < 0.0) pass.broken.push_back(static_cast<std::int32_t>(b + k));
        }
        if (pass.measure)
            for (int k = 0; k < count; ++k) pass.energy += result.energy[k];
    }
}

CRAZE_MULTIVERSION void add_small(const BeamSection& s, const MovingBonds& bonds, std::int64_t begin, std::int64_t end,
                                  const double* pose, double* force, BondPass& pass)
{
    add_bonds_of<Geometry::small_displacement>(s, bonds, begin, end, pose, force, pass);
}
CRAZE_MULTIVERSION void add_corotational(const BeamSection& s, const MovingBonds& bonds, std::int64_t begin,
                                         std::int64_t end, const double* pose, double* force, BondPass& pass)
{
    add_bonds_of<Geometry::corotational>(s, bonds, begin, end, pose, force, pass);
}
}  // namespace

MovingBonds moving_bonds(const Lattice& lattice, std::span<const domain::BondKind> kind)
{
    MovingBonds out;
    out.count = lattice.bonds();
    const auto padded = static_cast<std::size_t>(out.count) + lanes;
    out.i = lattice.i, out.j = lattice.j;
    out.i.resize(padded), out.j.resize(padded);
    out.tx = lattice.tx, out.ty = lattice.ty, out.tz = lattice.tz;
    out.length = lattice.length, out.inv_length = lattice.inv_length;
    for (auto* values : {&out.tx, &out.ty, &out.tz, &out.length, &out.inv_length}) values->resize(padded, 1.0);
    out.slack.assign(padded, -1.0);
    for (std::size_t b = 0; b < kind.size(); ++b)
        if (kind[b] == domain::BondKind::contact_beam) out.slack[b] = lattice.thickness[b];
    return out;
}

MovingBonds selected(const MovingBonds& bonds, std::span<const std::int32_t> list)
{
    MovingBonds out;
    out.count = std::ssize(list);
    const auto pick = [&](auto& to, const auto& from, auto pad) {
        to.assign(list.size() + lanes, pad);
        for (std::size_t k = 0; k < list.size(); ++k) to[k] = from[static_cast<std::size_t>(list[k])];
    };
    pick(out.i, bonds.i, 0), pick(out.j, bonds.j, 0);
    pick(out.tx, bonds.tx, 1.0), pick(out.ty, bonds.ty, 1.0), pick(out.tz, bonds.tz, 1.0);
    pick(out.length, bonds.length, 1.0), pick(out.inv_length, bonds.inv_length, 1.0),
        pick(out.slack, bonds.slack, -1.0);
    return out;
}

void add_bonds(const BeamSection& section, const MovingBonds& bonds, std::int64_t begin, std::int64_t end,
               const double* pose, double* force, BondPass& pass)
{
    if (pass.geometry == Geometry::corotational)
        add_corotational(section, bonds, begin, end, pose, force, pass);
    else
        add_small(section, bonds, begin, end, pose, force, pass);
}

BondEnergy bond_energy(const BeamSection& section, const MovingBonds& bonds, std::int64_t b, Geometry geometry,
                       const double* pose)
{
    const auto k = static_cast<std::size_t>(b);
    MovingBonds one;
    one.count = 1;
    one.i.assign(lanes, 0), one.j.assign(lanes, 1);
    one.tx.assign(lanes, bonds.tx[k]), one.ty.assign(lanes, bonds.ty[k]), one.tz.assign(lanes, bonds.tz[k]);
    one.length.assign(lanes, bonds.length[k]), one.inv_length.assign(lanes, bonds.inv_length[k]);
    std::vector<double> ends(16), force(12);
    std::copy_n(pose + 8 * static_cast<std::int64_t>(bonds.i[k]), 8, ends.begin());
    std::copy_n(pose + 8 * static_cast<std::int64_t>(bonds.j[k]), 8, ends.begin() + 8);
    const auto energy_with = [&](double slack) {
        one.slack.assign(lanes, slack);
        BondPass pass{geometry, 0, 2, std::numeric_limits<double>::infinity(), true, 0.0, {}};
        add_bonds(section, one, 0, 1, ends.data(), force.data(), pass);
        return pass.energy;
    };
    return {energy_with(-1.0), energy_with(0.0)};
}

}  // namespace craze::mechanics
