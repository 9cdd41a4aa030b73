// A plot as data: the page draws it to be explored, a file shows it to be printed, a CSV gives its numbers.

#pragma once

#include "craze/core/json_fwd.hpp"

#include <limits>
#include <string>
#include <vector>

namespace craze::report {

enum class Mark {
    line,
    points,
    bars,  ///< x holds the n + 1 edges of n bars
    dashed,
};

struct Series {
    std::string name;
    std::vector<double> x, y;  ///< in the units of the axes; a NaN leaves a gap
    Mark mark = Mark::line;
    int colour = -1;  ///< index into the palette; -1: next one
};

/// A line across the plot at a value worth reading: a threshold, a bound, a number of the paper.
struct Guide {
    double at = 0.0;
    std::string label;
    bool upright = true;  ///< at an x (true) or at a y (false)
};

struct Axis {
    std::string title;  ///< with its unit: "axial strain [%]"
    bool log = false;
    double least = std::numeric_limits<double>::quiet_NaN();  ///< NaN: from the data
    double most = std::numeric_limits<double>::quiet_NaN();
};

struct Figure {
    std::string id;       ///< file name and anchor: [a-z0-9_]+
    std::string caption;  ///< one or two sentences, plain text
    std::string paper;    ///< "Fig. 4", or empty
    Axis x, y;
    std::vector<Series> series;
    std::vector<Guide> guides;

    /// Whether any series holds a finite point.
    bool empty() const;
};

/// A stand-alone SVG of 640 x 400; axes and text take the colour of the text around them when it stands in a page.
std::string svg(const Figure& figure);

/// Columns x and one per series where all share their x, else series, x, y. Bars give their left and right edges.
std::string csv(const Figure& figure);

/// What the page's script draws from.
Json to_json(const Figure& figure);

/// Colours that colour-blind readers tell apart (Okabe and Ito), as #rrggbb; repeats after seven.
std::string palette(int index);

/// A rose of directions over 180 or 360 degrees: petals of equal width whose area shows the share.
struct Rose {
    std::string id, caption, paper;
    std::vector<double> share;    ///< one value per petal, >= 0
    double first_degrees = 0.0;   ///< the middle of the first petal
    double span_degrees = 180.0;  ///< 180: axes without a head, drawn twice
    std::string east, north;      ///< what 0 and 90 degrees mean: "x", "y"
};
std::string svg(const Rose& rose);
std::string csv(const Rose& rose);

}  // namespace craze::report
