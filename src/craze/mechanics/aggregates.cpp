#include "craze/mechanics/aggregates.hpp"

#include <algorithm>
#include <utility>

namespace craze::mechanics {

Graph graph_of(std::int64_t nodes, std::span<const std::int32_t> i, std::span<const std::int32_t> j)
{
    Graph out;
    out.first.assign(static_cast<std::size_t>(nodes) + 1, 0);
    for (std::size_t b = 0; b < i.size(); ++b)
        ++out.first[static_cast<std::size_t>(i[b]) + 1], ++out.first[static_cast<std::size_t>(j[b]) + 1];
    for (std::size_t e = 1; e < out.first.size(); ++e) out.first[e] += out.first[e - 1];
    out.other.resize(2 * i.size());
    std::vector<std::int32_t> fill(out.first.begin(), out.first.end() - 1);
    for (std::size_t b = 0; b < i.size(); ++b) {
        out.other[static_cast<std::size_t>(fill[static_cast<std::size_t>(i[b])]++)] = j[b];
        out.other[static_cast<std::size_t>(fill[static_cast<std::size_t>(j[b])]++)] = i[b];
    }
    return out;
}

std::vector<std::int32_t> grow_groups(const Graph& near, std::int64_t size, std::int64_t block,
                                      std::vector<std::int64_t>& members_of)
{
    const auto n = near.first.size() - 1;
    const auto neighbours = [&](std::int32_t e) {
        const auto k = static_cast<std::size_t>(e);
        return std::span<const std::int32_t>(near.other)
            .subspan(static_cast<std::size_t>(near.first[k]),
                     static_cast<std::size_t>(near.first[k + 1] - near.first[k]));
    };
    members_of.clear();
    std::vector<std::int32_t> group(n, -1), queue, others;
    for (std::int32_t seed = 0; seed < static_cast<std::int32_t>(n); ++seed) {
        if (group[static_cast<std::size_t>(seed)] >= 0 || neighbours(seed).empty()) continue;
        const auto g = static_cast<std::int32_t>(members_of.size());
        const auto at_home = [&](std::int32_t o) { return o / block == seed / block; };
        queue.assign(1, seed);
        group[static_cast<std::size_t>(seed)] = g;
        for (std::size_t head = 0; head < queue.size() && std::ssize(queue) < size; ++head)
            for (const std::int32_t o : neighbours(queue[head])) {
                if (group[static_cast<std::size_t>(o)] >= 0 || std::ssize(queue) >= size || !at_home(o)) continue;
                group[static_cast<std::size_t>(o)] = g;
                queue.push_back(o);
            }
        members_of.push_back(std::ssize(queue));
        if (std::ssize(queue) * 3 >= size) continue;
        // Too small: join the group it has most links to.
        others.clear();
        for (const std::int32_t e : queue)
            for (const std::int32_t o : neighbours(e))
                if (group[static_cast<std::size_t>(o)] >= 0 && group[static_cast<std::size_t>(o)] != g && at_home(o))
                    others.push_back(group[static_cast<std::size_t>(o)]);
        if (others.empty()) continue;
        std::sort(others.begin(), others.end());
        std::int32_t best = -1;
        std::ptrdiff_t most = 0;
        for (auto run = others.begin(); run != others.end();) {
            const auto end = std::upper_bound(run, others.end(), *run);
            if (end - run > most) most = end - run, best = *run;
            run = end;
        }
        for (const std::int32_t e : queue) group[static_cast<std::size_t>(e)] = best;
        members_of[static_cast<std::size_t>(best)] += std::ssize(queue);
        members_of.pop_back();
    }
    return group;
}

Aggregates aggregates_of(const Lattice& lattice, std::vector<std::int32_t> group, std::int64_t count)
{
    std::vector<std::int64_t> members_of(static_cast<std::size_t>(count), 0);
    for (const std::int32_t g : group)
        if (g >= 0) ++members_of[static_cast<std::size_t>(g)];
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

Aggregates grow_aggregates(const Lattice& lattice, const Beams& beams, std::int64_t size)
{
    const auto m = static_cast<std::size_t>(beams.count);
    const Graph near = graph_of(lattice.elements(), std::span(beams.i).first(m), std::span(beams.j).first(m));
    std::vector<std::int64_t> members_of;
    auto group = grow_groups(near, size, lattice.elements(), members_of);
    return aggregates_of(lattice, std::move(group), std::ssize(members_of));
}

}  // namespace craze::mechanics
