// Cuts through the stack: gray levels with pores and cracks laid over them [Figs. 3, 6].

#pragma once

#include "craze/io/picture.hpp"
#include "craze/report/sections.hpp"

#include <filesystem>

namespace craze::report {

/// Colours of pores and cracks wherever they appear (Okabe and Ito).
inline constexpr const char* pore_colour = "#56b4e9";
inline constexpr const char* crack_colour = "#d55e00";

/// `gray` (one channel) with the voxels of `phase` (0 pore, 128 crack, 255 matter) tinted by `strength` of 0 to 1.
/// The pictures have the same size.
io::Picture overlaid(const io::Picture& gray, const io::Picture& phase, double strength);

/// Means over squares of `factor` pixels; the last row and column of squares may be cut.
io::Picture averaged_down(const io::Picture& gray, std::int64_t factor);
/// Phases over squares: crack where any pixel is crack, else pore where at least half are, so that cracks thinner than
/// a square do not vanish.
io::Picture phases_down(const io::Picture& phase, std::int64_t factor);

/// Pictures side by side with a white gap; heights are the same.
io::Picture beside(const std::vector<io::Picture>& pictures);
/// A white bar of `length` pixels on a black ground, at the lower left.
void draw_scale_bar(io::Picture& picture, std::int64_t length);
/// 1, 2 or 5 times a power of ten metres that is 15 to 40 % of `width`.
double scale_bar_length(double width);

/// The viewer of slices: raw, cleaned and segmented, as far as they are on disk.
void write_slices(Work& work);

}  // namespace craze::report
