#include "craze/mechanics/multilevel.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/lanes.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace craze::mechanics {

namespace {

using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

using Shorts = std::int16_t __attribute__((vector_size(16)));
using Wholes = std::int32_t __attribute__((vector_size(32)));
using Quad = float __attribute__((vector_size(16)));

/// Inverse of a symmetric positive semi-definite block, scaled to a unit diagonal and shifted a little so that a
/// direction without stiffness is finite; rows that are held are empty and stay so. Sixteen bits an entry: thanks to
/// the shift that is less than the least eigenvalue (0.09 against 0.16), and iterations wait for less memory.
void keep_inverse(const Block& block, std::int16_t* entries, float* outer)
{
    constexpr double shift = 1e-3;
    Eigen::Matrix<double, 6, 1> scale;
    for (int c = 0; c < 6; ++c) scale[c] = block(c, c) > 0.0 ? 1.0 / std::sqrt(block(c, c)) : 0.0;
    Block unit = scale.asDiagonal() * block * scale.asDiagonal();
    for (int c = 0; c < 6; ++c) unit(c, c) = scale[c] > 0.0 ? 1.0 + shift : 1.0;
    const Block inverse = unit.llt().solve(Block::Identity());
    const double largest = inverse.cwiseAbs().maxCoeff();
    for (int r = 0; r < 6; ++r) {
        outer[r] = static_cast<float>(scale[r] * std::sqrt(largest / 32767.0));
        for (int c = 0; c < 6; ++c)
            *entries++ =
                static_cast<std::int16_t>(std::lround(inverse(std::max(r, c), std::min(r, c)) / largest * 32767.0));
    }
}

/// Newton and metre become EA and R.
void make_dimensionless(std::span<double> blocks, double EA, double R)
{
    const double by[3] = {R / EA, 1.0 / EA, 1.0 / (EA * R)};
    parallel_ranges(std::ssize(blocks) / 36, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t e = begin; e < end; ++e)
            for (int r = 0; r < 6; ++r)
                for (int c = 0; c < 6; ++c)
                    blocks[static_cast<std::size_t>(36 * e + 6 * r + c)] *= by[(r > 2) + (c > 2)];
    });
}

/// D^-1 r of one row: a row of six entries read as eight, of which the last two meet zeros.
CRAZE_INLINE Floats times(const std::int16_t* entries, const float* scale, Floats r)
{
    const Floats outer = load(scale);
    float inner[floats];
    store(inner, outer * r);
    Floats sum{};
    for (int c = 0; c < 6; ++c) {
        Shorts row;
        std::memcpy(&row, entries + 6 * c, sizeof row);
        sum += __builtin_convertvector(__builtin_convertvector(row, Wholes), Floats) * inner[c];
    }
    return outer * sum;
}

CRAZE_INLINE Quad load_arm(const float* arm)
{
    Quad a;
    std::memcpy(&a, arm, sizeof a);
    return a;
}
/// What a force and a moment at a node are about the centre of its parent.
CRAZE_INLINE Floats about_parent(Quad arm, Floats f)
{
    const Quad none{};
    const Floats one = __builtin_shufflevector(arm, none, 4, 4, 4, 1, 2, 0, 4, 4),
                 two = __builtin_shufflevector(arm, none, 4, 4, 4, 2, 0, 1, 4, 4);
    return f + one * __builtin_shufflevector(f, f, 0, 0, 0, 2, 0, 1, 0, 0) -
           two * __builtin_shufflevector(f, f, 0, 0, 0, 1, 2, 0, 0, 0);
}
/// How a node moves with its parent.
CRAZE_INLINE Floats with_parent(Quad arm, Floats y)
{
    const Quad none{};
    const Floats one = __builtin_shufflevector(arm, none, 2, 0, 1, 4, 4, 4, 4, 4),
                 two = __builtin_shufflevector(arm, none, 1, 2, 0, 4, 4, 4, 4, 4);
    return y + one * __builtin_shufflevector(y, y, 4, 5, 3, 0, 0, 0, 0, 0) -
           two * __builtin_shufflevector(y, y, 5, 3, 4, 0, 0, 0, 0, 0);
}

CRAZE_INLINE double total(Floats a)
{
    double sum = 0.0;
    for (int c = 0; c < 6; ++c) sum += double{a[c]};
    return sum;
}

/// z = D^-1 r of nodes [begin, end); gives r . z.
CRAZE_MULTIVERSION double answer_rows(const std::int16_t* inverse, const float* scale, const float* r, float* z,
                                      std::int64_t begin, std::int64_t end)
{
    Floats sum{};
    for (std::int64_t e = begin; e < end; ++e) {
        const Floats load_here = load(r + floats * e);
        const Floats answer = times(inverse + 36 * e, scale + floats * e, load_here);
        store(z + floats * e, answer);
        sum += answer * load_here;
    }
    return total(sum);
}

/// Loads of parents += those of nodes [begin, end).
CRAZE_MULTIVERSION void gather_rows(const std::int32_t* parent, const float* arm, const float* r, float* loads,
                                    std::int64_t begin, std::int64_t end)
{
    for (std::int64_t e = begin; e < end; ++e) {
        if (parent[e] < 0) continue;
        float* to = loads + floats * parent[e];
        store(to, load(to) + about_parent(load_arm(arm + 4 * e), load(r + floats * e)));
    }
}
/// Both, without reading r twice.
CRAZE_MULTIVERSION double descend_rows(const std::int16_t* inverse, const float* scale, const std::int32_t* parent,
                                       const float* arm, const float* r, float* z, float* loads, std::int64_t begin,
                                       std::int64_t end)
{
    Floats sum{};
    for (std::int64_t e = begin; e < end; ++e) {
        const Floats load_here = load(r + floats * e);
        const Floats answer = times(inverse + 36 * e, scale + floats * e, load_here);
        store(z + floats * e, answer);
        sum += answer * load_here;
        if (parent[e] < 0) continue;
        float* to = loads + floats * parent[e];
        store(to, load(to) + about_parent(load_arm(arm + 4 * e), load_here));
    }
    return total(sum);
}

/// Answers of nodes [begin, end) += how their parents move.
CRAZE_MULTIVERSION void follow_rows(const std::int32_t* parent, const float* arm, const float* answer, float* z,
                                    std::int64_t begin, std::int64_t end)
{
    for (std::int64_t e = begin; e < end; ++e)
        if (parent[e] >= 0)
            store(z + floats * e,
                  load(z + floats * e) + with_parent(load_arm(arm + 4 * e), load(answer + floats * parent[e])));
}

/// d += step p, p = z + (how the parents move) + beta p.
CRAZE_MULTIVERSION void ascend_rows(const std::int32_t* parent, const float* arm, const float* answer, const float* z,
                                    float step, float* d, float beta, float* p, std::int64_t begin, std::int64_t end)
{
    for (std::int64_t e = begin; e < end; ++e) {
        const Floats before = load(p + floats * e);
        store(d + floats * e, load(d + floats * e) + step * before);
        Floats next = load(z + floats * e) + beta * before;
        if (parent != nullptr && parent[e] >= 0)
            next += with_parent(load_arm(arm + 4 * e), load(answer + floats * parent[e]));
        store(p + floats * e, next);
    }
}

/// Elements at the ends of springs that are in one list and not in the other; both are sorted by (i, j).
std::vector<std::uint8_t> touched_by_change(const Springs& before, const Springs& now, std::int64_t elements)
{
    std::vector<std::uint8_t> touched(static_cast<std::size_t>(elements), 0);
    const auto touch = [&](const Springs& s, std::size_t b) {
        touched[static_cast<std::size_t>(s.i[b])] = touched[static_cast<std::size_t>(s.j[b])] = 1;
    };
    std::size_t a = 0, b = 0;
    while (a < before.i.size() || b < now.i.size()) {
        const auto key = [](const Springs& s, std::size_t k) {
            constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();
            return k < s.i.size() ? std::pair{s.i[k], s.j[k]} : std::pair{none, none};
        };
        const bool same = key(before, a) == key(now, b);
        if (same && before.k[a] == now.k[b])
            ++a, ++b;
        else if (same || key(before, a) < key(now, b))
            touch(before, a++);
        else
            touch(now, b++);
    }
    return touched;
}

}  // namespace

void Multilevel::set_up(const Lattice& lattice, const Stiffness& stiffness, std::span<const std::int64_t> imposed)
{
    elements_ = lattice.elements();
    const std::int64_t blocks = (elements_ + block_rows - 1) / block_rows;
    imposed_.assign(imposed.begin(), imposed.end());
    imposed_first_.assign(static_cast<std::size_t>(blocks) + 1, 0);
    held_.assign(static_cast<std::size_t>(elements_), 0);
    for (const std::int64_t dof : imposed) {
        held_[static_cast<std::size_t>(dof / 6)] |= static_cast<std::uint8_t>(1U << (dof % 6));
        ++imposed_first_[static_cast<std::size_t>(dof / 6 / block_rows) + 1];
    }
    for (std::size_t b = 1; b < imposed_first_.size(); ++b) imposed_first_[b] += imposed_first_[b - 1];

    find_groups(lattice, stiffness.beams());
    beams_.assign(static_cast<std::size_t>(36 * elements_), 0.0);
    stiffness.beam_diagonal(beams_);
    make_dimensionless(beams_, stiffness.section().EA, lattice.mean_radius);
    own_.resize(elements_);
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) add_up_beams(levels_[l], lattice, stiffness);
    springs_ = {};
    make_inverses(lattice, stiffness, std::vector<std::uint8_t>(static_cast<std::size_t>(elements_), 1));
    if (levels_.empty()) return;
    coarse_.set_up(lattice, stiffness, imposed_, levels_.back().groups);
}

void Multilevel::find_groups(const Lattice& lattice, const Beams& beams)
{
    levels_.clear();
    std::vector<std::int32_t> group_of(static_cast<std::size_t>(elements_));  // in the last level made
    std::vector<Vec3> centres(group_of.size());                               // of its nodes
    for (std::int32_t e = 0; e < lattice.elements(); ++e)
        group_of[static_cast<std::size_t>(e)] = e, centres[static_cast<std::size_t>(e)] = lattice.centre(e);
    // The top grows with the lattice so that its factor stays small beside the iterations.
    const std::int64_t top = std::max<std::int64_t>(60, elements_ / 140);
    const double R = lattice.mean_radius;
    std::vector<std::int32_t> i, j;
    for (std::int64_t size = 1; 2 * size <= top;) {
        const std::int64_t factor = size == 1 ? 12 : top / size > 10 ? 6 : std::max<std::int64_t>(2, top / size);
        i.clear(), j.clear();
        for (std::size_t b = 0; b < static_cast<std::size_t>(beams.count); ++b) {
            const std::int32_t from = group_of[static_cast<std::size_t>(beams.i[b])],
                               to = group_of[static_cast<std::size_t>(beams.j[b])];
            if (from != to) i.push_back(from), j.push_back(to);
        }
        std::vector<std::int64_t> members;
        const auto nodes = static_cast<std::int64_t>(centres.size());
        auto parent = grow_groups(graph_of(nodes, i, j), factor, size == 1 ? block_rows : nodes, members);
        // A piece of matter that is one node already goes on as its own parent.
        for (std::size_t k = 0; k < parent.size(); ++k)
            if (parent[k] < 0 && size > 1) parent[k] = static_cast<std::int32_t>(members.size()), members.push_back(1);
        std::vector<std::int32_t> of(group_of.size());
        for (std::size_t e = 0; e < of.size(); ++e)
            of[e] = group_of[e] < 0 ? -1 : parent[static_cast<std::size_t>(group_of[e])];
        Aggregates groups = aggregates_of(lattice, std::move(of), std::ssize(members));
        size *= factor;

        Level level;
        level.count = groups.count();
        level.parent = std::move(parent);
        level.arm.assign(4 * centres.size(), 0.0F);
        for (std::size_t k = 0; k < centres.size(); ++k) {
            if (level.parent[k] < 0) continue;
            const Vec3 a = (centres[k] - groups.centre[static_cast<std::size_t>(level.parent[k])]) / R;
            for (std::size_t c = 0; c < 3; ++c) level.arm[4 * k + c] = static_cast<float>(a[static_cast<int>(c)]);
        }
        level.load.assign(static_cast<std::size_t>(floats * level.count), 0.0F), level.answer = level.load;
        group_of = groups.of, centres = groups.centre;
        level.groups = std::move(groups);
        levels_.push_back(std::move(level));
    }
    find_first_groups();
}

void Multilevel::find_first_groups()
{
    if (levels_.empty()) return;
    const Level& level = levels_.front();
    first_group_.assign(imposed_first_.size(), static_cast<std::int32_t>(level.count));
    for (std::int64_t e = elements_ - 1; e >= 0; --e)
        if (const std::int32_t g = level.groups.of[static_cast<std::size_t>(e)]; g >= 0) {
            auto& first = first_group_[static_cast<std::size_t>(e / block_rows)];
            first = std::min(first, g);
        }
    for (std::size_t b = first_group_.size() - 1; b > 0; --b)
        first_group_[b - 1] = std::min(first_group_[b - 1], first_group_[b]);
}

void Multilevel::update(const Lattice& lattice, const Stiffness& stiffness)
{
    make_inverses(lattice, stiffness, touched_by_change(springs_, stiffness.springs(), elements_));
    if (!levels_.empty()) coarse_.update(stiffness);
}

void Multilevel::make_inverses(const Lattice& lattice, const Stiffness& stiffness,
                               const std::vector<std::uint8_t>& touched)
{
    springs_ = stiffness.springs();
    invert(lattice, stiffness, touched, nullptr, beams_, own_);
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l)
        invert(lattice, stiffness, touched, &levels_[l].groups, levels_[l].beams, levels_[l].inverse);
}

/// Of the groups of one level: beams that leave a group, seen from its centre.
void Multilevel::add_up_beams(Level& level, const Lattice& lattice, const Stiffness& stiffness)
{
    const Aggregates& groups = level.groups;
    std::vector<double> crossing(beams_.size(), 0.0);
    stiffness.beam_diagonal(crossing, groups.of);
    make_dimensionless(crossing, stiffness.section().EA, lattice.mean_radius);
    level.beams.assign(static_cast<std::size_t>(36 * level.count), 0.0);
    level.inverse.resize(level.count);
    parallel_ranges(level.count, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t g = begin; g < end; ++g) {
            Eigen::Map<Block> sum(level.beams.data() + 36 * g);
            for (auto m = groups.first[static_cast<std::size_t>(g)]; m < groups.first[static_cast<std::size_t>(g) + 1];
                 ++m) {
                const auto e = static_cast<std::size_t>(groups.elements[static_cast<std::size_t>(m)]);
                Block own = Eigen::Map<const Block>(crossing.data() + 36 * e);
                if (held_[e] != 0)  // where it is held an element stays behind its group
                    for (int r = 0; r < 6; ++r)
                        for (int c = 0; c < 6; ++c) {
                            const bool r_held = held_[e] >> r & 1, c_held = held_[e] >> c & 1;
                            if (r_held != c_held) own(r, c) = 0.0;
                            if (r_held && c_held) own(r, c) = beams_[36 * e + static_cast<std::size_t>(6 * r + c)];
                        }
                const Vec3 a =
                    (lattice.centre(static_cast<std::int32_t>(e)) - groups.centre[static_cast<std::size_t>(g)]) /
                    lattice.mean_radius;
                Block motion = Block::Identity();
                motion(0, 4) = a.z, motion(0, 5) = -a.y, motion(1, 5) = a.x;
                motion(1, 3) = -a.z, motion(2, 3) = a.y, motion(2, 4) = -a.x;
                sum.noalias() += motion.transpose() * (own * motion);
            }
        }
    });
}

void Multilevel::Inverses::resize(std::int64_t nodes)
{
    entries.assign(static_cast<std::size_t>(36 * nodes + floats), 0);
    scale.assign(static_cast<std::size_t>(floats * nodes), 0.0F);
}

/// Inverses of the nodes of one level that hold a touched element; without groups, of the elements themselves.
void Multilevel::invert(const Lattice& lattice, const Stiffness& stiffness, const std::vector<std::uint8_t>& touched,
                        const Aggregates* groups, std::span<const double> beams, Inverses& inverses) const
{
    const auto node_of = [&](std::int32_t e) { return groups ? groups->of[static_cast<std::size_t>(e)] : e; };
    std::vector<std::int32_t> place(beams.size() / 36, -1), nodes;
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(elements_); ++e) {
        if (!touched[static_cast<std::size_t>(e)] || node_of(e) < 0) continue;
        auto& at = place[static_cast<std::size_t>(node_of(e))];
        if (at < 0) at = static_cast<std::int32_t>(nodes.size()), nodes.push_back(node_of(e));
    }
    const BeamSection& section = stiffness.section();
    const double R = lattice.mean_radius;
    std::vector<Block> blocks(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
        blocks[k] = Eigen::Map<const Block>(beams.data() + 36 * std::int64_t{nodes[k]});
    for (std::size_t b = 0; b < springs_.i.size(); ++b) {
        const std::int32_t ends[2] = {springs_.i[b], springs_.j[b]};
        if (groups && node_of(ends[0]) == node_of(ends[1])) continue;
        for (const std::int32_t e : ends) {
            const std::int32_t node = node_of(e), at = node < 0 ? -1 : place[static_cast<std::size_t>(node)];
            if (at < 0) continue;
            Vec3 t{springs_.tx[b], springs_.ty[b], springs_.tz[b]}, turn{};
            for (int c = 0; c < 3; ++c)
                if (held_[static_cast<std::size_t>(e)] >> c & 1) t[c] = 0.0;
            if (groups) turn = cross((lattice.centre(e) - groups->centre[static_cast<std::size_t>(node)]) / R, t);
            const Eigen::Matrix<double, 6, 1> g{t.x, t.y, t.z, turn.x, turn.y, turn.z};
            blocks[static_cast<std::size_t>(at)].noalias() += (springs_.k[b] * R / section.EA) * g * g.transpose();
        }
    }
    parallel_ranges(std::ssize(nodes), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k) {
            Block& block = blocks[static_cast<std::size_t>(k)];
            const auto node = static_cast<std::size_t>(nodes[static_cast<std::size_t>(k)]);
            for (int c = 0; c < 6 && !groups; ++c) {
                // What nothing holds now may be pushed later, before this inverse is made anew.
                if (!(block(c, c) > 0.0)) block(c, c) = c < 3 ? 0.5 : section.EI / (section.EA * R * R);
                if (!(held_[node] >> c & 1)) continue;
                block.row(c).setZero();
                block.col(c).setZero();
            }
            keep_inverse(block, inverses.entries.data() + 36 * node, inverses.scale.data() + floats * node);
        }
    });
}

double Multilevel::descend(std::int64_t block, const float* r, float* z)
{
    const std::int64_t begin = block * block_rows, end = std::min(begin + block_rows, elements_);
    if (levels_.empty()) return answer_rows(own_.entries.data(), own_.scale.data(), r, z, begin, end);
    Level& level = levels_.front();
    const std::int64_t g_begin = first_group_[static_cast<std::size_t>(block)],
                       g_end = first_group_[static_cast<std::size_t>(block) + 1];
    std::fill(level.load.begin() + floats * g_begin, level.load.begin() + floats * g_end, 0.0F);
    double sum = descend_rows(own_.entries.data(), own_.scale.data(), level.parent.data(), level.arm.data(), r, z,
                              level.load.data(), begin, end);
    if (levels_.size() > 1)
        sum += answer_rows(level.inverse.entries.data(), level.inverse.scale.data(), level.load.data(),
                           level.answer.data(), g_begin, g_end);
    return sum;
}

double Multilevel::solve_coarse()
{
    double sum = 0.0;
    if (levels_.empty()) return sum;
    for (std::size_t l = 1; l < levels_.size(); ++l) {
        Level& level = levels_[l];
        std::fill(level.load.begin(), level.load.end(), 0.0F);
        gather_rows(level.parent.data(), level.arm.data(), levels_[l - 1].load.data(), level.load.data(), 0,
                    levels_[l - 1].count);
        if (l + 1 < levels_.size())
            sum += answer_rows(level.inverse.entries.data(), level.inverse.scale.data(), level.load.data(),
                               level.answer.data(), 0, level.count);
    }
    Level& top = levels_.back();
    std::copy(top.load.begin(), top.load.end(), top.answer.begin());
    coarse_.solve(top.answer);
    for (std::int64_t g = 0; g < top.count; ++g)
        for (std::int64_t c = 0; c < 6; ++c) {
            const auto k = static_cast<std::size_t>(floats * g + c);
            sum += double{top.load[k]} * double{top.answer[k]};
        }
    for (std::size_t l = levels_.size() - 1; l > 0; --l)
        follow_rows(levels_[l].parent.data(), levels_[l].arm.data(), levels_[l].answer.data(),
                    levels_[l - 1].answer.data(), 0, levels_[l - 1].count);
    return sum;
}

void Multilevel::ascend(std::int64_t block, const float* z, float step, float* d, float beta, float* p) const
{
    const std::int64_t begin = block * block_rows, end = std::min(begin + block_rows, elements_);
    if (levels_.empty()) {
        ascend_rows(nullptr, nullptr, nullptr, z, step, d, beta, p, begin, end);
    } else {
        const Level& level = levels_.front();
        ascend_rows(level.parent.data(), level.arm.data(), level.answer.data(), z, step, d, beta, p, begin, end);
    }
    for (auto k = imposed_first_[static_cast<std::size_t>(block)];
         k < imposed_first_[static_cast<std::size_t>(block) + 1]; ++k) {
        const std::int64_t dof = imposed_[static_cast<std::size_t>(k)];
        p[floats * (dof / 6) + dof % 6] = 0.0F;
    }
}

}  // namespace craze::mechanics
