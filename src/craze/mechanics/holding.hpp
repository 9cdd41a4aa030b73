// Which unbonded neighbours are held by the matter about them.

#pragma once

#include "craze/mechanics/lattice.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Contact acts where matter has parted. Unbonded neighbours inside one piece of matter do not touch: the calibrated
/// beams carry what presses them together, and a contact would carry it twice. Two of them have parted when a crack
/// runs between them or one of them has lost a beam since rest, and no third element holds both by intact beams (as
/// 1-3 neighbours are kept from each other in molecular dynamics).
class Holding {
public:
    /// @param lattice  outlives this
    explicit Holding(const Lattice& lattice);

    /// @param cut   a crack runs between i and j at rest, or they were no neighbours then
    /// @param kind  of each bond now, shape (bonds,)
    bool parted(std::int32_t i, std::int32_t j, bool cut, std::span<const domain::BondKind> kind) const
    {
        return (cut || has_lost_a_beam(i, kind) || has_lost_a_beam(j, kind)) && !holds(i, j, kind);
    }
    /// Whether a third element holds i and j by beams that are intact.
    bool holds(std::int32_t i, std::int32_t j, std::span<const domain::BondKind> kind) const;

private:
    bool has_lost_a_beam(std::int32_t e, std::span<const domain::BondKind> kind) const;

    const Lattice& lattice_;
    std::vector<std::int32_t> first_;  ///< neighbours of e are [first_[e], first_[e + 1]), ascending
    std::vector<std::int32_t> other_, bond_;
};

}  // namespace craze::mechanics
