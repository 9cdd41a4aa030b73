#include "craze/mechanics/coarse_space.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/block_cholesky.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>

namespace craze::mechanics {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = BlockCholesky::Block;

/// One way a bond deforms: stiffness * (g . dofs)^2 / 2, gradients with respect to displacement and rotation of each
/// end.
struct Deformation {
    double stiffness;
    std::array<Vec3, 2> along, about;
};

/// The six of a beam: stretch, twist, and symmetric and antisymmetric bending in two planes.
std::array<Deformation, 6> deformations(const BeamSection& s, const Vec3& t, double inv_L)
{
    const Vec3 side = std::abs(t.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 n = normalized(cross(t, side)), m = cross(t, n), none{};
    std::array<Deformation, 6> out{Deformation{s.EA * inv_L, {-t, t}, {none, none}},
                                   Deformation{s.GJ * inv_L, {none, none}, {-t, t}}};
    std::size_t k = 2;
    for (const Vec3& axis : {n, m}) {
        const Vec3 shear = cross(axis, t) * (2.0 * inv_L);
        out[k++] = {3.0 * s.EI * inv_L, {shear, -shear}, {axis, axis}};
        out[k++] = {s.EI * inv_L, {none, none}, {-axis, axis}};
    }
    return out;
}

using BlockEntry = BlockCholesky::Entry;

}  // namespace

struct CoarseSpace::Work {
    Aggregates groups;
    std::vector<Vec3> arm;                           ///< from the centre of its aggregate to each element, over `unit`
    std::vector<std::uint8_t> held;                  ///< bit c: number c of the element is imposed
    std::vector<std::vector<BlockEntry>> beam_rows;  ///< block rows of the groups, what beams bring
    double unit = 1.0, scale = 1.0;                  ///< length that makes rotations displacements, m; EA / unit, N/m
    BlockCholesky factor;
    bool solves = false;  ///< there is something to solve

    Vector6 project(std::int32_t e, Vec3 along, Vec3 about) const;
    template <class Visit>
    void visit_groups(std::int32_t i, std::int32_t j, Visit&& visit) const;
    void add_bond(std::vector<BlockEntry>& row, std::int32_t group, std::int32_t i, std::int32_t j,
                  const Deformation& d) const;
};

/// P^T of a force and a moment on one element.
Vector6 CoarseSpace::Work::project(std::int32_t e, Vec3 along, Vec3 about) const
{
    const auto k = static_cast<std::size_t>(e);
    for (int c = 0; c < 3; ++c) {
        if (held[k] >> c & 1) along[c] = 0.0;
        if (held[k] >> (3 + c) & 1) about[c] = 0.0;
    }
    const Vec3 moment = cross(arm[k], along) + about / unit;
    return Vector6{along.x, along.y, along.z, moment.x, moment.y, moment.z};
}

/// Groups that feel a bond: not one that both ends move with, unless an end is held.
template <class Visit>
void CoarseSpace::Work::visit_groups(std::int32_t i, std::int32_t j, Visit&& visit) const
{
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const std::int32_t g_i = groups.of[a], g_j = groups.of[b];
    if (g_i == g_j && !held[a] && !held[b]) return;
    if (g_i >= 0) visit(static_cast<std::size_t>(g_i));
    if (g_j >= 0 && g_j != g_i) visit(static_cast<std::size_t>(g_j));
}

/// Block row of one aggregate: what the bond brings to it.
void CoarseSpace::Work::add_bond(std::vector<BlockEntry>& row, std::int32_t group, std::int32_t i, std::int32_t j,
                                 const Deformation& d) const
{
    const std::int32_t ends[2] = {i, j};
    const std::int32_t home[2] = {groups.of[static_cast<std::size_t>(i)], groups.of[static_cast<std::size_t>(j)]};
    Vector6 g[2];
    for (std::size_t k = 0; k < 2; ++k)
        g[k] = home[k] >= 0 ? project(ends[k], d.along[k], d.about[k]) : Vector6::Zero();
    const auto block = [&](std::int32_t column) -> Matrix6& {
        for (BlockEntry& entry : row)
            if (entry.column == column) return entry.block;
        row.push_back({column, Matrix6::Zero()});
        return row.back().block;
    };
    for (int k = 0; k < 2; ++k) {
        if (home[k] != group) continue;
        for (int o = 0; o < 2; ++o)
            if (home[o] >= 0 && home[o] <= group) block(home[o]).noalias() += (d.stiffness * g[k]) * g[o].transpose();
    }
}

CoarseSpace::CoarseSpace() : work_(std::make_unique<Work>()) {}
CoarseSpace::~CoarseSpace() = default;
CoarseSpace::CoarseSpace(CoarseSpace&&) noexcept = default;
CoarseSpace& CoarseSpace::operator=(CoarseSpace&&) noexcept = default;
std::int32_t CoarseSpace::aggregates() const { return work_->groups.count(); }

void CoarseSpace::set_up(const Lattice& lattice, const Stiffness& stiffness, std::span<const std::int64_t> imposed,
                         Aggregates aggregates)
{
    Work& w = *work_;
    const auto n = lattice.r.size();
    w.groups = std::move(aggregates);
    w.unit = lattice.mean_radius;
    w.scale = stiffness.section().EA / w.unit;
    w.held.assign(n, 0);
    for (const std::int64_t dof : imposed)
        w.held[static_cast<std::size_t>(dof / 6)] |= static_cast<std::uint8_t>(1U << (dof % 6));
    w.arm.assign(n, {});
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const std::int32_t g = w.groups.of[static_cast<std::size_t>(e)];
        if (g >= 0)
            w.arm[static_cast<std::size_t>(e)] =
                (lattice.centre(e) - w.groups.centre[static_cast<std::size_t>(g)]) / w.unit;
    }

    const Beams& beams = stiffness.beams();
    const std::int32_t groups = w.groups.count();
    std::vector<std::vector<std::size_t>> of_group(static_cast<std::size_t>(groups));
    for (std::size_t b = 0; b < static_cast<std::size_t>(beams.count); ++b)
        w.visit_groups(beams.i[b], beams.j[b], [&](std::size_t g) { of_group[g].push_back(b); });
    w.beam_rows.assign(static_cast<std::size_t>(groups), {});
    parallel_tasks(groups, [&](std::int64_t g) {
        auto& row = w.beam_rows[static_cast<std::size_t>(g)];
        row.push_back({static_cast<std::int32_t>(g), Matrix6::Zero()});
        for (const std::size_t b : of_group[static_cast<std::size_t>(g)])
            for (const Deformation& d :
                 deformations(stiffness.section(), {beams.tx[b], beams.ty[b], beams.tz[b]}, beams.inv_length[b]))
                w.add_bond(row, static_cast<std::int32_t>(g), beams.i[b], beams.j[b], d);
    });
    update(stiffness);
}

void CoarseSpace::update(const Stiffness& stiffness)
{
    Work& w = *work_;
    const std::int32_t groups = w.groups.count();
    auto rows = w.beam_rows;
    const Springs& springs = stiffness.springs();
    for (std::size_t b = 0; b < springs.i.size(); ++b) {
        const Vec3 t{springs.tx[b], springs.ty[b], springs.tz[b]};
        w.visit_groups(springs.i[b], springs.j[b], [&](std::size_t g) {
            w.add_bond(rows[g], static_cast<std::int32_t>(g), springs.i[b], springs.j[b],
                       {springs.k[b], {-t, t}, {Vec3{}, Vec3{}}});
        });
    }

    double trace = 0.0;
    for (auto& row : rows) {
        for (auto& entry : row) entry.block *= 1.0 / w.scale;
        trace += row[0].block.trace();
    }
    // Floating fragments have nothing of their own.
    const double shift = groups > 0 ? 1e-7 * trace / (6.0 * groups) : 0.0;
    for (auto& row : rows) row[0].block.diagonal().array() += shift;
    w.solves = trace > 0.0 && w.factor.factorise(rows);
}

void CoarseSpace::solve(std::span<float> load) const
{
    if (work_->solves)
        work_->factor.solve(load.data());
    else
        std::fill(load.begin(), load.end(), 0.0F);
}

}  // namespace craze::mechanics
