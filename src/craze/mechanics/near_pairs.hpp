// Unbonded elements that are near each other now.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/motion.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Unbonded pairs, structure of arrays, i < j, sorted by (i, j).
struct Pairs {
    std::vector<std::int32_t> i, j;
    std::vector<double> dx, dy, dz;  ///< from centre i to centre j at rest, m
    std::vector<double> distance;    ///< |d|, m
    std::vector<double> limit;       ///< contact distance, m
    std::vector<std::uint8_t> cut;   ///< 1: a crack runs between them, or they were no neighbours at rest

    std::int64_t size() const { return std::ssize(i); }
    void add(const Pairs& from, std::size_t p);
    void append(const Pairs& from);
    bool before(std::size_t p, const Pairs& other, std::size_t q) const
    {
        return i[p] != other.i[q] ? i[p] < other.i[q] : j[p] < other.j[q];
    }
};
Pairs merged(const Pairs& a, const Pairs& b);

/// All unbonded pairs whose surfaces are nearer than reach; in small displacements the lattice's own. Elements that
/// were near at rest and are not listed by the lattice never touch: whoever made the domain has left their contact out.
/// @param pose  shape (n, 8)
Pairs near_pairs(const Lattice& lattice, Geometry geometry, std::span<const double> pose, double reach);

}  // namespace craze::mechanics
