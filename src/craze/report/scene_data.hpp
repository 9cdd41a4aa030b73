// Things of space as the page's viewer reads them: quantised, byte-shuffled, deflated, base64.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/vec3.hpp"
#include "craze/mesh/crack_surface.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace craze::report {

/// Numbers packed for the page: the bytes of equal weight together (they repeat more), then deflate, then base64.
std::string packed(std::span<const std::uint16_t> values);
std::string packed(std::span<const std::int32_t> values);
std::string packed(std::span<const std::uint8_t> values);

/// A length of [0, extent] as 0 ... 65535; beyond is brought back to the border.
std::uint16_t quantised(double value, double extent);

/// Parts of a scene in a box; `extent` is the longest edge of the box, and all lengths are quantised over it.
Json sheet_part(const std::string& name, const std::string& colour, const mesh::CrackSurface& surface, double extent);
/// @param shade  per ball 0 ... 255 over the viridis map; empty: one colour
Json balls_part(const std::string& name, const std::string& colour, std::span<const Vec3> centres,
                std::span<const double> radii, std::span<const std::uint8_t> shade, double extent);
/// Straight lines, two ends each.
Json lines_part(const std::string& name, const std::string& colour, std::span<const Vec3> ends,
                std::span<const std::uint8_t> shade, double extent);

/// The scene; lengths of the page are micrometres.
/// @param shade_title  what the viridis map shows, with its unit and ends: "T2 [nm]", least, most; empty: no map
Json scene_json(const Vec3& box, std::vector<Json> parts, const std::string& shade_title = "", double least = 0.0,
                double most = 1.0);

}  // namespace craze::report
