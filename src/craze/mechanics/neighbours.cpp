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

void Pairs::add(const Pairs& from, std::size_t p)
{
    i.push_back(from.i[p]), j.push_back(from.j[p]);
    dx.push_back(from.dx[p]), dy.push_back(from.dy[p]), dz.push_back(from.dz[p]);
    distance.push_back(from.distance[p]), limit.push_back(from.limit[p]);
    cut.push_back(from.cut[p]);
}

/// Two sorted lists in one.
static Pairs merged(const Pairs& a, const Pairs& b)
{
    Pairs out;
    std::size_t p = 0, q = 0;
    while (p < a.i.size() || q < b.i.size()) {
        const bool first =
            q == b.i.size() || (p < a.i.size() && (a.i[p] < b.i[q] || (a.i[p] == b.i[q] && a.j[p] < b.j[q])));
        first ? out.add(a, p++) : out.add(b, q++);
    }
    return out;
}

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
        search(pose);
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

/// All unbonded pairs nearer than reach, by cells of the current centres.
void Neighbours::search(std::span<const double> pose)
{
    near_ = {};
    ++searches_;
    const FreeContacts& free = lattice_.free;
    if (geometry_ == Geometry::small_displacement) {
        for (std::size_t p = 0; p < free.i.size(); ++p) {
            const double d = free.distance[p];
            near_.i.push_back(free.i[p]), near_.j.push_back(free.j[p]);
            near_.dx.push_back(d * free.tx[p]), near_.dy.push_back(d * free.ty[p]), near_.dz.push_back(d * free.tz[p]);
            near_.distance.push_back(d), near_.limit.push_back(d - free.gap[p]);
            near_.cut.push_back(free.cut[p]);
        }
        return;
    }
    const std::int32_t n = lattice_.elements();
    const auto at = [&](std::int32_t e) {
        const double* u = pose.data() + 8 * static_cast<std::int64_t>(e);
        return lattice_.centre(e) + Vec3{u[0], u[1], u[2]};
    };
    Vec3 low = at(0), high = low;
    double largest = 0.0;
    for (std::int32_t e = 0; e < n; ++e) {
        const Vec3 p = at(e);
        for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
        largest = std::max(largest, lattice_.r[static_cast<std::size_t>(e)]);
    }
    // Fragments may fly far: let cells grow rather than their number.
    double cell = 2.0 * largest + reach_;
    const Vec3 span = high - low;
    while ((span.x / cell + 1) * (span.y / cell + 1) * (span.z / cell + 1) > 4.0 * n + 64.0) cell *= 1.25;
    const auto count = [&](int c) { return static_cast<std::int64_t>(span[c] / cell) + 1; };
    const std::int64_t nx = count(0), ny = count(1), nz = count(2);
    const auto along = [&](const Vec3& p, int c) { return static_cast<std::int64_t>((p[c] - low[c]) / cell); };
    std::vector<std::int32_t> first(static_cast<std::size_t>(nx * ny * nz) + 1, 0), home(static_cast<std::size_t>(n)),
        sorted(home.size());
    for (std::int32_t e = 0; e < n; ++e) {
        const Vec3 p = at(e);
        const auto c = along(p, 0) + nx * (along(p, 1) + ny * along(p, 2));
        home[static_cast<std::size_t>(e)] = static_cast<std::int32_t>(c);
        ++first[static_cast<std::size_t>(c) + 1];
    }
    for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
    std::vector<std::int32_t> fill(first.begin(), first.end() - 1);
    for (std::int32_t e = 0; e < n; ++e)
        sorted[static_cast<std::size_t>(fill[static_cast<std::size_t>(home[static_cast<std::size_t>(e)])]++)] = e;

    constexpr std::int32_t block = 1024;
    const std::int64_t blocks = (n + block - 1) / block;
    std::vector<Pairs> found(static_cast<std::size_t>(blocks));
    parallel_tasks(blocks, [&](std::int64_t b) {
        Pairs& mine = found[static_cast<std::size_t>(b)];
        std::vector<std::int32_t> others;
        for (auto e = static_cast<std::int32_t>(b * block); e < std::min<std::int64_t>(n, (b + 1) * block); ++e) {
            const auto k = static_cast<std::size_t>(e);
            const Vec3 p = at(e);
            others.clear();
            const auto bonded_begin = lattice_.j.begin() + lattice_.first[k],
                       bonded_end = lattice_.j.begin() + lattice_.first[k + 1];
            const std::int64_t c = home[k], cx = c % nx, cy = c / nx % ny, cz = c / (nx * ny);
            for (std::int64_t z = std::max<std::int64_t>(cz - 1, 0); z <= std::min(cz + 1, nz - 1); ++z)
                for (std::int64_t y = std::max<std::int64_t>(cy - 1, 0); y <= std::min(cy + 1, ny - 1); ++y)
                    for (std::int64_t x = std::max<std::int64_t>(cx - 1, 0); x <= std::min(cx + 1, nx - 1); ++x) {
                        const auto at_cell = static_cast<std::size_t>(x + nx * (y + ny * z));
                        for (auto s = first[at_cell]; s < first[at_cell + 1]; ++s) {
                            const std::int32_t o = sorted[static_cast<std::size_t>(s)];
                            const double touch = lattice_.r[k] + lattice_.r[static_cast<std::size_t>(o)] + reach_;
                            const Vec3 d = at(o) - p;
                            if (o > e && dot(d, d) < touch * touch && !std::binary_search(bonded_begin, bonded_end, o))
                                others.push_back(o);
                        }
                    }
            std::sort(others.begin(), others.end());
            for (const std::int32_t o : others) {
                const Vec3 d = lattice_.centre(o) - lattice_.centre(e);
                const double d_0 = norm(d);
                // Near pairs of the lattice know the crack between them.
                const auto listed = std::lower_bound(free.i.begin(), free.i.end(), e) - free.i.begin();
                const auto listed_end = std::upper_bound(free.i.begin(), free.i.end(), e) - free.i.begin();
                const auto hit = std::lower_bound(free.j.begin() + listed, free.j.begin() + listed_end, o);
                const bool known = hit != free.j.begin() + listed_end && *hit == o;
                // Near at rest and not listed: whoever made the domain has left their contact out.
                if (!known && d_0 < lattice_.r[k] + lattice_.r[static_cast<std::size_t>(o)] + reach_) continue;
                const double limit =
                    known ? d_0 - free.gap[static_cast<std::size_t>(hit - free.j.begin())]
                          : contact_distance(lattice_.r[k], lattice_.r[static_cast<std::size_t>(o)], d_0, 0.0);
                mine.i.push_back(e), mine.j.push_back(o);
                mine.dx.push_back(d.x), mine.dy.push_back(d.y), mine.dz.push_back(d.z);
                mine.distance.push_back(d_0), mine.limit.push_back(limit);
                mine.cut.push_back(known ? free.cut[static_cast<std::size_t>(hit - free.j.begin())] : 1);
            }
        }
    });
    for (const Pairs& part : found)
        for (std::size_t p = 0; p < part.i.size(); ++p) near_.add(part, p);
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
        double *f = force + 6 * static_cast<std::int64_t>(pairs.i[p]),
               *g = force + 6 * static_cast<std::int64_t>(pairs.j[p]);
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
        double* g = force + 6 * static_cast<std::int64_t>(pairs.j[p]);
        for (int c = 0; c < 3; ++c) g[c] -= N * now.t[c];
    }
}

}  // namespace craze::mechanics
