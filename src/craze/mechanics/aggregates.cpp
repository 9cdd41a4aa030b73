#include "craze/mechanics/coarse_space.hpp"

#include <algorithm>

namespace craze::mechanics {

namespace {

/// Elements beamed to each element, compressed rows.
struct Adjacency {
    std::vector<std::int32_t> first, other;
};
Adjacency adjacency(std::size_t n, const Beams& beams)
{
    Adjacency out;
    out.first.assign(n + 1, 0);
    const auto m = static_cast<std::size_t>(beams.count);
    for (std::size_t b = 0; b < m; ++b)
        ++out.first[static_cast<std::size_t>(beams.i[b]) + 1], ++out.first[static_cast<std::size_t>(beams.j[b]) + 1];
    for (std::size_t e = 1; e <= n; ++e) out.first[e] += out.first[e - 1];
    out.other.resize(2 * m);
    std::vector<std::int32_t> fill(out.first.begin(), out.first.end() - 1);
    for (std::size_t b = 0; b < m; ++b) {
        out.other[static_cast<std::size_t>(fill[static_cast<std::size_t>(beams.i[b])]++)] = beams.j[b];
        out.other[static_cast<std::size_t>(fill[static_cast<std::size_t>(beams.j[b])]++)] = beams.i[b];
    }
    return out;
}

}  // namespace

Aggregates grow_aggregates(const Lattice& lattice, const Beams& beams, std::int64_t size)
{
    const auto n = lattice.r.size();
    const Adjacency near = adjacency(n, beams);
    const auto neighbours = [&](std::int32_t e) {
        const auto k = static_cast<std::size_t>(e);
        return std::span<const std::int32_t>(near.other)
            .subspan(static_cast<std::size_t>(near.first[k]),
                     static_cast<std::size_t>(near.first[k + 1] - near.first[k]));
    };
    std::vector<std::int32_t> group(n, -1), queue, members;
    std::vector<std::int64_t> members_of;
    for (std::int32_t seed = 0; seed < lattice.elements(); ++seed) {
        if (group[static_cast<std::size_t>(seed)] >= 0 || neighbours(seed).empty()) continue;
        const auto g = static_cast<std::int32_t>(members_of.size());
        queue.assign(1, seed);
        group[static_cast<std::size_t>(seed)] = g;
        for (std::size_t head = 0; head < queue.size() && std::ssize(queue) < size; ++head)
            for (const std::int32_t o : neighbours(queue[head])) {
                if (group[static_cast<std::size_t>(o)] >= 0 || std::ssize(queue) >= size) continue;
                group[static_cast<std::size_t>(o)] = g;
                queue.push_back(o);
            }
        members_of.push_back(std::ssize(queue));
        if (std::ssize(queue) * 3 >= size) continue;
        // Too small: join the group it has most beams to.
        members.clear();
        for (const std::int32_t e : queue)
            for (const std::int32_t o : neighbours(e))
                if (group[static_cast<std::size_t>(o)] != g) members.push_back(group[static_cast<std::size_t>(o)]);
        if (members.empty()) continue;
        std::sort(members.begin(), members.end());
        std::int32_t best = -1;
        std::ptrdiff_t most = 0;
        for (auto run = members.begin(); run != members.end();) {
            const auto end = std::upper_bound(run, members.end(), *run);
            if (end - run > most) most = end - run, best = *run;
            run = end;
        }
        for (const std::int32_t e : queue) group[static_cast<std::size_t>(e)] = best;
        members_of[static_cast<std::size_t>(best)] += std::ssize(queue);
        members_of.pop_back();
    }

    Aggregates out;
    out.of = std::move(group);
    out.first.assign(members_of.size() + 1, 0);
    out.centre.assign(members_of.size(), {});
    for (std::size_t g = 0; g < members_of.size(); ++g)
        out.first[g + 1] = out.first[g] + static_cast<std::int32_t>(members_of[g]);
    out.elements.resize(static_cast<std::size_t>(out.first.back()));
    std::vector<std::int32_t> fill(out.first.begin(), out.first.end() - 1);
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const std::int32_t g = out.of[static_cast<std::size_t>(e)];
        if (g < 0) continue;
        const auto k = static_cast<std::size_t>(g);
        out.elements[static_cast<std::size_t>(fill[k]++)] = e;
        out.centre[k] += lattice.centre(e) / static_cast<double>(members_of[k]);
    }
    return out;
}

}  // namespace craze::mechanics
