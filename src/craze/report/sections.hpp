// What the page says of each room.

#pragma once

#include "craze/report/output_folder.hpp"
#include "craze/report/page.hpp"
#include "craze/report/report.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace craze::report {

/// Units that pages print values in: value / nano is in nanometres.
inline constexpr double giga = 1e9, mega = 1e6, percent = 1e-2, micro = 1e-6, nano = 1e-9;

/// All that a section reads from and writes to.
struct Work {
    const OutputFolder& folder;
    const Settings& settings;
    bool paper;  ///< whether the paper's numbers stand beside ours
    Page& page;

    /// "Fig. 4" where the paper's numbers are wanted, else nothing.
    std::string figure(std::string_view name) const { return paper ? std::string(name) : std::string(); }
};

void write_overview(Work& work);
void write_synth(Work& work);
void write_images(Work& work);
void write_microstructure(Work& work);
void write_mesh(Work& work);
void write_domain(Work& work);
void write_loading(Work& work);
void write_reproduction(Work& work);
void write_record(Work& work);

/// Begins the section of a room; false (and a line saying so) if the room left no summary.
bool begin_room(Work& work, std::string_view room, std::string_view title);
/// Notices of the room, and all its numbers folded away.
void end_room(Work& work, std::string_view room);

/// Bars over bins of equal, round width; values that are not finite are left out.
/// @param weights  per value; empty: every value counts one
/// @param unit     values are divided by it
Series histogram(std::string name, std::span<const double> values, std::span<const double> weights, double unit,
                 int bins = 30, double most = 0.0);

/// Values over `unit`.
std::vector<double> over(std::span<const double> values, double unit);

/// "–" for what is not known, else the number over `unit` with `digits` significant digits.
std::string cell(double value, double unit = 1.0, int digits = 4);

}  // namespace craze::report
