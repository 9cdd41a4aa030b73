// Is this a domain that can be loaded? Asked of everything that comes from a file.

#pragma once

#include "craze/domain/domain.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace craze::domain {

enum class Part { element, bond, near_pair };
std::string name_of(Part part);

/// Says where an element, bond or near pair came from: "elements.csv, line 17".
using Origin = std::function<std::string(Part, std::size_t index)>;

/// Elements: finite, positive radius, centre in the box (half a mean radius outside is let pass), no centre inside
/// another element; R_DE within half and twice their mean radius, the dense volume at least theirs. Bonds and near
/// pairs: i < j, both elements exist, none twice, finite thickness in [0, L_0]. Bonds and near pairs must be sorted by
/// (i, j), as sort_pairs leaves them.
/// @throws InvalidInput  naming the origin of the first that fails and what was needed
void check_domain(const Domain& domain, const Origin& origin);

}  // namespace craze::domain
