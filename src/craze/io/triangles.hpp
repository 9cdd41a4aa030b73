// Triangle meshes in the formats of other programs: PLY (read and written), STL and VTP (written).

#pragma once

#include "craze/core/vec3.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace craze::io {

using Corners = std::array<std::int32_t, 3>;

/// Numbers that go along with the triangles, one per triangle.
struct TriangleField {
    std::string name;
    std::variant<std::span<const std::uint8_t>, std::span<const std::int32_t>, std::span<const float>> values;
};

/// A view of a mesh.
struct TriangleView {
    std::span<const Vec3> vertices;
    std::span<const Corners> triangles;   ///< indices into vertices
    std::vector<TriangleField> fields{};  ///< shape (triangles,) each; STL leaves them out
};

/// Binary little-endian PLY, coordinates as double: read by ParaView, MeshLab, Blender, Python's trimesh.
/// @throws InvalidInput  when the file cannot be written
void write_ply(const std::filesystem::path& file, const TriangleView& mesh);

/// Binary STL. Coordinates become float and vertices are repeated per triangle, as the format wants.
/// @throws InvalidInput  when the file cannot be written, or for more than 2^32 - 1 triangles
void write_stl(const std::filesystem::path& file, const TriangleView& mesh);

/// VTK's XML PolyData (.vtp), raw appended data, coordinates as double: read by ParaView and VTK, with the fields.
/// @throws InvalidInput  when the file cannot be written
void write_vtp(const std::filesystem::path& file, const TriangleView& mesh);

struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<Corners> triangles;
    std::vector<std::uint8_t> tags;  ///< the uchar face property asked for; empty where the file has none
};

/// A binary little-endian PLY of triangles, from here or from elsewhere: coordinates float or double, other properties
/// are skipped, except the face property named `tag`.
/// @throws InvalidInput  naming the file and what is wrong with it: not a PLY, another encoding, faces that are not
///         triangles, indices beyond the vertices, an end that comes too early
TriangleMesh read_ply(const std::filesystem::path& file, const std::string& tag = "");

}  // namespace craze::io
