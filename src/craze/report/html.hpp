// The few pieces of HTML that the page is made of.

#pragma once

#include "craze/core/json_fwd.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace craze::report {

/// Text for element content and quoted attributes: & < > " ' become entities, control characters a space.
std::string escape(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::span<const std::byte> bytes);
std::string base64(std::string_view bytes);

/// Bytes in zlib's format, as DecompressionStream("deflate") reads them.
std::vector<std::byte> deflated(std::span<const std::byte> bytes);

/// JSON that may stand inside a <script> element: no "</" and no "<!--" in it.
std::string script_json(const Json& json);

/// data: address of bytes of the given type.
std::string data_uri(std::string_view type, std::span<const std::byte> bytes);
std::string data_uri(std::string_view type, std::string_view bytes);

/// A table; cells are HTML already. A cell that starts with a digit, a sign or an angle bracket of a number aligns
/// right.
struct Table {
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
    std::string kind;  ///< CSS class
};
std::string html(const Table& table);

/// "4 s", "2 min 5 s": time for people.
std::string format_seconds(double seconds);

/// Shortest text with `digits` significant digits and thousands kept apart: 92 123.
std::string format_number(double value, int digits = 4);

/// Any JSON as a table of dotted keys; long arrays are cut to their first values and their count.
std::string summary_table(const Json& json);

}  // namespace craze::report
