// The scale beside a picture whose colours are numbers.

#pragma once

#include "craze/io/picture.hpp"
#include "craze/report/render.hpp"

#include <string>
#include <string_view>

namespace craze::report {

struct ColourBar {
    double least = 0.0, most = 1.0;  ///< values at the bottom (viridis(0)) and at the top (viridis(1))
    std::string title;               ///< with its unit: "u_x [nm]"
};

/// The picture with the bar, its title and its round values to the right of it; 200 px wider at a height of 750.
/// @throws InvalidInput  when the picture is gray or the values do not rise
io::Picture with_colour_bar(const io::Picture& picture, const ColourBar& bar);

/// Writes digits and the signs of units, `size` px high; (x, y) is the upper left corner. Signs that are not known are
/// left blank.
void write_text(io::Picture& picture, double x, double y, double size, std::string_view text, Colour ink);

}  // namespace craze::report
