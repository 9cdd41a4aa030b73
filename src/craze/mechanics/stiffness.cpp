#include "craze/mechanics/stiffness.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/lanes.hpp"

#include <algorithm>
#include <cassert>

namespace craze::mechanics {

void Springs::reserve(std::size_t n)
{
    i.reserve(n), j.reserve(n), tx.reserve(n), ty.reserve(n), tz.reserve(n), k.reserve(n);
}

void Springs::add(std::int32_t from, std::int32_t to, const Vec3& t, double stiffness)
{
    i.push_back(from), j.push_back(to);
    tx.push_back(t.x), ty.push_back(t.y), tz.push_back(t.z);
    k.push_back(stiffness);
}

namespace {

/// Loads four beams whose first is b.
struct BeamBlock {
    Triple<Lanes> t;
    Lanes inv_length;
};

CRAZE_INLINE Six beam_rows(const BeamSection& s, const BeamBlock& beam, const Six& u_1, const Six& u_2, Six& out_2)
{
    const Triple<Lanes> du{u_2.a - u_1.a, u_2.b - u_1.b, u_2.c - u_1.c};
    const auto loads =
        small_displacement_beam<Lanes>(s, beam.inv_length, beam.t, du, {u_1.d, u_1.e, u_1.f}, {u_2.d, u_2.e, u_2.f});
    // K u is minus the force on the elements.
    out_2 = {loads.F_1.x, loads.F_1.y, loads.F_1.z, -loads.M_2.x, -loads.M_2.y, -loads.M_2.z};
    return {-loads.F_1.x, -loads.F_1.y, -loads.F_1.z, -loads.M_1.x, -loads.M_1.y, -loads.M_1.z};
}

/// Beams [begin, end): rows of i always, rows of j where j < limit.
CRAZE_MULTIVERSION void add_own(const BeamSection& s, const Beams& beams, std::int64_t begin, std::int64_t end,
                                std::int64_t limit, const double* u, double* f)
{
    const std::int32_t *bi = beams.i.data(), *bj = beams.j.data();
    for (std::int64_t b = begin; b < end; b += lanes) {
        const std::int32_t *i = bi + b, *j = bj + b;
        const BeamBlock beam{{load(beams.tx.data() + b), load(beams.ty.data() + b), load(beams.tz.data() + b)},
                             load(beams.inv_length.data() + b)};
        const Six u_1 = gather_six(u + 6 * i[0], u + 6 * i[1], u + 6 * i[2], u + 6 * i[3]);
        const Six u_2 = gather_six(u + 6 * j[0], u + 6 * j[1], u + 6 * j[2], u + 6 * j[3]);
        Six out_2;
        const Rows row_1 = rows_of(beam_rows(s, beam, u_1, u_2, out_2)), row_2 = rows_of(out_2);
        const int count = static_cast<int>(std::min<std::int64_t>(lanes, end - b));
        for (int k = 0; k < count; ++k) {
            add_row(f + 6 * i[k], row_1, k);
            if (j[k] < limit) add_row(f + 6 * j[k], row_2, k);
        }
    }
}

/// Beams of a list, rows of j only.
CRAZE_MULTIVERSION void add_border(const BeamSection& s, const Beams& beams, const std::vector<std::int32_t>& border,
                                   const double* u, double* f)
{
    const auto n = static_cast<std::int64_t>(border.size());
    for (std::int64_t m = 0; m < n; m += lanes) {
        std::size_t b[lanes];
        for (int k = 0; k < lanes; ++k)
            b[k] = static_cast<std::size_t>(border[static_cast<std::size_t>(std::min(m + k, n - 1))]);
        double tx[lanes], ty[lanes], tz[lanes], inv_length[lanes];
        const double *p[lanes], *q[lanes];
        for (int k = 0; k < lanes; ++k) {
            tx[k] = beams.tx[b[k]], ty[k] = beams.ty[b[k]], tz[k] = beams.tz[b[k]];
            inv_length[k] = beams.inv_length[b[k]];
            p[k] = u + 6 * beams.i[b[k]], q[k] = u + 6 * beams.j[b[k]];
        }
        const BeamBlock beam{{load(tx), load(ty), load(tz)}, load(inv_length)};
        const Six u_1 = gather_six(p[0], p[1], p[2], p[3]), u_2 = gather_six(q[0], q[1], q[2], q[3]);
        Six out_2;
        beam_rows(s, beam, u_1, u_2, out_2);
        const Rows row_2 = rows_of(out_2);
        for (int k = 0; k < std::min<std::int64_t>(lanes, n - m); ++k) add_row(f + 6 * beams.j[b[k]], row_2, k);
    }
}

CRAZE_INLINE void spring_force(const Springs& s, std::size_t b, const double* u, double force[3])
{
    const double *p = u + 6 * s.i[b], *q = u + 6 * s.j[b];
    const double stretch = s.tx[b] * (q[0] - p[0]) + s.ty[b] * (q[1] - p[1]) + s.tz[b] * (q[2] - p[2]);
    const double N = s.k[b] * stretch;
    force[0] = N * s.tx[b], force[1] = N * s.ty[b], force[2] = N * s.tz[b];
}

CRAZE_INLINE std::int64_t first_with(const std::vector<std::int32_t>& i, std::int64_t element)
{
    return std::lower_bound(i.begin(), i.end(), element) - i.begin();
}

}  // namespace

Stiffness::Stiffness(const Lattice& lattice, std::span<const domain::BondKind> kind)
    : elements_(lattice.elements()), section_(lattice.section)
{
    assert(kind.size() == lattice.i.size());
    const auto n = static_cast<std::size_t>(std::count(kind.begin(), kind.end(), domain::BondKind::beam));
    beams_.count = static_cast<std::int32_t>(n);
    // A pack may read past the last beam: repeat harmless ones there.
    const std::size_t padded = n + lanes;
    for (auto* ends : {&beams_.i, &beams_.j}) ends->assign(padded, 0);
    for (auto* values : {&beams_.tx, &beams_.ty, &beams_.tz, &beams_.inv_length}) values->assign(padded, 0.0);
    std::size_t at = 0;
    for (std::size_t b = 0; b < kind.size(); ++b) {
        if (kind[b] != domain::BondKind::beam) continue;
        beams_.i[at] = lattice.i[b], beams_.j[at] = lattice.j[b];
        beams_.tx[at] = lattice.tx[b], beams_.ty[at] = lattice.ty[b], beams_.tz[at] = lattice.tz[b];
        beams_.inv_length[at++] = lattice.inv_length[b];
    }
    share_out();
}

void Stiffness::set_springs(Springs springs)
{
    springs_ = std::move(springs);
    share_out();
}

void Stiffness::share_out()
{
    // Pads are 0, out of order: search among the beams alone.
    const auto beam_end = beams_.i.begin() + beams_.count;
    const auto beam_from = [&](std::int64_t e) {
        return std::lower_bound(beams_.i.begin(), beam_end, e) - beams_.i.begin();
    };
    const auto team = std::min<std::int64_t>(threads(), elements_);
    shares_.assign(static_cast<std::size_t>(team), {});
    for (std::int64_t s = 0; s < team; ++s) {
        Share& share = shares_[static_cast<std::size_t>(s)];
        const auto cut = [&](std::int64_t part) -> std::int64_t {
            if (part == 0) return 0;
            if (part == team) return elements_;
            const auto b = static_cast<std::size_t>(beams_.count * part / team);
            return beams_.count > 0 ? beams_.i[b] : elements_ * part / team;
        };
        share.begin = cut(s), share.end = std::max(share.begin, cut(s + 1));
        share.beam_begin = beam_from(share.begin), share.beam_end = beam_from(share.end);
        for (std::int64_t b = 0; b < share.beam_begin; ++b) {
            const auto j = beams_.j[static_cast<std::size_t>(b)];
            if (j >= share.begin && j < share.end) share.border.push_back(static_cast<std::int32_t>(b));
        }
        share.spring_begin = first_with(springs_.i, share.begin), share.spring_end = first_with(springs_.i, share.end);
        for (std::int64_t b = 0; b < share.spring_begin; ++b) {
            const auto j = springs_.j[static_cast<std::size_t>(b)];
            if (j >= share.begin && j < share.end) share.spring_border.push_back(static_cast<std::int32_t>(b));
        }
    }
}

void Stiffness::apply_share(const Share& share, const double* u, double* f, bool with_springs) const
{
    std::fill(f + 6 * share.begin, f + 6 * share.end, 0.0);
    add_border(section_, beams_, share.border, u, f);
    add_own(section_, beams_, share.beam_begin, share.beam_end, share.end, u, f);
    if (!with_springs) return;
    double force[3];
    for (const std::int32_t b : share.spring_border) {
        const auto k = static_cast<std::size_t>(b);
        spring_force(springs_, k, u, force);
        for (int c = 0; c < 3; ++c) f[6 * springs_.j[k] + c] += force[c];
    }
    for (std::int64_t b = share.spring_begin; b < share.spring_end; ++b) {
        const auto k = static_cast<std::size_t>(b);
        spring_force(springs_, k, u, force);
        for (int c = 0; c < 3; ++c) f[6 * springs_.i[k] + c] -= force[c];
        if (springs_.j[k] < share.end)
            for (int c = 0; c < 3; ++c) f[6 * springs_.j[k] + c] += force[c];
    }
}

namespace {

/// A symmetric 3x3 block a I + (b - a) t t^T.
void add_projector(double* block, double across, double along, const Vec3& t)
{
    for (int r = 0; r < 3; ++r) {
        block[7 * r] += across;
        for (int c = 0; c < 3; ++c) block[6 * r + c] += (along - across) * t[r] * t[c];
    }
}

/// Own stiffness of one end of a beam; sign is +1 at end 1, -1 at end 2.
void add_end_block(double* block, const BeamSection& s, const Vec3& t, double inv_L, double sign)
{
    const double bend = s.EI * inv_L;
    add_projector(block, 12.0 * bend * inv_L * inv_L, s.EA * inv_L, t);
    add_projector(block + 21, 4.0 * bend, s.GJ * inv_L, t);
    const double c = -6.0 * sign * bend * inv_L;
    const double turn[3][3] = {{0.0, -c * t.z, c * t.y}, {c * t.z, 0.0, -c * t.x}, {-c * t.y, c * t.x, 0.0}};
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) block[6 * r + 3 + k] += turn[r][k], block[6 * (3 + k) + r] += turn[r][k];
}

}  // namespace

void Stiffness::diagonal(std::span<double> blocks) const
{
    assert(std::ssize(blocks) == 36 * elements_);
    const auto block_of = [&](std::int32_t e) { return blocks.data() + 36 * static_cast<std::int64_t>(e); };
    const auto beam_t = [&](std::size_t b) { return Vec3{beams_.tx[b], beams_.ty[b], beams_.tz[b]}; };
    const auto spring_t = [&](std::size_t b) { return Vec3{springs_.tx[b], springs_.ty[b], springs_.tz[b]}; };
    parallel_tasks(std::ssize(shares_), [&](std::int64_t s) {
        const Share& share = shares_[static_cast<std::size_t>(s)];
        const auto beam_end_2 = [&](std::size_t b) {
            add_end_block(block_of(beams_.j[b]), section_, beam_t(b), beams_.inv_length[b], -1.0);
        };
        for (const auto b : share.border) beam_end_2(static_cast<std::size_t>(b));
        for (std::int64_t k = share.beam_begin; k < share.beam_end; ++k) {
            const auto b = static_cast<std::size_t>(k);
            add_end_block(block_of(beams_.i[b]), section_, beam_t(b), beams_.inv_length[b], 1.0);
            if (beams_.j[b] < share.end) beam_end_2(b);
        }
        for (const auto b : share.spring_border) {
            const auto k = static_cast<std::size_t>(b);
            add_projector(block_of(springs_.j[k]), 0.0, springs_.k[k], spring_t(k));
        }
        for (std::int64_t k = share.spring_begin; k < share.spring_end; ++k) {
            const auto b = static_cast<std::size_t>(k);
            add_projector(block_of(springs_.i[b]), 0.0, springs_.k[b], spring_t(b));
            if (springs_.j[b] < share.end) add_projector(block_of(springs_.j[b]), 0.0, springs_.k[b], spring_t(b));
        }
    });
}

void Stiffness::apply(std::span<const double> u, std::span<double> f, bool with_springs) const
{
    assert(std::ssize(u) == 6 * elements_ && std::ssize(f) == 6 * elements_);
    parallel_ranges(std::ssize(shares_), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t s = begin; s < end; ++s)
            apply_share(shares_[static_cast<std::size_t>(s)], u.data(), f.data(), with_springs);
    });
}

}  // namespace craze::mechanics
