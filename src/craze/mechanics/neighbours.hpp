// Unbonded elements that meet.

#pragma once

#include "craze/mechanics/holding.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/motion.hpp"
#include "craze/mechanics/near_pairs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Keeps the pairs that may touch: all near ones, searched anew when elements have moved far, and of these the few
/// whose gap is small, chosen anew when elements have moved a little. In small displacements the pairs are the
/// lattice's. Only pairs that have parted (Holding) are active.
class Neighbours {
public:
    /// @param pressed  what another Neighbours of this motion had found, sorted by (i, j)
    Neighbours(const Lattice& lattice, Geometry geometry, std::vector<PressedPair> pressed = {});
    /// Makes sure that every pair that touches now is active.
    /// @param pose   shape (n, 8)
    /// @param kind   of each bond now
    /// @param moved  how much nearer any two near elements may have come since the last call, m
    /// @return whether the active pairs have changed
    bool follow(std::span<const double> pose, std::span<const domain::BondKind> kind, double moved);
    /// Beams have broken: pairs that were held become active. Those that overlap start at zero force: their distance
    /// now becomes their contact distance, so that no energy comes from nowhere.
    /// @param ends  elements that have lost a beam since the last call, in any order
    /// @return whether the active pairs have changed
    bool part(std::span<const double> pose, std::span<const domain::BondKind> kind, std::span<const std::int32_t> ends);
    /// Sorted by (i, j).
    const std::vector<PressedPair>& pressed() const { return pressed_; }
    const Pairs& active() const { return active_; }

private:
    void list_parted(std::span<const domain::BondKind> kind);
    void choose(std::span<const double> pose);
    void lower_limits();

    const Lattice& lattice_;
    Holding holding_;
    Geometry geometry_;
    double reach_, skin_;                               ///< m
    double until_search_ = -1.0, until_choice_ = -1.0;  ///< m of approach left
    Pairs near_, active_;
    std::vector<std::int32_t> first_near_,
        near_of_;                       ///< near pairs of e are near_of_[first_near_[e], first_near_[e + 1])
    std::vector<std::uint8_t> parted_;  ///< of each near pair
    std::vector<std::int32_t> loose_;   ///< near pairs that have parted, ascending
    std::vector<PressedPair> pressed_;
};

/// Pushes of the pairs in [begin, end) on rows (of eight) of i, and of j below the limit. Gives their energy, J.
double add_pairs(const Pairs& pairs, std::int64_t begin, std::int64_t end, double stiffness, Geometry geometry,
                 std::int64_t limit, const double* pose, double* force);
/// Listed pairs: rows of j alone.
void add_border_pairs(const Pairs& pairs, std::span<const std::int32_t> list, double stiffness, Geometry geometry,
                      const double* pose, double* force);

}  // namespace craze::mechanics
