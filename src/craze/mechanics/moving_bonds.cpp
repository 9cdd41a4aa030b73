#include "craze/mechanics/moving_bonds.hpp"

#include "craze/mechanics/lanes.hpp"

#include <algorithm>
#include <cmath>

namespace craze::mechanics {

namespace {

using Pack = Triple<Lanes>;

struct BondBlock {
    Pack d;
    Lanes inv_length, slack;
};

CRAZE_INLINE BondBlock load_block(const MovingBonds& bonds, std::int64_t b)
{
    return {{load(bonds.dx.data() + b), load(bonds.dy.data() + b), load(bonds.dz.data() + b)},
            load(bonds.inv_length.data() + b),
            load(bonds.slack.data() + b)};
}

/// What a bond of either kind does, lane by lane.
struct BondResult {
    BeamLoads<Lanes> loads;
    Lanes bending_2;  ///< square of the larger end moment
    Lanes bending_energy;
};

CRAZE_INLINE Lanes square(const Pack& a) { return dot(a, a); }

template <Geometry geometry>
CRAZE_INLINE BondResult bond_result(const BeamSection& s, const BondBlock& bond, const Seven& one, const Seven& two)
{
    const Pack du{two.a - one.a, two.b - one.b, two.c - one.c};
    const Lanes zero{};
    const auto is_beam = bond.slack < 0.0;
    BondResult out;
    Pack t;
    if constexpr (geometry == Geometry::corotational) {
        const auto beam = corotational_beam<Lanes>(s, bond.inv_length, bond.d, du, {{one.e, one.f, one.g}, one.h},
                                                   {{two.e, two.f, two.g}, two.h});
        out.loads = beam.loads;
        out.bending_energy = beam.bending_energy;
        out.bending_2 = beam.bending_1_2 > beam.bending_2_2 ? beam.bending_1_2 : beam.bending_2_2;
        t = beam.t;
    } else {
        t = bond.inv_length * bond.d;
        out.loads =
            small_displacement_beam<Lanes>(s, bond.inv_length, t, du, {one.e, one.f, one.g}, {two.e, two.f, two.g});
        const Pack across_1 = cross(t, out.loads.M_1), across_2 = cross(t, out.loads.M_2);
        const Lanes m_1 = square(across_1), m_2 = square(across_2);
        out.bending_2 = m_1 > m_2 ? m_1 : m_2;
        out.bending_energy = (m_1 + m_2 - dot(across_1, across_2)) * (1.0 / (6.0 * s.EI));  // per inverse length
    }
    // A contact beam bears N alone, and only while it is closed: N is EA times the strain for both.
    const Lanes gap = out.loads.N + s.EA * bond.slack;
    const Lanes push = gap < 0.0 ? gap : zero;
    out.loads.N = is_beam ? out.loads.N : push;
    const auto choose = [&](Pack& a, const Pack& b) {
        a.x = is_beam ? a.x : b.x, a.y = is_beam ? a.y : b.y, a.z = is_beam ? a.z : b.z;
    };
    choose(out.loads.F_1, push * t);
    choose(out.loads.M_1, {zero, zero, zero});
    choose(out.loads.M_2, {zero, zero, zero});
    return out;
}

template <Geometry geometry>
CRAZE_INLINE Lanes elastic_energy(const BeamSection& s, const BondBlock& bond, const BondResult& r)
{
    const Lanes normal = r.loads.N * r.loads.N * (0.5 / s.EA), twist = r.loads.T * r.loads.T * (0.5 / s.GJ);
    const auto is_beam = bond.slack < 0.0;
    if constexpr (geometry == Geometry::corotational)
        return is_beam ? (normal + twist) / bond.inv_length + r.bending_energy : normal / bond.inv_length;
    else
        return (is_beam ? normal + twist + r.bending_energy : normal) / bond.inv_length;
}

CRAZE_INLINE Rows rows_1(const BeamLoads<Lanes>& l)
{
    return rows_of({l.F_1.x, l.F_1.y, l.F_1.z, l.M_1.x, l.M_1.y, l.M_1.z});
}
CRAZE_INLINE Rows rows_2(const BeamLoads<Lanes>& l)
{
    return rows_of({-l.F_1.x, -l.F_1.y, -l.F_1.z, l.M_2.x, l.M_2.y, l.M_2.z});
}

/// Eq. 24 without roots: sigma_R >= S where sigma S + tau^2 >= S^2. At or above zero the beam fails.
struct FailureLaw {
    double tau_per_T, inv_S, S, per_area, moment_per_sigma;

    FailureLaw(const BeamSection& s, double strength)
        : tau_per_T(s.R_B / s.J_B),
          inv_S(1.0 / strength),
          S(strength),
          per_area(1.0 / s.area),
          moment_per_sigma(s.I_B / s.R_B)
    {
    }
    CRAZE_INLINE Lanes excess(const BondResult& r) const
    {
        const Lanes tau = r.loads.T * tau_per_T;
        const Lanes room = S - tau * tau * inv_S - r.loads.N * per_area;  // left for bending
        const Lanes bending = room * moment_per_sigma;
        const Lanes over = r.bending_2 - bending * bending;
        return bending > 0.0 ? over : spread(1.0);
    }
};

template <Geometry geometry>
CRAZE_INLINE void add_bonds_of(const BeamSection& s, const MovingBonds& bonds, std::int64_t begin, std::int64_t end,
                               const double* pose, double* force, BondPass& pass)
{
    const bool can_break = std::isfinite(pass.strength);
    const FailureLaw failure(s, pass.strength);
    const std::int64_t low = pass.low, limit = pass.limit;
    for (std::int64_t b = begin; b < end; b += lanes) {
        const std::int32_t *i = bonds.i.data() + b, *j = bonds.j.data() + b;
        const BondBlock bond = load_block(bonds, b);
        const Seven one = gather_seven(pose + 8 * i[0], pose + 8 * i[1], pose + 8 * i[2], pose + 8 * i[3]);
        const Seven two = gather_seven(pose + 8 * j[0], pose + 8 * j[1], pose + 8 * j[2], pose + 8 * j[3]);
        const BondResult result = bond_result<geometry>(s, bond, one, two);
        const Rows row_1 = rows_1(result.loads), row_2 = rows_2(result.loads);
        const int count = static_cast<int>(std::min<std::int64_t>(lanes, end - b));
        if (count == lanes && i[0] >= low && std::max(std::max(j[0], j[1]), std::max(j[2], j[3])) < limit) {
            for (int k = 0; k < lanes; ++k) add_row(force + 6 * i[k], row_1, k), add_row(force + 6 * j[k], row_2, k);
        } else {
            for (int k = 0; k < count; ++k) {
                if (i[k] >= low) add_row(force + 6 * i[k], row_1, k);
                if (j[k] < limit) add_row(force + 6 * j[k], row_2, k);
            }
        }
        if (can_break) {
            const Lanes excess = failure.excess(result);
            const auto fails = (excess >= 0.0) & (bond.slack < 0.0);
            if (fails[0] | fails[1] | fails[2] | fails[3])
                for (int k = 0; k < count; ++k)
                    if (fails[k]) pass.broken.push_back(static_cast<std::int32_t>(b + k));
        }
        if (pass.measure) {
            const Lanes energy = elastic_energy<geometry>(s, bond, result);
            for (int k = 0; k < count; ++k) pass.energy += energy[k];
        }
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
    for (auto* values : {&out.dx, &out.dy, &out.dz, &out.inv_length}) values->assign(padded, 1.0);
    out.slack.assign(padded, -1.0);
    for (std::size_t b = 0; b < kind.size(); ++b) {
        const double L_0 = lattice.length[b];
        out.dx[b] = L_0 * lattice.tx[b], out.dy[b] = L_0 * lattice.ty[b], out.dz[b] = L_0 * lattice.tz[b];
        out.inv_length[b] = lattice.inv_length[b];
        if (kind[b] == domain::BondKind::contact_beam) out.slack[b] = lattice.thickness[b] * lattice.inv_length[b];
    }
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
    pick(out.dx, bonds.dx, 1.0), pick(out.dy, bonds.dy, 1.0), pick(out.dz, bonds.dz, 1.0);
    pick(out.inv_length, bonds.inv_length, 1.0), pick(out.slack, bonds.slack, -1.0);
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
    one.dx.assign(lanes, bonds.dx[k]), one.dy.assign(lanes, bonds.dy[k]), one.dz.assign(lanes, bonds.dz[k]);
    one.inv_length.assign(lanes, bonds.inv_length[k]);
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
