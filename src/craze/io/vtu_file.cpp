#include "craze/io/vtu_file.hpp"

#include "craze/core/errors.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/core.h>

#include <bit>
#include <fstream>
#include <type_traits>

namespace craze::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the header below says LittleEndian");
constexpr std::uint8_t vtk_line = 3;

template <class T>
constexpr const char* type_name()
{
    if constexpr (std::is_same_v<T, float>)
        return "Float32";
    else if constexpr (std::is_same_v<T, double>)
        return "Float64";
    else if constexpr (std::is_same_v<T, std::int32_t>)
        return "Int32";
    else
        return "UInt8";
}

/// The XML names an offset for each array; the arrays follow, each behind its size in bytes.
class Appended {
public:
    template <class T>
    std::string add(const std::string& name, int components, std::span<const T> values)
    {
        const std::string tag = fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
            type_name<T>(), name, components, offset_);
        blocks_.push_back(std::as_bytes(values));
        offset_ += sizeof(std::uint64_t) + values.size_bytes();
        return tag;
    }
    void write(std::ofstream& out) const
    {
        for (const auto& block : blocks_) {
            const auto size = static_cast<std::uint64_t>(block.size());
            out.write(reinterpret_cast<const char*>(&size), sizeof size);
            out.write(reinterpret_cast<const char*>(block.data()), static_cast<std::streamsize>(block.size()));
        }
    }

private:
    std::vector<std::span<const std::byte>> blocks_;
    std::uint64_t offset_ = 0;
};

std::string add_fields(Appended& data, const std::vector<VtuField>& fields, std::size_t count, const char* where)
{
    std::string tags;
    for (const auto& field : fields)
        std::visit(
            [&](const auto& values) {
                if (values.size() != count * static_cast<std::size_t>(field.components))
                    throw InvalidInput(fmt::format("VTU field \"{}\": needed {} x {} values on {}, got {}", field.name,
                                                   count, field.components, where, values.size()));
                tags += data.add(field.name, field.components, values);
            },
            field.values);
    return tags;
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const VtuGrid& grid)
{
    const std::size_t points = grid.points.size() / 3, lines = grid.lines.size() / 2;
    std::vector<std::int32_t> ends(lines);
    for (std::size_t k = 0; k < lines; ++k) ends[k] = static_cast<std::int32_t>(2 * (k + 1));
    const std::vector<std::uint8_t> types(lines, vtk_line);

    Appended data;
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<UnstructuredGrid>\n";
    xml += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", points, lines);
    xml += "<Points>\n" + data.add("Points", 3, grid.points) + "</Points>\n<Cells>\n";
    xml += data.add("connectivity", 1, grid.lines);
    xml += data.add("offsets", 1, std::span<const std::int32_t>(ends));
    xml += data.add("types", 1, std::span<const std::uint8_t>(types));
    xml += "</Cells>\n<PointData>\n" + add_fields(data, grid.on_points, points, "points");
    xml += "</PointData>\n<CellData>\n" + add_fields(data, grid.on_lines, lines, "lines");
    xml += "</CellData>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out << xml;
        data.write(out);
        out << "\n</AppendedData>\n</VTKFile>\n";
        out.flush();
        if (!out) throw InvalidInput(fmt::format("{}: could not be written; is the disk full?", file.string()));
    });
}

}  // namespace craze::io
