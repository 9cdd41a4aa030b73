// What is left of an opening when it has been photographed and measured.

#pragma once

#include "craze/synth/microscope.hpp"

#include <vector>

namespace craze::synth {

/// Eqs. 14 and 15 across a flat crack that faces an axis of the voxels, averaged over where the voxels lie: partial
/// volume and blur are in it; noise, stripes and cleaning are not.
class Sight {
public:
    /// Sees everything as it is: both measures give the opening.
    Sight() = default;
    /// @param voxel_size  h, m
    /// @param threshold   S: void where gray < S [2.4.1]
    /// @throws InvalidInput  unless void < S <= matter
    Sight(const Microscope& microscope, double voxel_size, double threshold);

    /// Width of the trough of gray below the threshold, m: T1 of a bond across the crack.
    double width(double opening) const;
    /// Integral of 1 - I/S over that trough, m: T2 of a bond across the crack.
    double intensity(double opening) const;
    /// Openings up to this leave no voxel below the threshold, m.
    double least_opening() const { return least_; }

private:
    double look_up(const std::vector<double>& table, double slope, double opening) const;

    double step_ = 0.0, least_ = 0.0, deepest_ = 1.0;
    std::vector<double> width_, intensity_;  // at openings 0, step, 2 step ...; empty: sees everything
};

}  // namespace craze::synth
