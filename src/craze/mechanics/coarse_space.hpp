// What many elements do together: rigid motions of aggregates, so that long waves converge as fast as short ones.

#pragma once

#include "craze/mechanics/aggregates.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace craze::mechanics {

/// The Galerkin projection of the stiffness on six rigid motions per aggregate, factorised.
class CoarseSpace {
public:
    CoarseSpace();
    ~CoarseSpace();
    CoarseSpace(CoarseSpace&&) noexcept;
    CoarseSpace& operator=(CoarseSpace&&) noexcept;

    /// @param imposed  degrees of freedom that do not move, ascending
    void set_up(const Lattice& lattice, const Stiffness& stiffness, std::span<const std::int64_t> imposed,
                Aggregates groups);
    /// The same beams and groups, other springs.
    void update(const Stiffness& stiffness);
    /// Loads of the aggregates, force (EA) and moment about its centre (EA R), become displacement (R) and rotation;
    /// rows of eight, the last two of each not used.
    void solve(std::span<float> load) const;
    std::int32_t aggregates() const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace craze::mechanics
