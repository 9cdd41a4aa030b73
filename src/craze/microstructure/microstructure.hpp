// Which void is a pore, which a crack: the value that `microstructure` gives.

#pragma once

#include "craze/core/mask.hpp"
#include "craze/images/gray.hpp"

namespace craze::microstructure {

/// Voxels told apart. `gray` and `threshold` travel along because Eq. 15 needs them late.
struct Microstructure {
    images::Gray gray;
    int threshold = 0;  ///< S: void where gray < S [2.4.1]
    Mask matter;        ///< img. 0 of Fig. 6: true = matter (the paper's white)
    Mask pore;          ///< img. 1c: true = void of a pore
    Mask crack;         ///< img. 2: true = void of a crack; matter, pore and crack fill the volume
};

}  // namespace craze::microstructure
