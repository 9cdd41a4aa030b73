// What many elements do together: rigid motions of aggregates, so that long waves converge as fast as short ones.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace craze::mechanics {

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

/// The Galerkin projection of the stiffness on six rigid motions per aggregate, factorised.
class CoarseSpace {
public:
    CoarseSpace();
    ~CoarseSpace();
    CoarseSpace(CoarseSpace&&) noexcept;
    CoarseSpace& operator=(CoarseSpace&&) noexcept;

    /// @param imposed  degrees of freedom that do not move, ascending
    void set_up(const Lattice& lattice, const Stiffness& stiffness, std::span<const std::int64_t> imposed);
    /// z += P (P^T K P)^-1 P^T r; zero at imposed degrees of freedom.
    void add(std::span<const double> r, std::span<double> z) const;
    std::int32_t aggregates() const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace craze::mechanics
