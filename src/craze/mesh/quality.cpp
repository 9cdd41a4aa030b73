#include "craze/mesh/quality.hpp"

#include "craze/core/parallel.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

namespace craze::mesh {

namespace {

using Pair = std::pair<std::int32_t, std::int32_t>;

// Groups of a vertex's opposite edges that hang together by their ends.
int groups(const std::vector<Pair>& opposite, std::vector<std::int32_t>& ends, std::vector<int>& root)
{
    ends.clear();
    for (const auto& [a, b] : opposite) ends.push_back(a), ends.push_back(b);
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    root.resize(ends.size());
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = static_cast<int>(i);
    const auto find = [&](std::int32_t v) {
        auto i = static_cast<int>(std::ranges::lower_bound(ends, v) - ends.begin());
        while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
        return i;
    };
    int count = static_cast<int>(ends.size());
    for (const auto& [a, b] : opposite) {
        const int i = find(a), j = find(b);
        if (i != j) root[static_cast<std::size_t>(std::max(i, j))] = std::min(i, j), --count;
    }
    return count;
}

MeshQuality sum(MeshQuality a, const MeshQuality& b)
{
    a.duplicate_triangles += b.duplicate_triangles;
    a.unused_vertices += b.unused_vertices;
    a.edges += b.edges;
    a.rim_edges += b.rim_edges;
    a.branching_edges += b.branching_edges;
    a.branching_vertices += b.branching_vertices;
    return a;
}

MeshQuality around_vertices(const CrackSurface& surface, const Incidence& incidence, std::int64_t begin,
                            std::int64_t end)
{
    MeshQuality q;
    std::vector<Pair> opposite;
    std::vector<std::int32_t> neighbours, ends;
    std::vector<int> root;
    for (std::int64_t i = begin; i < end; ++i) {
        const auto v = static_cast<std::int32_t>(i);
        const auto around = incidence.at(static_cast<std::size_t>(i));
        if (around.empty()) {
            ++q.unused_vertices;
            continue;
        }
        opposite.clear();
        neighbours.clear();
        for (const std::int32_t t : around) {
            const auto& k = surface.triangles[static_cast<std::size_t>(t)];
            const std::size_t at = k[0] == v ? 0 : k[1] == v ? 1 : 2;
            const Pair edge = std::minmax(k[(at + 1) % 3], k[(at + 2) % 3]);
            opposite.push_back(edge);
            neighbours.push_back(edge.first), neighbours.push_back(edge.second);
        }
        std::ranges::sort(opposite);
        std::ranges::sort(neighbours);
        for (std::size_t k = 1; k < opposite.size(); ++k)  // counted at its first corner only
            q.duplicate_triangles += opposite[k] == opposite[k - 1] && v < opposite[k].first;
        bool branching = false;
        int rims = 0;
        for (auto from = neighbours.begin(); from != neighbours.end();) {
            const auto to = std::upper_bound(from, neighbours.end(), *from);
            const auto uses = to - from;
            branching |= uses > 2;
            rims += uses == 1;
            if (*from > v) {
                ++q.edges;
                q.rim_edges += uses == 1;
                q.branching_edges += uses > 2;
            }
            from = to;
        }
        if (!branching) branching = rims > 2 || groups(opposite, ends, root) > 1;
        q.branching_vertices += branching;
    }
    return q;
}

}  // namespace

MeshQuality quality(const CrackSurface& surface, const Incidence& incidence)
{
    MeshQuality total;
    std::mutex guard;
    parallel_ranges(static_cast<std::int64_t>(surface.vertices.size()), [&](std::int64_t begin, std::int64_t end) {
        const MeshQuality part = around_vertices(surface, incidence, begin, end);
        const std::lock_guard lock(guard);
        total = sum(total, part);
    });
    for (const auto& t : surface.triangles) {
        const auto corner = [&](std::size_t k) { return surface.vertices[static_cast<std::size_t>(t[k])]; };
        total.degenerate_triangles += !(norm(cross(corner(1) - corner(0), corner(2) - corner(0))) > 0.0);
    }
    total.euler_number = static_cast<std::int64_t>(surface.vertices.size()) - total.unused_vertices - total.edges +
                         static_cast<std::int64_t>(surface.triangles.size());
    return total;
}

}  // namespace craze::mesh
