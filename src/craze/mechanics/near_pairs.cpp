#include "craze/mechanics/near_pairs.hpp"

#include "craze/core/parallel.hpp"
#include "craze/domain/cells.hpp"
#include "craze/mechanics/laws.hpp"

#include <algorithm>
#include <cmath>

namespace craze::mechanics {

namespace {

Pairs listed_pairs(const FreeContacts& free)
{
    Pairs out;
    for (std::size_t p = 0; p < free.i.size(); ++p) {
        const double d = free.distance[p];
        out.i.push_back(free.i[p]), out.j.push_back(free.j[p]);
        out.dx.push_back(d * free.tx[p]), out.dy.push_back(d * free.ty[p]), out.dz.push_back(d * free.tz[p]);
        out.distance.push_back(d), out.limit.push_back(d - free.gap[p]);
        out.cut.push_back(free.cut[p]);
    }
    return out;
}

/// Centres now, from the lowest corner of them all.
struct Places {
    std::vector<double> x, y, z;
    Vec3 span;
};
Places places(const Lattice& lattice, std::span<const double> pose)
{
    Places out{lattice.x, lattice.y, lattice.z, {}};
    for (std::size_t c = 0; c < 3; ++c) {
        auto& at = c == 0 ? out.x : c == 1 ? out.y : out.z;
        for (std::size_t e = 0; e < at.size(); ++e) at[e] += pose[8 * e + c];
        const auto [low, high] = std::minmax_element(at.begin(), at.end());
        const double origin = *low;
        out.span[static_cast<int>(c)] = *high - origin;
        for (double& a : at) a -= origin;
    }
    return out;
}

/// What a search compares, in the order in which elements lie in the cells.
struct Member {
    double x, y, z, r;
    std::int32_t e;
};

/// Near pairs (e, o) of one element, to the end of `to`. Near pairs of the lattice know the crack between them.
/// @param listed  of the lattice's pairs, the first of e or beyond; ends behind the last of e
void add_pairs_of(const Lattice& lattice, std::int32_t e, std::span<const std::int32_t> others, double reach,
                  std::size_t& listed, Pairs& to)
{
    const FreeContacts& free = lattice.free;
    const auto size = free.i.size();
    while (listed < size && free.i[listed] < e) ++listed;
    for (const std::int32_t o : others) {
        while (listed < size && free.i[listed] == e && free.j[listed] < o) ++listed;
        const bool known = listed < size && free.i[listed] == e && free.j[listed] == o;
        const Vec3 d = lattice.centre(o) - lattice.centre(e);
        const double d_0 = norm(d), r_e = lattice.r[static_cast<std::size_t>(e)],
                     r_o = lattice.r[static_cast<std::size_t>(o)];
        if (!known && d_0 < r_e + r_o + reach) continue;
        to.i.push_back(e), to.j.push_back(o);
        to.dx.push_back(d.x), to.dy.push_back(d.y), to.dz.push_back(d.z);
        to.distance.push_back(d_0);
        to.limit.push_back(known ? d_0 - free.gap[listed] : contact_distance(r_e, r_o, d_0, 0.0));
        to.cut.push_back(known ? free.cut[listed] : 1);
    }
}

}  // namespace

void Pairs::add(const Pairs& from, std::size_t p)
{
    i.push_back(from.i[p]), j.push_back(from.j[p]);
    dx.push_back(from.dx[p]), dy.push_back(from.dy[p]), dz.push_back(from.dz[p]);
    distance.push_back(from.distance[p]), limit.push_back(from.limit[p]);
    cut.push_back(from.cut[p]);
}

void Pairs::append(const Pairs& from)
{
    const auto put = [](auto& to, const auto& more) { to.insert(to.end(), more.begin(), more.end()); };
    put(i, from.i), put(j, from.j);
    put(dx, from.dx), put(dy, from.dy), put(dz, from.dz);
    put(distance, from.distance), put(limit, from.limit);
    put(cut, from.cut);
}

Pairs merged(const Pairs& a, const Pairs& b)
{
    Pairs out;
    std::size_t p = 0, q = 0;
    while (p < a.i.size() || q < b.i.size())
        if (q == b.i.size() || (p < a.i.size() && a.before(p, b, q)))
            out.add(a, p++);
        else
            out.add(b, q++);
    return out;
}

Pairs near_pairs(const Lattice& lattice, Geometry geometry, std::span<const double> pose, double reach)
{
    if (geometry == Geometry::small_displacement) return listed_pairs(lattice.free);
    const Places now = places(lattice, pose);
    const double edge = 2.0 * *std::max_element(lattice.r.begin(), lattice.r.end()) + reach;
    const domain::Cells cells(now.span + Vec3{edge, edge, edge}, edge, now.x, now.y, now.z);
    std::vector<Member> members(now.x.size());
    for (std::size_t s = 0; s < members.size(); ++s) {
        const std::int32_t e = cells.members()[s];
        const auto k = static_cast<std::size_t>(e);
        members[s] = {now.x[k], now.y[k], now.z[k], lattice.r[k], e};
    }

    constexpr std::int32_t block = 1024;
    const std::int32_t n = lattice.elements(), blocks = (n + block - 1) / block;
    std::vector<Pairs> found(static_cast<std::size_t>(blocks));
    parallel_tasks(blocks, [&](std::int64_t b) {
        const auto begin = static_cast<std::int32_t>(b) * block, end = std::min(n, begin + block);
        const auto [nx, ny, nz] = cells.count();
        auto listed = static_cast<std::size_t>(std::lower_bound(lattice.free.i.begin(), lattice.free.i.end(), begin) -
                                               lattice.free.i.begin());
        std::vector<std::int32_t> others;
        for (std::int32_t e = begin; e < end; ++e) {
            const auto k = static_cast<std::size_t>(e);
            const double x = now.x[k], y = now.y[k], z = now.z[k], r = lattice.r[k] + reach;
            const std::int32_t cx = cells.along(0, x), cy = cells.along(1, y), cz = cells.along(2, z);
            others.clear();
            for (std::int32_t rz = std::max(cz - 1, 0); rz <= std::min(cz + 1, nz - 1); ++rz)
                for (std::int32_t ry = std::max(cy - 1, 0); ry <= std::min(cy + 1, ny - 1); ++ry) {
                    const auto row = cells.row(std::max(cx - 1, 0), std::min(cx + 2, nx), ry, rz);
                    const Member* member = members.data() + (row.data() - cells.members().data());
                    for (const Member* const last = member + row.size(); member != last; ++member) {
                        const double dx = member->x - x, dy = member->y - y, dz = member->z - z, touch = member->r + r;
                        if (dx * dx + dy * dy + dz * dz < touch * touch && member->e > e) others.push_back(member->e);
                    }
                }
            std::sort(others.begin(), others.end());
            // Both lists ascend: what is bonded drops out.
            auto bonded = lattice.j.begin() + lattice.first[k];
            const auto bonded_end = lattice.j.begin() + lattice.first[k + 1];
            std::erase_if(others, [&](std::int32_t o) {
                while (bonded != bonded_end && *bonded < o) ++bonded;
                return bonded != bonded_end && *bonded == o;
            });
            add_pairs_of(lattice, e, others, reach, listed, found[static_cast<std::size_t>(b)]);
        }
    });
    Pairs out;
    for (const Pairs& part : found) out.append(part);
    return out;
}

}  // namespace craze::mechanics
