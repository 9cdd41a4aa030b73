// What do we say? One self-contained page, and pictures a paper can use, from whatever the rooms left on disk.

#pragma once

#include "craze/core/schema.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace craze::report {

/// Whether the printed numbers of the paper stand beside ours.
enum class PaperNumbers {
    automatic,  ///< when the run starts from a synthetic coating
    always,
    never,
};

/// Section [report].
struct Settings {
    std::string title = "From microscope images to mechanical behaviour";
    PaperNumbers paper = PaperNumbers::automatic;
    std::int64_t slices = 16;          ///< slices of the viewer, evenly spaced along the stack
    std::int64_t picture_width = 560;  ///< widest picture of a slice, px; wider slices are averaged down
    bool scenes = true;                ///< crack surface and domain in 3D
    std::int64_t triangles = 120'000;  ///< at most this many triangles of the crack surface go into the page
    std::int64_t elements = 120'000;   ///< at most this many elements go into the page (beyond: a box amid the domain)
    std::int64_t render_width = 1400;  ///< width of the rendered pictures, px
};

/// Keys, ranges, meanings.
void describe(Schema& schema, Settings& settings);

/// What no single range can say.
/// @throws InvalidInput  when the title is empty
void check(const Settings& settings);

/// Writes <out>/report/index.html (nothing in it needs a network), <out>/report/figures/*.svg, *.csv and *.png.
/// Rooms that left nothing get a line saying so; files that cannot be read get a notice.
/// @return the page
/// @throws InvalidInput  when `out` is not a folder or cannot be written
std::filesystem::path write_report(const std::filesystem::path& out, const Settings& settings);

}  // namespace craze::report
