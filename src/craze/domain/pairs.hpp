// Which elements are bonded, which are near: from centres and radii alone [3.1.1].

#pragma once

#include "craze/domain/domain.hpp"

#include <cstdint>
#include <vector>

namespace craze::domain {

/// Pairs i < j, sorted, whose surfaces are at most `gap` apart.
struct Pairs {
    std::vector<std::int32_t> i, j;
    std::vector<double> gap;  ///< surface distance d - r_i - r_j, m, negative where they overlap

    std::int64_t size() const { return static_cast<std::int64_t>(i.size()); }
};

/// All pairs with surfaces at most `gap` (m) apart. In a periodic box, across its faces too.
Pairs pairs_within(const Elements& elements, const Vec3& box, double gap, bool periodic = false);

/// 1 for each element whose surface is farther than `margin` (m) from every wall of the box, else 0.
std::vector<std::uint8_t> interior(const Elements& elements, const Vec3& box, double margin);

/// How elements are joined.
struct Bonding {
    double cardinality = 6.2;  ///< mean bonds per interior element (per element in a periodic box) [3.1.1]
    double near_gap = 0.3;     ///< near pairs: unbonded, surfaces at most this many R_DE apart
};

/// Bonds between the pairs of smallest surface gap until interior elements, those that touch no wall, have the mean
/// cardinality; all pairs up to that gap are bonded, those at walls too. Ties in gap go by (i, j).
/// Unbonded pairs up to near_gap become near pairs. In a periodic box, pairs across its faces count for the
/// cardinality and are then left out: the domain is a cut through an endless material.
///
/// Our reading: 6.2 is the mean over interior elements. It then gives 278 000 bonds on 92 000 elements, 6.04 over all:
/// both of the paper's numbers [3.1.1], and a cutoff gap that does not depend on the box.
/// @throws InvalidInput  when the cardinality cannot be reached with gaps up to R_DE
Domain join(Elements elements, const Vec3& box, double mean_radius, const Bonding& bonding, bool periodic = false);

}  // namespace craze::domain
