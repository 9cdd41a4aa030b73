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

void Beams::resize(std::size_t n)
{
    count = static_cast<std::int64_t>(n);
    // A pack may read past the last beam: harmless ones lie there.
    i.assign(n + bond_padding, 0), j.assign(n + bond_padding, 0);
    for (auto* values : {&tx, &ty, &tz, &inv_length}) values->assign(n + bond_padding, 0.0);
}

namespace {

/// K u of beams [begin, end), rows of elements in [low, limit). One function for all beams: two would round differently
/// where the compiler fuses products and sums.
CRAZE_MULTIVERSION void add_beams(const BeamSection& s, const Beams& beams, std::int64_t begin, std::int64_t end,
                                  std::int64_t low, std::int64_t limit, const double* u, double* f)
{
    for (std::int64_t b = begin; b < end; b += lanes) {
        const std::int32_t *i = beams.i.data() + b, *j = beams.j.data() + b;
        for (int k = 0; k < lanes; ++k)
            prefetch_row<false>(u + 6 * j[ahead + k], 6), prefetch_row<true>(f + 6 * j[ahead + k], 6);
        const Triple<Lanes> t{load(beams.tx.data() + b), load(beams.ty.data() + b), load(beams.tz.data() + b)};
        const Six one = gather_six(u + 6 * i[0], u + 6 * i[1], u + 6 * i[2], u + 6 * i[3]);
        const Six two = gather_six(u + 6 * j[0], u + 6 * j[1], u + 6 * j[2], u + 6 * j[3]);
        const Triple<Lanes> du{two.a - one.a, two.b - one.b, two.c - one.c};
        const auto l = small_displacement_beam<Lanes>(s, load(beams.inv_length.data() + b), t, du,
                                                      {one.d, one.e, one.f}, {two.d, two.e, two.f});
        // K u is minus the force on the elements.
        const Rows row_1 = rows_of({-l.F_1.x, -l.F_1.y, -l.F_1.z, -l.M_1.x, -l.M_1.y, -l.M_1.z});
        const Rows row_2 = rows_of({l.F_1.x, l.F_1.y, l.F_1.z, -l.M_2.x, -l.M_2.y, -l.M_2.z});
        const int count = static_cast<int>(std::min<std::int64_t>(lanes, end - b));
        if (count == lanes && i[0] >= low && std::max(std::max(j[0], j[1]), std::max(j[2], j[3])) < limit) {
            for (int k = 0; k < lanes; ++k) add_row(f + 6 * i[k], row_1, k), add_row(f + 6 * j[k], row_2, k);
            continue;
        }
        for (int k = 0; k < count; ++k) {
            if (i[k] >= low) add_row(f + 6 * i[k], row_1, k);
            if (j[k] < limit) add_row(f + 6 * j[k], row_2, k);
        }
    }
}

/// The same for springs.
CRAZE_MULTIVERSION void add_springs(const Springs& s, std::int64_t begin, std::int64_t end, std::int64_t low,
                                    std::int64_t limit, const double* u, double* f)
{
    for (std::int64_t k = begin; k < end; ++k) {
        const auto b = static_cast<std::size_t>(k);
        const double *p = u + 6 * s.i[b], *q = u + 6 * s.j[b];
        const double stretch = s.tx[b] * (q[0] - p[0]) + s.ty[b] * (q[1] - p[1]) + s.tz[b] * (q[2] - p[2]);
        const double N = s.k[b] * stretch, force[3] = {N * s.tx[b], N * s.ty[b], N * s.tz[b]};
        if (s.i[b] >= low)
            for (int c = 0; c < 3; ++c) f[6 * s.i[b] + c] -= force[c];
        if (s.j[b] < limit)
            for (int c = 0; c < 3; ++c) f[6 * s.j[b] + c] += force[c];
    }
}

std::int64_t first_from(const std::vector<std::int32_t>& i, std::int64_t count, std::int64_t element)
{
    return std::lower_bound(i.begin(), i.begin() + count, element) - i.begin();
}

}  // namespace

Stiffness::Stiffness(const Lattice& lattice, std::span<const domain::BondKind> kind)
    : elements_(lattice.elements()), section_(lattice.section)
{
    assert(kind.size() == lattice.i.size());
    beams_.resize(static_cast<std::size_t>(std::count(kind.begin(), kind.end(), domain::BondKind::beam)));
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
    share_springs();
}

void Stiffness::share_out()
{
    const auto team = std::clamp<std::int64_t>(beams_.count / 512, 1, threads());  // threads that are worth their start
    shares_.assign(static_cast<std::size_t>(team), {});
    const auto cut = [&](std::int64_t part) -> std::int64_t {
        if (part == 0 || part == team) return part == 0 ? 0 : elements_;
        return beams_.i[static_cast<std::size_t>(beams_.count * part / team)];
    };
    for (std::int64_t s = 0; s < team; ++s) {
        Share& share = shares_[static_cast<std::size_t>(s)];
        share.begin = cut(s), share.end = cut(s + 1);
        share.beam_begin = first_from(beams_.i, beams_.count, share.begin);
        share.beam_end = first_from(beams_.i, beams_.count, share.end);
        std::vector<std::size_t> border;
        for (std::size_t b = 0; b < static_cast<std::size_t>(share.beam_begin); ++b)
            if (beams_.j[b] >= share.begin && beams_.j[b] < share.end) border.push_back(b);
        share.border_beams.resize(border.size());
        for (std::size_t k = 0; k < border.size(); ++k) {
            const std::size_t b = border[k];
            share.border_beams.i[k] = beams_.i[b], share.border_beams.j[k] = beams_.j[b];
            share.border_beams.tx[k] = beams_.tx[b], share.border_beams.ty[k] = beams_.ty[b];
            share.border_beams.tz[k] = beams_.tz[b], share.border_beams.inv_length[k] = beams_.inv_length[b];
        }
    }
    share_springs();
}

void Stiffness::share_springs()
{
    for (Share& share : shares_) {
        share.spring_begin = first_from(springs_.i, springs_.size(), share.begin);
        share.spring_end = first_from(springs_.i, springs_.size(), share.end);
        share.border_springs = {};
        for (std::size_t b = 0; b < static_cast<std::size_t>(share.spring_begin); ++b)
            if (springs_.j[b] >= share.begin && springs_.j[b] < share.end)
                share.border_springs.add(springs_.i[b], springs_.j[b], {springs_.tx[b], springs_.ty[b], springs_.tz[b]},
                                         springs_.k[b]);
    }
}

void Stiffness::apply(std::span<const double> u, std::span<double> f, bool with_springs) const
{
    assert(std::ssize(u) == 6 * elements_ && std::ssize(f) == 6 * elements_);
    parallel_ranges(std::ssize(shares_), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k) {
            const Share& s = shares_[static_cast<std::size_t>(k)];
            std::fill(f.begin() + 6 * s.begin, f.begin() + 6 * s.end, 0.0);
            add_beams(section_, s.border_beams, 0, s.border_beams.count, s.begin, s.end, u.data(), f.data());
            add_beams(section_, beams_, s.beam_begin, s.beam_end, s.begin, s.end, u.data(), f.data());
            if (!with_springs) continue;
            add_springs(s.border_springs, 0, s.border_springs.size(), s.begin, s.end, u.data(), f.data());
            add_springs(springs_, s.spring_begin, s.spring_end, s.begin, s.end, u.data(), f.data());
        }
    });
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

void Stiffness::beam_diagonal(std::span<double> blocks, std::span<const std::int32_t> group) const
{
    assert(std::ssize(blocks) == 36 * elements_);
    const auto add = [&](const Share& s, const Beams& beams, std::int64_t begin, std::int64_t end) {
        for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
            const auto i = static_cast<std::size_t>(beams.i[b]), j = static_cast<std::size_t>(beams.j[b]);
            if (!group.empty() && group[i] == group[j]) continue;
            const Vec3 t{beams.tx[b], beams.ty[b], beams.tz[b]};
            const double inv_L = beams.inv_length[b];
            if (beams.i[b] >= s.begin) add_end_block(blocks.data() + 36 * i, section_, t, inv_L, 1.0);
            if (beams.j[b] < s.end) add_end_block(blocks.data() + 36 * j, section_, t, inv_L, -1.0);
        }
    };
    parallel_tasks(std::ssize(shares_), [&](std::int64_t k) {
        const Share& s = shares_[static_cast<std::size_t>(k)];
        add(s, s.border_beams, 0, s.border_beams.count);
        add(s, beams_, s.beam_begin, s.beam_end);
    });
}

void Stiffness::diagonal(std::span<double> blocks) const
{
    beam_diagonal(blocks);
    for (std::size_t b = 0; b < springs_.i.size(); ++b)
        for (const std::int32_t end : {springs_.i[b], springs_.j[b]})
            add_projector(blocks.data() + 36 * std::int64_t{end}, 0.0, springs_.k[b],
                          {springs_.tx[b], springs_.ty[b], springs_.tz[b]});
}

}  // namespace craze::mechanics
