// Is the packing a good material? The sheet that says.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/domain/domain.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace craze::domain {

struct Quality {
    double volume_fraction = 0.0;                  ///< sum of sphere volumes / box
    double interior_volume_fraction = 0.0;         ///< of the box less 4 R_DE at every wall, by spheres centred there
    std::array<double, 5> overlap{};               ///< of touching pairs, share of r_i + r_j: least, quartiles, most
    std::int64_t touching = 0;                     ///< pairs that overlap, bonded or near
    double cardinality = 0.0;                      ///< bonds per element, each counted at both ends [3.1.1]
    double interior_cardinality = 0.0;             ///< of elements that touch no wall
    double contact_number = 0.0;                   ///< touching neighbours per element
    std::int64_t rattlers = 0;                     ///< elements without a bond
    std::int64_t components = 0;                   ///< of elements joined by beams, those without a bond apart
    double largest_component = 0.0;                ///< its share of the elements
    std::array<double, 6> fabric{};                ///< mean of n n^T over beams: xx yy zz xy yz zx; isotropic: 1/3, 0
    std::array<double, 5> bond_length{};           ///< L_0 in mean diameters 2 R_DE: least, quartiles, most [Eq. 4]
    std::vector<std::int64_t> bond_length_counts;  ///< histogram of L_0 / 2 R_DE, 60 bins over [0.7, 1.3]
};

Quality quality(const Domain& domain);
Json as_json(const Quality& quality);

/// Least, quartiles and most of values; zeros where there are none.
std::array<double, 5> five_numbers(std::vector<double> values);

}  // namespace craze::domain
