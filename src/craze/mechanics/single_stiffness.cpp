#include "craze/mechanics/single_stiffness.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/lanes.hpp"
#include "craze/mechanics/laws.hpp"

#include <algorithm>

namespace craze::mechanics {

void SingleBonds::resize(std::size_t n)
{
    count = static_cast<std::int64_t>(n);
    // A pack and its foresight may read past the last bond: harmless ones lie there.
    const std::size_t padded = n + static_cast<std::size_t>(ahead + floats);
    i.assign(padded, 0), j.assign(padded, 0);
    for (auto* values : {&tx, &ty, &tz, &k}) values->assign(padded, 0.0F);
}

void SingleBonds::pick(const SingleBonds& from, const std::vector<std::size_t>& list)
{
    resize(list.size());
    for (std::size_t to = 0; to < list.size(); ++to) {
        const std::size_t b = list[to];
        i[to] = from.i[b], j[to] = from.j[b];
        tx[to] = from.tx[b], ty[to] = from.ty[b], tz[to] = from.tz[b], k[to] = from.k[b];
    }
}

namespace {

CRAZE_MULTIVERSION void add_beams(const SingleSection& section, const SingleBonds& beams, std::int64_t begin,
                                  std::int64_t end, std::int64_t low, std::int64_t limit, const float* p, float* q)
{
    const SingleSection s = section;
    const std::int32_t *all_i = beams.i.data(), *all_j = beams.j.data();
    const float *tx = beams.tx.data(), *ty = beams.ty.data(), *tz = beams.tz.data(), *k_0 = beams.k.data();
    for (std::int64_t b = begin; b < end; b += floats) {
        const std::int32_t *i = all_i + b, *j = all_j + b;
        Floats one[floats], two[floats];
        for (int k = 0; k < floats; ++k) {
            __builtin_prefetch(p + floats * j[ahead + k]), __builtin_prefetch(q + floats * j[ahead + k], 1);
            one[k] = load(p + floats * i[k]), two[k] = load(p + floats * j[k]);
        }
        transpose(one), transpose(two);
        const Triple<Floats> t{load(tx + b), load(ty + b), load(tz + b)};
        const Triple<Floats> du{two[0] - one[0], two[1] - one[1], two[2] - one[2]};
        const auto l = small_displacement_beam<Floats>(s, load(k_0 + b), t, du, {one[3], one[4], one[5]},
                                                       {two[3], two[4], two[5]});
        // K p is minus the force on the elements.
        const Floats none{};
        Floats on_1[floats] = {-l.F_1.x, -l.F_1.y, -l.F_1.z, -l.M_1.x, -l.M_1.y, -l.M_1.z, none, none};
        Floats on_2[floats] = {l.F_1.x, l.F_1.y, l.F_1.z, -l.M_2.x, -l.M_2.y, -l.M_2.z, none, none};
        transpose(on_1), transpose(on_2);
        const int count = static_cast<int>(std::min<std::int64_t>(floats, end - b));
        for (int k = 0; k < count; ++k) {
            float *f = q + floats * i[k], *g = q + floats * j[k];
            if (i[k] >= low) store(f, load(f) + on_1[k]);
            if (j[k] < limit) store(g, load(g) + on_2[k]);
        }
    }
}

CRAZE_MULTIVERSION void add_springs(const SingleBonds& springs, std::int64_t begin, std::int64_t end, std::int64_t low,
                                    std::int64_t limit, const float* p, float* q)
{
    for (std::int64_t k = begin; k < end; ++k) {
        const auto b = static_cast<std::size_t>(k);
        const std::int32_t i = springs.i[b], j = springs.j[b];
        const float *u = p + floats * i, *v = p + floats * j, t[3] = {springs.tx[b], springs.ty[b], springs.tz[b]};
        const float N = springs.k[b] * (t[0] * (v[0] - u[0]) + t[1] * (v[1] - u[1]) + t[2] * (v[2] - u[2]));
        if (i >= low && i < limit)
            for (int c = 0; c < 3; ++c) q[floats * i + c] -= N * t[c];
        if (j >= low && j < limit)
            for (int c = 0; c < 3; ++c) q[floats * j + c] += N * t[c];
    }
}

/// The first bond of each block, and the end.
std::vector<std::int64_t> first_of_blocks(const SingleBonds& bonds, std::int64_t blocks)
{
    std::vector<std::int64_t> first(static_cast<std::size_t>(blocks) + 1, 0);
    for (std::size_t b = 0; b < static_cast<std::size_t>(bonds.count); ++b)
        ++first[static_cast<std::size_t>(bonds.i[b] / block_rows) + 1];
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    return first;
}

/// Bonds before `from` that end in rows [low, limit).
std::vector<std::size_t> ending_in(const std::vector<std::int32_t>& j, std::int64_t from, std::int64_t low,
                                   std::int64_t limit)
{
    std::vector<std::size_t> list;
    for (std::size_t b = 0; b < static_cast<std::size_t>(from); ++b)
        if (j[b] >= low && j[b] < limit) list.push_back(b);
    return list;
}

}  // namespace

void SingleStiffness::set_beams(const Stiffness& stiffness, double mean_radius)
{
    const Beams& from = stiffness.beams();
    const BeamSection& section = stiffness.section();
    elements_ = stiffness.elements(), unit_ = mean_radius, EA_ = section.EA;
    const double per_EI = 1.0 / (section.EA * unit_ * unit_);
    section_ = {1.0F, static_cast<float>(section.EI * per_EI), static_cast<float>(section.GJ * per_EI)};
    beams_.resize(static_cast<std::size_t>(from.count));
    for (std::size_t b = 0; b < static_cast<std::size_t>(from.count); ++b) {
        beams_.i[b] = from.i[b], beams_.j[b] = from.j[b];
        beams_.tx[b] = static_cast<float>(from.tx[b]), beams_.ty[b] = static_cast<float>(from.ty[b]);
        beams_.tz[b] = static_cast<float>(from.tz[b]), beams_.k[b] = static_cast<float>(from.inv_length[b] * unit_);
    }
    const auto team = std::clamp<std::int64_t>(beams_.count / 1024, 1, std::min<std::int64_t>(threads(), blocks()));
    shares_.assign(static_cast<std::size_t>(team), {});
    share_of_.assign(static_cast<std::size_t>(blocks()), 0);
    first_beam_ = first_of_blocks(beams_, blocks());
    std::int64_t begin = 0;
    for (std::int64_t part = 0; part < team; ++part) {
        Share& share = shares_[static_cast<std::size_t>(part)];
        std::int64_t end = blocks();
        if (part + 1 < team && beams_.count > 0)
            end = beams_.i[static_cast<std::size_t>(beams_.count * (part + 1) / team)] / block_rows;
        share.begin = begin, share.end = begin = std::max(begin, end);
        const std::int64_t low = share.begin * block_rows, limit = share.end * block_rows;
        share.border_beams.pick(beams_,
                                ending_in(beams_.j, first_beam_[static_cast<std::size_t>(share.begin)], low, limit));
        std::fill(share_of_.begin() + share.begin, share_of_.begin() + share.end, static_cast<std::int32_t>(part));
    }
    set_springs({});
}

/// Once for each block that an end lies in: a row gets all its beams first, whoever computes them, then its springs.
void SingleStiffness::set_springs(const Springs& from)
{
    const auto visit_blocks = [&](std::size_t b, auto&& visit) {
        const std::int64_t one = from.i[b] / block_rows, two = from.j[b] / block_rows;
        visit(static_cast<std::size_t>(one));
        if (two != one) visit(static_cast<std::size_t>(two));
    };
    first_spring_.assign(static_cast<std::size_t>(blocks()) + 1, 0);
    for (std::size_t b = 0; b < from.i.size(); ++b)
        visit_blocks(b, [&](std::size_t block) { ++first_spring_[block + 1]; });
    for (std::size_t k = 1; k < first_spring_.size(); ++k) first_spring_[k] += first_spring_[k - 1];
    springs_.resize(static_cast<std::size_t>(first_spring_.back()));
    auto fill = first_spring_;
    for (std::size_t b = 0; b < from.i.size(); ++b)
        visit_blocks(b, [&](std::size_t block) {
            const auto to = static_cast<std::size_t>(fill[block]++);
            springs_.i[to] = from.i[b], springs_.j[to] = from.j[b];
            springs_.tx[to] = static_cast<float>(from.tx[b]), springs_.ty[to] = static_cast<float>(from.ty[b]);
            springs_.tz[to] = static_cast<float>(from.tz[b]);
            springs_.k[to] = static_cast<float>(from.k[b] * unit_ / EA_);
        });
}

void SingleStiffness::add_border(std::int64_t part, const float* p, float* q) const
{
    const Share& s = shares_[static_cast<std::size_t>(part)];
    const std::int64_t low = s.begin * block_rows, limit = s.end * block_rows;
    add_beams(section_, s.border_beams, 0, s.border_beams.count, low, limit, p, q);
}

void SingleStiffness::add_block(std::int64_t block, const float* p, float* q) const
{
    const auto b = static_cast<std::size_t>(block);
    const Share& s = shares_[static_cast<std::size_t>(share_of_[b])];
    const std::int64_t low = s.begin * block_rows, limit = s.end * block_rows;
    add_beams(section_, beams_, first_beam_[b], first_beam_[b + 1], low, limit, p, q);
    add_springs(springs_, first_spring_[b], first_spring_[b + 1], block * block_rows, (block + 1) * block_rows, p, q);
}

}  // namespace craze::mechanics
