// What is left of an opening when it has been photographed and measured.

#pragma once

#include "craze/synth/microscope.hpp"

#include <vector>

namespace craze::synth {

/// Eqs. 14 and 15 across a flat crack that faces x or y, averaged over where it lies among the voxels: partial volume
/// and blur are in it; noise, stripes and cleaning are not.
class Sight {
public:
    /// Sees everything as it is: both measures give the opening.
    Sight() = default;
    /// @param voxel_size  h, m
    /// @param threshold   S: void where gray < S [2.4.1]
    /// @throws InvalidInput  unless void < S <= matter
    Sight(const Microscope& microscope, double voxel_size, double threshold);

    /// Voxels below the threshold across the crack, m: T1 of a bond across the crack.
    double width(double opening) const;
    /// Sum of 1 - I/S over them, m: T2 of a bond across the crack.
    double intensity(double opening) const;
    /// The opening that leaves half a voxel below the threshold on average, m: thinner cracks are not taken for cracks.
    double least_opening() const { return least_; }

    double rim = 0.0;     ///< how far the skeleton draws a crack back from its rim [2.5], m
    double margin = 0.0;  ///< void so near to a pore is taken for part of it (R_E) [2.4.3], m

private:
    double look_up(const std::vector<double>& table, double slope, double opening) const;

    double step_ = 0.0, least_ = 0.0, deepest_ = 1.0;
    std::vector<double> width_, intensity_;  // at openings 0, step, 2 step ...; empty: sees everything
};

}  // namespace craze::synth
