// Sheets one voxel thick in the middle of each crack, whatever way it lies.

#pragma once

#include "craze/core/mask.hpp"

namespace craze::mesh {

/// Thins `set` layer by layer from the six sides in turn. A voxel that parts the rest locally (a surface isthmus) is
/// kept for good; any other goes as soon as its removal changes no topology. What remains are the sheets, and the
/// lines and points that topology needs: components, tunnels and cavities are those of `set` (26-connected set,
/// 6-connected rest; outside is rest). Rims recede by about half the thickness and bumps leave no spurs.
///
/// Voxels that are tried together are never neighbours (eight subfields by parity), so that the result depends on
/// neither order nor threads. Memory: three masks.
/// @throws Interrupted  when asked to stop
Mask medial_surface(const Mask& set);

}  // namespace craze::mesh
