// Which degrees of freedom are imposed, and what it takes to impose them.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Elements at one wall of the box.
struct Face {
    int axis = 0;                        ///< of the normal: 0, 1, 2
    bool high = false;                   ///< at box[axis] rather than at 0
    std::vector<std::int32_t> elements;  ///< ascending
};

/// Elements whose centre lies within `reach` times their own radius of the wall.
/// @throws ComputationFailed  when there is none: nothing could be held or driven there
Face find_face(const Lattice& lattice, int axis, bool high, double reach = 1.05);

/// Imposed degrees of freedom, all others are free.
struct Constraints {
    std::vector<std::int64_t> dof;  ///< 6 e + c (c = 0..2 displacement, 3..5 rotation), ascending, none twice
    std::vector<double> value;      ///< m or rad

    std::int64_t size() const { return static_cast<std::int64_t>(dof.size()); }
    /// Imposes (or changes) number c of element e.
    void impose(std::int32_t e, int c, double value);
    /// Imposes (or changes) the displacement of all elements of a face along its normal.
    void impose_normal(const Face& face, double displacement);
};

/// Force along +axis with which whatever holds or drives a face acts on the lattice, N: in tension it is positive at
/// the high face and negative at the low one.
/// @param force  of the lattice on the elements, shape (n, 6): Forces::force
double face_force(const Face& face, std::span<const double> force);

}  // namespace craze::mechanics
