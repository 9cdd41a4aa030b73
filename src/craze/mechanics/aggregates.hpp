// Elements that move together: groups grown from beam to beam.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Nodes linked to each node, compressed rows: those of e are other[first[e]] to other[first[e + 1]].
struct Graph {
    std::vector<std::int32_t> first, other;
};
Graph graph_of(std::int64_t nodes, std::span<const std::int32_t> i, std::span<const std::int32_t> j);

/// Group of each node, -1 for nodes without links. Groups of about `size` grow from link to link within blocks of
/// `block` consecutive nodes and are numbered in the order of their first seed; those that stay much smaller join a
/// neighbour if they have one.
/// @param members_of  out: nodes of each group
std::vector<std::int32_t> grow_groups(const Graph& graph, std::int64_t size, std::int64_t block,
                                      std::vector<std::int64_t>& members_of);

/// Elements grouped through intact beams. Elements without beams belong to none.
struct Aggregates {
    std::vector<std::int32_t> of;        ///< aggregate of each element, -1 for none, shape (n,)
    std::vector<std::int32_t> elements;  ///< grouped, ascending within each group
    std::vector<std::int32_t> first;     ///< elements of group a are [first[a], first[a + 1])
    std::vector<Vec3> centre;            ///< m

    std::int32_t count() const { return static_cast<std::int32_t>(centre.size()); }
};
/// Grows groups of about `size` elements from beam to beam; pieces that stay much smaller join a neighbour if they have
/// one.
Aggregates grow_aggregates(const Lattice& lattice, const Beams& beams, std::int64_t size);
/// The same of groups at hand.
Aggregates aggregates_of(const Lattice& lattice, std::vector<std::int32_t> group, std::int64_t count);

}  // namespace craze::mechanics
