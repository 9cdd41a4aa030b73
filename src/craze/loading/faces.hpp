// The six sides of a specimen: which elements a loading holds or drives, and how far they have moved.

#pragma once

#include "craze/mechanics/constraints.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/state.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace craze::loading {

/// The sides of a specimen: x least, x most, y least, y most, z least, z most.
struct Faces {
    std::array<mechanics::Face, 6> sides;

    const mechanics::Face& side(int axis, bool most) const
    {
        return sides[static_cast<std::size_t>(2 * axis + (most ? 1 : 0))];
    }
};

/// Elements whose centre lies within `reach` of their own radius of a wall.
/// @throws ComputationFailed  naming the side that has no bonded element: nothing could be held or driven there
Faces find_faces(const mechanics::Lattice& lattice, double reach);

/// 1 for elements that belong to the load-bearing body: fragments of intact beams with at least one element in a
/// hundred of the largest one. Rattlers and crumbs move at random and would spoil means. Shape (elements,).
std::vector<std::uint8_t> load_bearing(const mechanics::Lattice& lattice);

/// How a specimen deforms, from the displacements of its elements.
struct Deformation {
    Vec3 box;       ///< of the box: difference of the mean displacements of two sides, over the box edge [Eq. 17]
    Vec3 face;      ///< the same difference over the distance of the mean centres of the two sides
    Vec3 interior;  ///< slope of displacement over position, by regression on elements away from every wall
};

/// Measures strain three ways; made once per specimen.
class StrainGauge {
public:
    /// @param margin  distance of interior elements from every wall, m; at most a quarter of the least box edge is used
    StrainGauge(const mechanics::Lattice& lattice, const Faces& faces, double margin);
    Deformation measure(const mechanics::State& state) const;
    std::int64_t interior_elements() const { return static_cast<std::int64_t>(interior_.size()); }

private:
    Vec3 edges_;
    std::array<std::vector<std::int32_t>, 6> sides_;
    Vec3 face_distance_;
    std::vector<std::int32_t> interior_;
    std::array<std::vector<double>, 3> weight_;  ///< of interior elements in each regression
};

}  // namespace craze::loading
