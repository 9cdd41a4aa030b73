// Numbers with units, as people write them: "23.6 nm", "223 GPa", "8.5 px". SI doubles inside.

#pragma once

#include <string>
#include <string_view>

namespace craze {

enum class Dimension { pure, fraction, pixel, length, pressure, density, time, angle, velocity, size };

/// Value in SI (pixel: pixels; fraction: 1; angle: radian; size: bytes) of "NUMBER UNIT"; a unit may be left out
/// only for pure numbers and fractions.
/// @throws InvalidInput  naming the text, the units that would do and the nearest of them
double parse_quantity(std::string_view text, Dimension dimension);

/// The shortest text that parses back to the same value, with the unit that reads best: 2.36e-8 m -> "23.6 nm".
std::string format_quantity(double value, Dimension dimension);

/// "nm, um, mm, m" and so on, for messages and manuals.
std::string units_of(Dimension dimension);

/// The candidate nearest to `word` in edit distance; empty where none is near.
std::string nearest_name(std::string_view word, const std::string* begin, const std::string* end);

}  // namespace craze
