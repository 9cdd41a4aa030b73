// Cracks thinner than their blur: dark sheets found by the curvature of the gray levels, at several scales.
//
// Where cracks never get as dark as pores, no global threshold finds them. A dark sheet has a large positive second
// derivative across and small ones along. The multiscale Hessian is what experts of fractured rock use (Voorn, Exner,
// Rath, Comput. Geosci. 57 (2013) 44); the measure, the hysteresis and the code are ours.

#pragma once

#include "craze/core/mask.hpp"

#include <vector>

namespace craze::microstructure {

/// Response of dark sheets, gray levels: the largest over the scales of
///     sigma^2 (lambda_1 - max(|lambda_2|, |lambda_3|)),   lambda_1 the largest eigenvalue of the Hessian,
/// of the volume smoothed by a Gaussian of sigma px; 0 where negative, and where the Laplacian is not positive. A sheet
/// much wider than sigma responds along its faces only; one of width w < sigma and depth c with 0.4 c w / sigma. A
/// single slice (nz = 1) shows lines.
///
/// @param scales  sigma, px, each in [0.5, 20], at least one
/// @throws InvalidInput  when there are none or one is out of range
Volume<float> sheet_response(const Volume<std::uint8_t>& gray, const std::vector<double>& scales);

/// Voxels with at least `low` that hang together (26) with one of at least `high`, in objects of `least` voxels or
/// more.
Mask hysteresis(const Volume<float>& response, double low, double high, std::int64_t least);

}  // namespace craze::microstructure
