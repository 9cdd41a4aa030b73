// Pole figure and rose as pictures. Pictures carry no text: the axes are said here.

#pragma once

#include "craze/io/picture.hpp"
#include "craze/mesh/measures.hpp"

namespace craze::mesh {

/// Normals of the crack surface seen from above z, equal-area (Lambert) projection of the half sphere: z in the middle,
/// x to the right, y up. White is none, through orange to black at the fullest class; the bar has the same colours.
io::Picture pole_figure_picture(const PoleFigure& poles);

/// Three roses: sections perpendicular to x (y right, z up), y (x right, z up) and z (x right, y up). A petal's area
/// is the share of the length of the crack lines that run that way.
io::Picture rose_picture(const Rose& rose);

}  // namespace craze::mesh
