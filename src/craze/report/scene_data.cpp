#include "craze/report/scene_data.hpp"

#include "craze/core/json.hpp"
#include "craze/report/html.hpp"

#include <algorithm>
#include <cmath>

namespace craze::report {

namespace {

template <class T>
std::string packed_values(std::span<const T> values)
{
    const auto bytes = std::as_bytes(values);
    std::vector<std::byte> shuffled(bytes.size());
    for (std::size_t k = 0; k < values.size(); ++k)
        for (std::size_t b = 0; b < sizeof(T); ++b) shuffled[b * values.size() + k] = bytes[k * sizeof(T) + b];
    return base64(deflated(shuffled));
}

std::vector<std::uint16_t> coordinates(std::span<const Vec3> points, double extent)
{
    std::vector<std::uint16_t> out;
    out.reserve(3 * points.size());
    for (const auto& p : points)
        for (int axis = 0; axis < 3; ++axis) out.push_back(quantised(p[axis], extent));
    return out;
}

Json part(const std::string& kind, const std::string& name, const std::string& colour, std::size_t count)
{
    return {{"kind", kind}, {"name", name}, {"colour", colour}, {"count", count}};
}

}  // namespace

std::string packed(std::span<const std::uint16_t> values) { return packed_values(values); }
std::string packed(std::span<const std::int32_t> values) { return packed_values(values); }
std::string packed(std::span<const std::uint8_t> values) { return packed_values(values); }

std::uint16_t quantised(double value, double extent)
{
    return static_cast<std::uint16_t>(std::lround(std::clamp(value / extent, 0.0, 1.0) * 65535.0));
}

Json sheet_part(const std::string& name, const std::string& colour, const mesh::CrackSurface& surface, double extent)
{
    Json out = part("sheet", name, colour, surface.triangles.size());
    out["vertices"] = surface.vertices.size();
    out["points"] = packed(coordinates(surface.vertices, extent));
    std::vector<std::int32_t> steps;  // differences: corners near in the list are small numbers
    steps.reserve(3 * surface.triangles.size());
    std::int32_t last = 0;
    for (const auto& t : surface.triangles)
        for (const auto corner : t) steps.push_back(corner - last), last = corner;
    out["corners"] = packed(steps);
    return out;
}

Json balls_part(const std::string& name, const std::string& colour, std::span<const Vec3> centres,
                std::span<const double> radii, std::span<const std::uint8_t> shade, double extent)
{
    Json out = part("balls", name, colour, centres.size());
    out["points"] = packed(coordinates(centres, extent));
    std::vector<std::uint16_t> sizes;
    for (const double r : radii) sizes.push_back(quantised(r, extent));
    out["radii"] = packed(sizes);
    if (!shade.empty()) out["shade"] = packed(shade);
    return out;
}

Json lines_part(const std::string& name, const std::string& colour, std::span<const Vec3> ends,
                std::span<const std::uint8_t> shade, double extent)
{
    Json out = part("lines", name, colour, ends.size() / 2);
    out["points"] = packed(coordinates(ends, extent));
    if (!shade.empty()) out["shade"] = packed(shade);
    return out;
}

Json scene_json(const Vec3& box, std::vector<Json> parts, const std::string& shade_title, double least, double most)
{
    constexpr double micrometres = 1e6;
    Json out{{"box", {box.x * micrometres, box.y * micrometres, box.z * micrometres}},
             {"extent", std::max({box.x, box.y, box.z}) * micrometres},
             {"unit", "µm"},
             {"parts", std::move(parts)}};
    if (!shade_title.empty()) out["shade"] = {{"title", shade_title}, {"least", least}, {"most", most}};
    return out;
}

}  // namespace craze::report
