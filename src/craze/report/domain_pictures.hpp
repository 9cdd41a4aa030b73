// A discretisation seen: elements, those that pores take, bonds that cracks cut, how thick those cracks are.

#pragma once

#include "craze/domain/discretisation.hpp"
#include "craze/report/sections.hpp"

namespace craze::report {

/// Viewer and rendered pictures [Figs. 10, 12, 13].
void draw_domain(Work& work, const domain::Discretisation& discretisation);

/// T1 and T2 of the cut bonds, bars of 4 nm or wider [Fig. 16].
Figure thickness_figure(const domain::Discretisation& discretisation);

/// T1 and T2 at each voxel size of `voxel_sizes.json` [Fig. 16].
Figure voxel_size_figure(const Json& study);

/// The largest box amid `box`, of its shape, that holds at most `most` of the elements: a share of its edges, in (0,
/// 1].
double share_shown(const domain::Domain& dense, std::int64_t most);

}  // namespace craze::report
