#include "craze/mechanics/moving_bonds.hpp"

#include "craze/mechanics/lanes.hpp"

#include <algorithm>
#include <cmath>

namespace craze::mechanics {

namespace {

using Pack = Triple<Lanes>;
using Mask = decltype(Lanes{} < Lanes{});

/// Where the kernel reads bonds: plain pointers, which stay in registers.
struct BondArrays {
    const std::int32_t *i, *j;
    const double *dx, *dy, *dz, *inv_length, *slack;

    explicit BondArrays(const MovingBonds& b)
        : i(b.i.data()),
          j(b.j.data()),
          dx(b.dx.data()),
          dy(b.dy.data()),
          dz(b.dz.data()),
          inv_length(b.inv_length.data()),
          slack(b.slack.data())
    {
    }
};

CRAZE_INLINE Lanes square(const Pack& a) { return dot(a, a); }
CRAZE_INLINE Lanes where(Mask yes, Lanes a) { return yes ? a : Lanes{}; }
CRAZE_INLINE Pack where(Mask yes, const Pack& a) { return {where(yes, a.x), where(yes, a.y), where(yes, a.z)}; }
CRAZE_INLINE bool any(Mask m) { return (m[0] | m[1] | m[2] | m[3]) != 0; }

/// Eq. 24 without roots: sigma_R >= S where sigma S + tau^2 >= S^2. At or above zero the beam fails.
struct FailureLaw {
    double tau_2_per_T_2, S, per_area, moment_per_sigma;

    FailureLaw(const BeamSection& s, double strength, double bending_share)
        : tau_2_per_T_2(s.R_B / s.J_B * (s.R_B / s.J_B) / strength),
          S(strength),
          per_area(1.0 / s.area),
          moment_per_sigma(s.I_B / (s.R_B * std::max(bending_share, 1e-9)))
    {
    }
    /// @param bending_2  square of the larger end moment
    CRAZE_INLINE Mask fails(Lanes N, Lanes T, Lanes bending_2) const
    {
        const Lanes room = S - tau_2_per_T_2 * (T * T) - N * per_area;  // left for bending
        const Lanes bending = room * moment_per_sigma;
        return (bending_2 >= bending * bending) | (bending <= 0.0);
    }
};

template <Geometry geometry>
CRAZE_INLINE void add_bonds_of(const BeamSection& section, const MovingBonds& bonds, std::int64_t begin,
                               std::int64_t end, const double* pose, double* force, BondPass& pass)
{
    const BeamSection s = section;
    const BondArrays at(bonds);
    const bool can_break = std::isfinite(pass.strength), measure = pass.measure;
    const FailureLaw failure(s, pass.strength, pass.bending_share);
    const std::int64_t low = pass.low, limit = pass.limit;
    const double per_EA = 0.5 / s.EA, per_GJ = 0.5 / s.GJ, per_EI = 1.0 / (6.0 * s.EI);
    for (std::int64_t b = begin; b < end; b += lanes) {
        const std::int32_t *i = at.i + b, *j = at.j + b;
        for (int k = 0; k < lanes; ++k)
            __builtin_prefetch(pose + 8 * j[ahead + k], 0), __builtin_prefetch(force + 8 * j[ahead + k], 1);
        const Pack d_0{load(at.dx + b), load(at.dy + b), load(at.dz + b)};
        const Lanes inv_length = load(at.inv_length + b), slack = load(at.slack + b);
        const Mask is_beam = slack < 0.0;
        const Seven one = gather_seven(pose + 8 * i[0], pose + 8 * i[1], pose + 8 * i[2], pose + 8 * i[3]);
        const Seven two = gather_seven(pose + 8 * j[0], pose + 8 * j[1], pose + 8 * j[2], pose + 8 * j[3]);
        const Pack du{two.a - one.a, two.b - one.b, two.c - one.c};

        BeamLoads<Lanes> loads;
        Pack t;
        Lanes bending_2, bending_energy{};
        if constexpr (geometry == Geometry::corotational) {
            const auto beam = corotational_beam<Lanes>(s, inv_length, d_0, du, {{one.e, one.f, one.g}, one.h},
                                                       {{two.e, two.f, two.g}, two.h});
            loads = beam.loads, t = beam.t;
            bending_2 = beam.bending_1_2 > beam.bending_2_2 ? beam.bending_1_2 : beam.bending_2_2;
            if (measure) bending_energy = beam.bending_energy;
        } else {
            t = inv_length * d_0;
            loads = small_displacement_beam<Lanes>(s, inv_length, t, du, {one.e, one.f, one.g}, {two.e, two.f, two.g});
            const Pack across_1 = cross(t, loads.M_1), across_2 = cross(t, loads.M_2);
            const Lanes m_1 = square(across_1), m_2 = square(across_2);
            bending_2 = m_1 > m_2 ? m_1 : m_2;
            if (measure) bending_energy = (m_1 + m_2 - dot(across_1, across_2)) * per_EI / inv_length;
        }
        if (can_break) {
            const Mask fails = failure.fails(loads.N, loads.T, bending_2) & is_beam;
            if (any(fails)) [[unlikely]]
                for (int k = 0; k < lanes && b + k < end; ++k)
                    if (fails[k]) pass.broken.push_back(static_cast<std::int32_t>(b + k));
        }
        if (any(~is_beam)) [[unlikely]] {
            // A contact beam bears N alone, and only while it is closed: N is EA times the strain for both.
            const Lanes gap = loads.N + s.EA * slack;
            const Lanes push = gap < 0.0 ? gap : Lanes{};
            const Pack pushed = where(~is_beam, push * t);
            loads.F_1 = where(is_beam, loads.F_1) + pushed;
            loads.M_1 = where(is_beam, loads.M_1), loads.M_2 = where(is_beam, loads.M_2);
            loads.N = is_beam ? loads.N : push;
            loads.T = where(is_beam, loads.T), bending_energy = where(is_beam, bending_energy);
        }
        const int count = static_cast<int>(std::min<std::int64_t>(lanes, end - b));
        if (measure) {
            const Lanes energy =
                (loads.N * loads.N * per_EA + loads.T * loads.T * per_GJ) / inv_length + bending_energy;
            for (int k = 0; k < count; ++k) pass.energy += energy[k];
        }
        const Rows row_1 = rows_of({loads.F_1.x, loads.F_1.y, loads.F_1.z, loads.M_1.x, loads.M_1.y, loads.M_1.z});
        const Rows row_2 = rows_of({-loads.F_1.x, -loads.F_1.y, -loads.F_1.z, loads.M_2.x, loads.M_2.y, loads.M_2.z});
        if (count == lanes && i[0] >= low && std::max(std::max(j[0], j[1]), std::max(j[2], j[3])) < limit) [[likely]] {
            for (int k = 0; k < lanes; ++k) add_row(force + 8 * i[k], row_1, k), add_row(force + 8 * j[k], row_2, k);
            continue;
        }
        for (int k = 0; k < count; ++k) {
            if (i[k] >= low) add_row(force + 8 * i[k], row_1, k);
            if (j[k] < limit) add_row(force + 8 * j[k], row_2, k);
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
    const auto padded = static_cast<std::size_t>(out.count) + bond_padding;
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
        to.assign(list.size() + bond_padding, pad);
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
                       const double* pose, const double* const (&velocity)[2])
{
    const auto k = static_cast<std::size_t>(b);
    MovingBonds one;
    one.count = 1;
    one.i.assign(bond_padding, 0), one.j.assign(bond_padding, 1);
    one.dx.assign(lanes, bonds.dx[k]), one.dy.assign(lanes, bonds.dy[k]), one.dz.assign(lanes, bonds.dz[k]);
    one.inv_length.assign(lanes, bonds.inv_length[k]);
    std::vector<double> ends(16), force(16);
    std::copy_n(pose + 8 * static_cast<std::int64_t>(bonds.i[k]), 8, ends.begin());
    std::copy_n(pose + 8 * static_cast<std::int64_t>(bonds.j[k]), 8, ends.begin() + 8);
    BondEnergy out;
    const auto as = [&](double slack, double& energy, double& power) {
        one.slack.assign(one.slack.size(), slack);
        std::fill(force.begin(), force.end(), 0.0);
        BondPass pass{geometry, 0, 2, std::numeric_limits<double>::infinity(), true, 0.0, {}};
        add_bonds(section, one, 0, 1, ends.data(), force.data(), pass);
        energy = pass.energy;
        for (std::size_t c = 0; c < 12; ++c) power += force[c / 6 * 8 + c % 6] * velocity[c / 6][c % 6];
    };
    one.slack.assign(lanes, -1.0);
    as(-1.0, out.beam, out.beam_power);
    as(0.0, out.contact, out.contact_power);
    return out;
}

}  // namespace craze::mechanics
