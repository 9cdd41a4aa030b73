#include "craze/mechanics/inner_solver.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/mechanics/lanes.hpp"
#include "craze/mechanics/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace craze::mechanics {

namespace {

constexpr std::int64_t block_length = floats * block_rows;

CRAZE_INLINE double total(Floats a)
{
    double sum = 0.0;
    for (int c = 0; c < floats; ++c) sum += double{a[c]};
    return sum;
}

CRAZE_MULTIVERSION double dot_block(const float* a, const float* b)
{
    Floats sum{};
    for (std::int64_t k = 0; k < block_length; k += floats) sum += load(a + k) * load(b + k);
    return total(sum);
}

/// r -= s q, and q is empty again; gives the new r . r.
CRAZE_MULTIVERSION double step_block(float s, float* q, float* r)
{
    Floats sum{};
    for (std::int64_t k = 0; k < block_length; k += floats) {
        const Floats left = load(r + k) - s * load(q + k);
        store(r + k, left);
        store(q + k, Floats{});
        sum += left * left;
    }
    return total(sum);
}

/// The blocks of each part, one thread each; gives the sum of what work(block) says, added in order.
template <class Before, class Work>
double over_blocks(const SingleStiffness& stiffness, std::vector<double>& sums, Before&& before, Work&& work)
{
    parallel_ranges(stiffness.parts(), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t part = begin; part < end; ++part) {
            before(part);
            for (std::int64_t b = stiffness.begin_block(part); b < stiffness.begin_block(part + 1); ++b)
                sums[static_cast<std::size_t>(b)] = work(b);
        }
    });
    double sum = 0.0;
    for (const double s : sums) sum += s;
    return sum;
}
constexpr auto nothing = [](std::int64_t) {};

}  // namespace

InnerSolver::InnerSolver(const Lattice& lattice) : lattice_(lattice), EA_(lattice.section.EA) {}

void InnerSolver::set_beams(const Stiffness& stiffness)
{
    stiffness_.set_beams(stiffness, lattice_.mean_radius);
    const auto blocks = static_cast<std::size_t>(stiffness_.blocks());
    for (auto* v : {&d_, &r_, &z_, &p_, &q_}) v->assign(blocks * static_cast<std::size_t>(block_length), 0.0F);
    part_.assign(blocks, 0.0), norm_.assign(blocks, 0.0);
}

void InnerSolver::set_springs(const Springs& springs) { stiffness_.set_springs(springs); }

void InnerSolver::set_up_preconditioner(const Stiffness& stiffness, std::span<const std::int64_t> imposed)
{
    preconditioner_.set_up(lattice_, stiffness, imposed);
    imposed_.assign(imposed.begin(), imposed.end());
    imposed_first_.assign(static_cast<std::size_t>(stiffness_.blocks()) + 1, 0);
    for (const std::int64_t dof : imposed) ++imposed_first_[static_cast<std::size_t>(dof / 6 / block_rows) + 1];
    for (std::size_t b = 1; b < imposed_first_.size(); ++b) imposed_first_[b] += imposed_first_[b - 1];
}

/// The power of two next to the largest number of r in EA, in N: scaled by it, single precision never runs out of small
/// numbers, however small the load, and no digit is lost. 0 where all are 0.
double InnerSolver::unit_of(std::span<const double> r) const
{
    const double per_moment = 1.0 / lattice_.mean_radius;
    double largest = 0.0;
    for (std::size_t row = 0; row < r.size(); row += 6)
        for (std::size_t c = 0; c < 6; ++c)
            largest = std::max(largest, std::abs(r[row + c]) * (c < 3 ? 1.0 : per_moment));
    return largest > 0.0 ? EA_ * std::exp2(std::round(std::log2(largest / EA_))) : 0.0;
}

/// r_ = r in units of `unit`, in the rows of one block.
void InnerSolver::take(std::int64_t block, std::span<const double> r, double unit)
{
    const double per_force = 1.0 / unit, per_moment = per_force / lattice_.mean_radius;
    const std::int64_t end = std::min<std::int64_t>((block + 1) * block_rows, lattice_.elements());
    for (std::int64_t e = block * block_rows; e < end; ++e)
        for (std::int64_t c = 0; c < 6; ++c)
            r_[static_cast<std::size_t>(floats * e + c)] =
                static_cast<float>(r[static_cast<std::size_t>(6 * e + c)] * (c < 3 ? per_force : per_moment));
}

/// d = `rows`, which answer loads in units of `unit`, in m and rad, in one block.
void InnerSolver::give(std::int64_t block, std::span<const float> rows, double unit, std::span<double> d) const
{
    const double angle = unit / EA_, length = angle * lattice_.mean_radius;
    const std::int64_t end = std::min<std::int64_t>((block + 1) * block_rows, lattice_.elements());
    for (std::int64_t e = block * block_rows; e < end; ++e)
        for (std::int64_t c = 0; c < 6; ++c)
            d[static_cast<std::size_t>(6 * e + c)] =
                double{rows[static_cast<std::size_t>(floats * e + c)]} * (c < 3 ? length : angle);
}

/// r is new after a step along p and its blocks have descended, r . z so far is rz: d follows, and the next direction.
void InnerSolver::prepare(double rz, float step)
{
    const double before = rz_;
    rz_ = rz + preconditioner_.solve_coarse();
    const auto beta = static_cast<float>(before > 0.0 ? rz_ / before : 0.0);
    over_blocks(stiffness_, part_, nothing, [&](std::int64_t b) {
        preconditioner_.ascend(b, z_.data(), step, d_.data(), beta, p_.data());
        return 0.0;
    });
}

InnerSolver::Result InnerSolver::solve(std::span<const double> r, double target, std::int64_t most, bool go_on,
                                       std::span<double> d)
{
    std::fill(d.begin(), d.end(), 0.0);
    Result out;
    const double unit = unit_of(r);
    if (!(unit > 0.0)) return out;
    if (go_on && unit_ != unit) {
        const auto change = static_cast<float>(unit_ / unit);  // a power of two: no digit is lost
        for (float& v : p_) v *= change;
        rz_ *= double{change} * double{change};
    }
    unit_ = unit;
    over_blocks(stiffness_, part_, nothing, [&](std::int64_t b) {
        take(b, r, unit);
        std::fill_n(d_.begin() + block_length * b, block_length, 0.0F);
        return 0.0;
    });
    const auto rows = [&](std::vector<float>& v, std::int64_t b) { return v.data() + block_length * b; };
    if (!go_on) {
        rz_ = 0.0;
        prepare(over_blocks(stiffness_, part_, nothing,
                            [&](std::int64_t b) { return preconditioner_.descend(b, r_.data(), z_.data()); }),
                0.0F);
    }
    out.norm = unit * std::sqrt(over_blocks(stiffness_, part_, nothing,
                                            [&](std::int64_t b) { return dot_block(rows(r_, b), rows(r_, b)); }));
    while (out.norm > target && out.iterations < most && rz_ > 0.0) {
        check_interrupt();
        const double pq = over_blocks(
            stiffness_, part_, [&](std::int64_t part) { stiffness_.add_border(part, p_.data(), q_.data()); },
            [&](std::int64_t b) {
                stiffness_.add_block(b, p_.data(), q_.data());
                for (auto k = imposed_first_[static_cast<std::size_t>(b)];
                     k < imposed_first_[static_cast<std::size_t>(b) + 1]; ++k) {
                    const std::int64_t dof = imposed_[static_cast<std::size_t>(k)];
                    q_[static_cast<std::size_t>(floats * (dof / 6) + dof % 6)] = 0.0F;
                }
                return dot_block(rows(p_, b), rows(q_, b));
            });
        if (!(pq > 0.0)) {  // no stiffness along p: nothing more to gain
            std::fill(q_.begin(), q_.end(), 0.0F);
            break;
        }
        double rp = rz_;
        if (go_on && out.iterations == 0)
            rp = over_blocks(stiffness_, norm_, nothing,
                             [&](std::int64_t b) { return dot_block(rows(r_, b), rows(p_, b)); });
        const auto s = static_cast<float>(rp / pq);
        const double rz = over_blocks(stiffness_, part_, nothing, [&](std::int64_t b) {
            norm_[static_cast<std::size_t>(b)] = step_block(s, rows(q_, b), rows(r_, b));
            return preconditioner_.descend(b, r_.data(), z_.data());
        });
        double square = 0.0;
        for (const double n : norm_) square += n;
        out.norm = unit * std::sqrt(square);
        ++out.iterations;
        prepare(rz, s);
    }
    over_blocks(stiffness_, part_, nothing, [&](std::int64_t b) {
        give(b, d_, unit, d);
        return 0.0;
    });
    return out;
}

/// z = M r, scaled so that single precision suffices however small r is.
void InnerSolver::precondition(std::span<const double> r, std::span<double> z)
{
    const double largest = unit_of(r), unit = largest > 0.0 ? largest : 1.0;
    over_blocks(stiffness_, part_, nothing, [&](std::int64_t b) {
        take(b, r, unit);
        return preconditioner_.descend(b, r_.data(), z_.data());
    });
    preconditioner_.solve_coarse();
    over_blocks(stiffness_, part_, nothing, [&](std::int64_t b) {
        preconditioner_.ascend(b, z_.data(), 0.0F, d_.data(), 0.0F, p_.data());
        give(b, p_, unit, z);
        return 0.0;
    });
}

InnerSolver::Result InnerSolver::solve_in_double(const Stiffness& stiffness, std::span<const double> r_0, double target,
                                                 std::int64_t most, std::span<double> d)
{
    const double inv_radius = 1.0 / lattice_.mean_radius;
    std::vector<double> r(r_0.begin(), r_0.end()), z(r.size()), q(r.size());
    std::fill(d.begin(), d.end(), 0.0);
    std::fill(p_.begin(), p_.end(), 0.0F);  // 0 times what a stalled search left would be no number
    precondition(r, z);
    std::vector<double> p = z;
    double rz = dot(r, z);
    Result out{0, std::sqrt(weighted_square(r, inv_radius))};
    while (out.norm > target && out.iterations < most && rz > 0.0) {
        check_interrupt();
        stiffness.apply(p, q);
        for (const std::int64_t dof : imposed_) q[static_cast<std::size_t>(dof)] = 0.0;
        const double pq = dot(p, q);
        if (!(pq > 0.0)) break;  // no stiffness along p: nothing more to gain
        const double s = rz / pq;
        add_scaled(d, s, p), add_scaled(r, -s, q);
        out.norm = std::sqrt(weighted_square(r, inv_radius));
        ++out.iterations;
        precondition(r, z);
        // The preconditioner rounds: beta from what r has changed by keeps the directions apart.
        const double beta = -s * dot(z, q) / rz;
        rz = dot(r, z);
        for (std::size_t k = 0; k < p.size(); ++k) p[k] = z[k] + beta * p[k];
    }
    return out;
}

}  // namespace craze::mechanics
