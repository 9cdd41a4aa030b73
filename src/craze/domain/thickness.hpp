// How thick is the crack that cuts a bond? Read from the voxels of the bond's cylinder [3.4.2].

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/domain/discretisation.hpp"
#include "craze/microstructure/microstructure.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::domain {

/// Which void counts as crack opening in a bond's cylinder.
enum class CountedVoid {
    /// Voxels of cracks. Our reading of "voxels representing cracks": pores are represented by the elements they take,
    /// and a pore that reaches into the cylinder of a bond beside it is no opening of the crack.
    crack,
    /// All void voxels, pores too: the letter of "gray level below the threshold".
    all,
};

/// Voxels whose centres lie in a cylinder, ends and mantle included.
struct CylinderVoxels {
    std::int64_t total = 0;  ///< N_tot, those inside the stack
    std::int64_t black = 0;  ///< N_black: counted void
    double darkness = 0.0;   ///< sum of 1 - I/S over counted void with I < S
};

/// The voxels of the cylinder of radius `radius` (m) with its axis from a to b (m). A cylinder too thin to hold the
/// centre of any voxel gives the voxels along its axis.
CylinderVoxels voxels_in_cylinder(const Vec3& a, const Vec3& b, double radius,
                                  const microstructure::Microstructure& micro, CountedVoid counted);

/// T1 = L_0 N_black / N_tot, m; 0 where N_tot is 0. [Eq. 14, Fig. 15]
double binary_thickness(const CylinderVoxels& voxels, double L_0);
/// T2 = L_0 sum(1 - I/S) / N_tot, m; 0 where N_tot is 0. [Eq. 15]
double intensity_thickness(const CylinderVoxels& voxels, double L_0);

/// Fills T1 and T2 of the pairs marked cut; 0 elsewhere. The cylinder of a pair has radius R_B (m) [Eq. 3].
void measure_thickness(PairCracks& cracks, const Elements& elements, std::span<const std::int32_t> i,
                       std::span<const std::int32_t> j, double R_B, const microstructure::Microstructure& micro,
                       CountedVoid counted);

}  // namespace craze::domain
