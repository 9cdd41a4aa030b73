#include "craze/io/atomic_file.hpp"
#include "craze/io/binary_file.hpp"
#include "craze/io/triangles.hpp"

namespace craze::io {

namespace {

// Data blocks of the file's end: each is its length in bytes, then the bytes.
struct AppendedArrays {
    std::string xml;
    std::uint64_t offset = 0;

    void array(const char* type, const std::string& name, int components, std::uint64_t bytes)
    {
        xml += fmt::format(
            "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
            "offset=\"{}\"/>\n",
            type, name, components, offset);
        offset += sizeof(std::uint64_t) + bytes;
    }
};

std::uint64_t bytes_of(const TriangleField& field)
{
    return std::visit([](const auto& values) { return std::uint64_t{values.size_bytes()}; }, field.values);
}

std::string head_of(const TriangleView& mesh)
{
    AppendedArrays data;
    const std::uint64_t points = mesh.vertices.size(), cells = mesh.triangles.size();
    data.xml = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <PolyData>\n    <Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n      <Points>\n",
        points, cells);
    data.array("Float64", "Points", 3, points * 3 * sizeof(double));
    data.xml += "      </Points>\n      <Polys>\n";
    data.array("Int32", "connectivity", 1, cells * sizeof(Corners));
    data.array("Int64", "offsets", 1, cells * sizeof(std::int64_t));
    data.xml += "      </Polys>\n      <CellData>\n";
    constexpr const char* types[] = {"UInt8", "Int32", "Float32"};
    for (const TriangleField& field : mesh.fields)
        data.array(types[field.values.index()], field.name, 1, bytes_of(field));
    data.xml += "      </CellData>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";
    return data.xml;
}

}  // namespace

void write_vtp(const std::filesystem::path& file, const TriangleView& mesh)
{
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        BinaryFile out(temporary);
        out.text(head_of(mesh));
        out.put(std::uint64_t{mesh.vertices.size() * 3 * sizeof(double)});
        for (const Vec3& v : mesh.vertices) out.put(v.x), out.put(v.y), out.put(v.z);
        out.put(std::uint64_t{mesh.triangles.size_bytes()});
        out.put(mesh.triangles);
        out.put(std::uint64_t{mesh.triangles.size() * sizeof(std::int64_t)});
        for (std::size_t t = 1; t <= mesh.triangles.size(); ++t) out.put(static_cast<std::int64_t>(3 * t));
        for (const TriangleField& field : mesh.fields) {
            out.put(bytes_of(field));
            std::visit([&](const auto& values) { out.put(values); }, field.values);
        }
        out.text("\n  </AppendedData>\n</VTKFile>\n");
        out.close();
    });
}

}  // namespace craze::io
