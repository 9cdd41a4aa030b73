// Pores and cracks told apart by the size of the ball they hold [2.4.3, Fig. 6].

#pragma once

#include "craze/core/mask.hpp"

namespace craze::microstructure {

/// What lies behind the border of the volume, for the closing.
enum class Border {
    open = 0,    ///< neither matter nor void: a pore cut by the border goes on behind it
    matter = 1,  ///< matter: a pore at the border must hold its whole ball inside the volume
};

/// The images of Fig. 6, as voids: true = black in the paper.
struct Classification {
    Mask closed;    ///< img. 1a: voids that hold a ball of R_C, each the union of such balls
    Mask enlarged;  ///< img. 1b: the same, grown by R_E
    Mask pore;      ///< img. 1c: img. 1b and void
    Mask crack;     ///< img. 2: void and not pore
};

/// Balls are lattice balls: offsets with d^2 <= floor(r^2).
///
/// @param matter  img. 0 of Fig. 6, true = matter
/// @param R_C     px, closing radius
/// @param R_E     px, erosion radius
/// @throws InvalidInput  when a radius is out of [0, 500]
Classification classified(const Mask& matter, double R_C, double R_E, Border border = Border::open);

/// Img. 1a alone.
Mask closed_void(const Mask& matter, double R_C, Border border = Border::open);

}  // namespace craze::microstructure
