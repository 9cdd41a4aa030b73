#include "craze/mechanics/neighbours.hpp"

#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace craze::mechanics {

namespace {

/// Direction i -> j and distance of a pair now.
struct Apart {
    double t[3], d;
};

CRAZE_INLINE Apart apart(const Pairs& pairs, std::size_t p, Geometry geometry, const double* pose)
{
    const double *a = pose + 8 * static_cast<std::int64_t>(pairs.i[p]),
                 *b = pose + 8 * static_cast<std::int64_t>(pairs.j[p]);
    const double du[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, rest[3] = {pairs.dx[p], pairs.dy[p], pairs.dz[p]};
    Apart out;
    if (geometry == Geometry::small_displacement) {
        const double inv = 1.0 / pairs.distance[p];
        out.d = pairs.distance[p];
        for (int c = 0; c < 3; ++c) out.t[c] = rest[c] * inv, out.d += out.t[c] * du[c];
        return out;
    }
    double square = 0.0;
    for (int c = 0; c < 3; ++c) out.t[c] = rest[c] + du[c], square += out.t[c] * out.t[c];
    out.d = std::sqrt(square);
    for (double& t : out.t) t /= out.d;
    return out;
}

bool by_ends(const PressedPair& a, const PressedPair& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; }

}  // namespace

Neighbours::Neighbours(const Lattice& lattice, Geometry geometry, std::vector<PressedPair> pressed)
    : lattice_(lattice),
      holding_(lattice),
      geometry_(geometry),
      reach_(0.3 * lattice.mean_radius),
      skin_(0.03 * lattice.mean_radius),
      pressed_(std::move(pressed))
{
}

bool Neighbours::follow(std::span<const double> pose, std::span<const domain::BondKind> kind, double moved)
{
    until_search_ -= moved, until_choice_ -= moved;
    if (until_search_ >= 0.0 && until_choice_ >= 0.0) return false;
    if (until_search_ < 0.0) {
        near_ = near_pairs(lattice_, geometry_, pose, reach_);
        lower_limits();
        list_parted(kind);
        until_search_ = reach_;
    }
    skin_ = std::clamp(20.0 * moved, 0.03 * lattice_.mean_radius, reach_);
    choose(pose);
    until_choice_ = skin_;
    return true;
}

bool Neighbours::part(std::span<const double> pose, std::span<const domain::BondKind> kind,
                      std::span<const std::int32_t> ends)
{
    std::vector<std::int32_t> fresh;
    for (const std::int32_t e : ends)
        for (auto at = first_near_[static_cast<std::size_t>(e)]; at < first_near_[static_cast<std::size_t>(e) + 1];
             ++at) {
            const std::int32_t k = near_of_[static_cast<std::size_t>(at)];
            const auto p = static_cast<std::size_t>(k);
            if (parted_[p] != 0 || !holding_.parted(near_.i[p], near_.j[p], near_.cut[p] != 0, kind)) continue;
            parted_[p] = 1;
            fresh.push_back(k);
        }
    if (fresh.empty()) return false;
    std::sort(fresh.begin(), fresh.end());
    const auto middle = loose_.insert(loose_.end(), fresh.begin(), fresh.end());
    std::inplace_merge(loose_.begin(), middle, loose_.end());

    Pairs touching;
    bool pressed = false;
    for (const std::int32_t k : fresh) {
        const auto p = static_cast<std::size_t>(k);
        const double distance = apart(near_, p, geometry_, pose.data()).d;
        if (distance < near_.limit[p]) {
            near_.limit[p] = distance;
            pressed_.push_back({near_.i[p], near_.j[p], distance});
            pressed = true;
        }
        if (distance < near_.limit[p] + skin_) touching.add(near_, p);
    }
    if (pressed) std::sort(pressed_.begin(), pressed_.end(), by_ends);
    if (touching.i.empty()) return false;
    active_ = merged(active_, touching);
    return true;
}

/// Contact distances of near pairs that were pressed together when they parted.
void Neighbours::lower_limits()
{
    std::size_t p = 0;
    for (const PressedPair& pair : pressed_) {
        while (p < near_.i.size() && (near_.i[p] < pair.i || (near_.i[p] == pair.i && near_.j[p] < pair.j))) ++p;
        if (p < near_.i.size() && near_.i[p] == pair.i && near_.j[p] == pair.j) near_.limit[p] = pair.limit;
    }
}

/// Which near pairs have parted, and the near pairs of each element.
void Neighbours::list_parted(std::span<const domain::BondKind> kind)
{
    parted_.assign(near_.i.size(), 0);
    parallel_ranges(near_.size(), [&](std::int64_t begin, std::int64_t end) {
        for (auto p = static_cast<std::size_t>(begin); p < static_cast<std::size_t>(end); ++p)
            parted_[p] = holding_.parted(near_.i[p], near_.j[p], near_.cut[p] != 0, kind) ? 1 : 0;
    });
    loose_.clear();
    first_near_.assign(lattice_.r.size() + 1, 0);
    for (std::size_t p = 0; p < parted_.size(); ++p) {
        ++first_near_[static_cast<std::size_t>(near_.i[p]) + 1],
            ++first_near_[static_cast<std::size_t>(near_.j[p]) + 1];
        if (parted_[p] != 0) loose_.push_back(static_cast<std::int32_t>(p));
    }
    for (std::size_t e = 1; e < first_near_.size(); ++e) first_near_[e] += first_near_[e - 1];
    std::vector<std::int32_t> fill(first_near_.begin(), first_near_.end() - 1);
    near_of_.resize(2 * near_.i.size());
    for (std::size_t p = 0; p < parted_.size(); ++p)
        for (const std::int32_t e : {near_.i[p], near_.j[p]})
            near_of_[static_cast<std::size_t>(fill[static_cast<std::size_t>(e)]++)] = static_cast<std::int32_t>(p);
}

/// The pairs that have parted and whose gap is less than the skin.
void Neighbours::choose(std::span<const double> pose)
{
    std::vector<std::uint8_t> close(loose_.size(), 0);
    parallel_ranges(std::ssize(loose_), [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
            const auto p = static_cast<std::size_t>(loose_[k]);
            close[k] = apart(near_, p, geometry_, pose.data()).d < near_.limit[p] + skin_ ? 1 : 0;
        }
    });
    active_ = {};
    for (std::size_t k = 0; k < loose_.size(); ++k)
        if (close[k] != 0) active_.add(near_, static_cast<std::size_t>(loose_[k]));
}

double add_pairs(const Pairs& pairs, std::int64_t begin, std::int64_t end, double stiffness, Geometry geometry,
                 std::int64_t limit, const double* pose, double* force)
{
    double energy = 0.0;
    for (std::int64_t k = begin; k < end; ++k) {
        const auto p = static_cast<std::size_t>(k);
        const Apart now = apart(pairs, p, geometry, pose);
        const double gap = now.d - pairs.limit[p];
        if (!(gap < 0.0)) continue;
        const double N = unilateral_force(stiffness, gap);
        energy += 0.5 * N * gap;
        double *f = force + 8 * static_cast<std::int64_t>(pairs.i[p]),
               *g = force + 8 * static_cast<std::int64_t>(pairs.j[p]);
        for (int c = 0; c < 3; ++c) f[c] += N * now.t[c];
        if (pairs.j[p] < limit)
            for (int c = 0; c < 3; ++c) g[c] -= N * now.t[c];
    }
    return energy;
}

void add_border_pairs(const Pairs& pairs, std::span<const std::int32_t> list, double stiffness, Geometry geometry,
                      const double* pose, double* force)
{
    for (const std::int32_t k : list) {
        const auto p = static_cast<std::size_t>(k);
        const Apart now = apart(pairs, p, geometry, pose);
        const double gap = now.d - pairs.limit[p];
        if (!(gap < 0.0)) continue;
        const double N = unilateral_force(stiffness, gap);
        double* g = force + 8 * static_cast<std::int64_t>(pairs.j[p]);
        for (int c = 0; c < 3; ++c) g[c] -= N * now.t[c];
    }
}

}  // namespace craze::mechanics
