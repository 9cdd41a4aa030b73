// Points joined by lines, with fields on both, for ParaView: VTK's XML unstructured grid with raw appended data.

#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace craze::io {

/// A field on points or lines: `components` numbers for each, one after the other.
struct VtuField {
    std::string name;
    int components = 1;
    std::variant<std::span<const float>, std::span<const double>, std::span<const std::int32_t>,
                 std::span<const std::uint8_t>>
        values;
};

struct VtuGrid {
    std::span<const double> points;       ///< m, shape (n, 3)
    std::span<const std::int32_t> lines;  ///< ends of each line, shape (m, 2)
    std::vector<VtuField> on_points, on_lines;
};

/// @throws InvalidInput  when a field does not fit its points or lines, or the file cannot be written
void write_vtu(const std::filesystem::path& file, const VtuGrid& grid);

/// What a picture of a written state needs.
struct VtuPoints {
    std::vector<double> points;       ///< m, shape (n, 3)
    std::vector<float> radius;        ///< m, shape (n,)
    std::vector<float> displacement;  ///< m, shape (n, 3)
};
/// Reads back a file of write_vtu with point fields "radius" and "displacement".
/// @throws InvalidInput  when the file is missing, cut short or was written by something else
VtuPoints read_vtu_points(const std::filesystem::path& file);

}  // namespace craze::io
