// The short way: the defects of a coating put straight into a domain, without images. Populations can be tried in
// seconds, and image way and short way check each other.

#pragma once

#include "craze/domain/discretisation.hpp"
#include "craze/synth/coating.hpp"
#include "craze/synth/sight.hpp"

namespace craze::synth {

/// Carves and cuts a dense domain by the defects themselves: an element is in a pore when its centre is [3.3]; a pair
/// is cut when its line of centres crosses a crack outside pores, where the sight sees it [3.4]. T1 and T2 are means
/// over lines along the bond's cylinder of what sight leaves of the opening, over the cosine of the crossing
/// [Eqs. 14, 15 with voxels ever finer]; bounded by L_0.
///
/// @param R_B  radius of the bond's cylinder, m [Eq. 3]
/// @throws InvalidInput  when the domain's box is not the coating's
domain::Discretisation discretise(const Coating& coating, domain::Domain dense, double R_B, const Sight& sight = {});

}  // namespace craze::synth
