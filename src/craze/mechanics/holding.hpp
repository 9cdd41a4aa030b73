// Which unbonded neighbours are held by the matter about them.

#pragma once

#include "craze/mechanics/lattice.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Two unbonded elements that a third holds by intact beams to both are one piece of matter: the calibrated beams
/// carry what presses them together, and a contact would carry it twice. They touch only once they are parted. The
/// same rule keeps 1-3 neighbours from each other in molecular dynamics.
class Holding {
public:
    explicit Holding(const Lattice& lattice);

    /// Whether a third element holds i and j by beams that are intact in `kind`, shape (bonds,).
    bool holds(std::int32_t i, std::int32_t j, std::span<const domain::BondKind> kind) const;

private:
    std::vector<std::int32_t> first_;  ///< neighbours of e are [first_[e], first_[e + 1]), ascending
    std::vector<std::int32_t> other_, bond_;
};

}  // namespace craze::mechanics
