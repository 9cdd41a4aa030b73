// NRRD with raw encoding, its values in the same file or beside it.

#include "craze/io/text_lines.hpp"
#include "craze/io/volume_formats.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

using Fields = std::map<std::string, std::string>;

// The fields up to the blank line (or the end of a detached header), and where that line ends.
Fields read_fields(const fs::path& file, std::int64_t& length)
{
    std::ifstream in(file, std::ios::binary);
    std::string line;
    if (!in || !std::getline(in, line) || !line.starts_with("NRRD000")) refuse(file, "not an NRRD file");
    length = static_cast<std::int64_t>(line.size()) + 1;
    Fields fields;
    for (int lines = 0; lines < 1000 && std::getline(in, line) && line.size() < 65536; ++lines) {
        length += static_cast<std::int64_t>(line.size()) + 1;
        if (trimmed(line).empty()) return fields;
        const auto colon = line.find(':');
        if (line[0] == '#' || colon == std::string::npos) continue;
        const bool pair = colon + 1 < line.size() && line[colon + 1] == '=';
        if (!pair) fields[trimmed(line.substr(0, colon))] = trimmed(line.substr(colon + 1));
    }
    if (!fields.contains("data file") && !fields.contains("datafile")) refuse(file, "its header has no end");
    return fields;
}

Sample sample_of_type(const fs::path& file, const std::string& type)
{
    for (const char* name : {"uchar", "unsigned char", "uint8", "uint8_t"})
        if (type == name) return Sample::u8;
    for (const char* name : {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"})
        if (type == name) return Sample::u16;
    if (type == "float") return Sample::f32;
    refuse(file, fmt::format("type: needed uint8, uint16 or float, got \"{}\"", type));
}

double metres(const std::string& unit)
{
    if (unit == "nm") return 1e-9;
    if (unit == "um" || unit == "micron" || unit == "microns") return 1e-6;
    if (unit == "mm") return 1e-3;
    return unit == "m" ? 1.0 : 0.0;
}

// "(1,0,0) (0,1,0) (0,0,2)": the length of each vector; "1 1 2": as it is.
std::array<double, 3> steps(std::string text)
{
    const bool vectors = text.find('(') != std::string::npos;
    for (char& c : text)
        if (c == ',' || c == '(' || c == ')') c = ' ';
    std::istringstream in(text);
    std::array<double, 3> step{};
    for (double& s : step) {
        double sum = 0.0, v = 0.0;
        for (int i = 0; i < (vectors ? 3 : 1); ++i) sum += in >> v ? v * v : 0.0;
        s = std::sqrt(sum);
    }
    return in && std::isfinite(step[0] + step[1] + step[2]) ? step : std::array<double, 3>{};
}

Vec3 voxel_size_of(const Fields& fields)
{
    const auto get = [&](const char* key) { return fields.contains(key) ? fields.at(key) : std::string(); };
    std::string units = get("space units").empty() ? get("units") : get("space units");
    const std::string text = get("space directions").empty() ? get("spacings") : get("space directions");
    for (char& c : units)
        if (c == '"') c = ' ';
    std::istringstream in(units);
    std::string unit;
    in >> unit;
    const auto step = steps(text);
    const double metre = metres(unit);
    return {step[0] * metre, step[1] * metre, step[2] * metre};
}

}  // namespace

ReaderPtr open_nrrd(const fs::path& file)
{
    std::int64_t length = 0;
    const Fields fields = read_fields(file, length);
    const auto need = [&](const std::string& key) -> const std::string& {
        const auto found = fields.find(key);
        if (found == fields.end()) refuse(file, fmt::format("the field \"{}\" is missing", key));
        return found->second;
    };
    VolumeInfo info;
    info.sample = sample_of_type(file, need("type"));
    if (need("dimension") != "3") refuse(file, fmt::format("needed dimension 3, got {}", need("dimension")));
    std::istringstream sizes(need("sizes"));
    if (!(sizes >> info.shape.nx >> info.shape.ny >> info.shape.nz))
        refuse(file, fmt::format("sizes: needed three numbers, got \"{}\"", need("sizes")));
    check_shape(file, info.shape);
    if (need("encoding") != "raw")
        refuse(file, fmt::format("encoding {} is not read; save it with encoding raw", need("encoding")));
    info.voxel_size = voxel_size_of(fields);
    const bool big = fields.contains("endian") && fields.at("endian") == "big";
    const std::string data = fields.contains("data file")  ? fields.at("data file")
                             : fields.contains("datafile") ? fields.at("datafile")
                                                           : "";
    if (fields.contains("line skip") && fields.at("line skip") != "0") refuse(file, "\"line skip\" is not read");
    const fs::path values = data.empty() ? file : file.parent_path() / data;
    if (!fs::exists(values)) refuse(file, fmt::format("its data file {} does not exist", values.string()));
    std::int64_t skip = data.empty() ? length : 0;
    if (fields.contains("byte skip")) {
        std::int64_t bytes = 0;
        if (!(std::istringstream(fields.at("byte skip")) >> bytes) || bytes < -1)
            refuse(file, fmt::format("byte skip: needed a number, got \"{}\"", fields.at("byte skip")));
        const auto size = static_cast<std::int64_t>(fs::file_size(values));
        skip = bytes < 0 ? std::max<std::int64_t>(0, size - info.slice_bytes() * info.shape.nz) : skip + bytes;
    }
    return read_plain(file, values, info, skip, big);
}

WriterPtr create_nrrd(const fs::path& file, const VolumeInfo& info)
{
    constexpr std::array names{"uint8", "uint16", "float"};
    const Vec3& h = info.voxel_size;
    std::string header =
        fmt::format("NRRD0004\ntype: {}\ndimension: 3\nsizes: {} {} {}\nendian: little\nencoding: raw\n",
                    names[static_cast<std::size_t>(info.sample)], info.shape.nx, info.shape.ny, info.shape.nz);
    if (h.x > 0.0)
        header += fmt::format("spacings: {} {} {}\nunits: \"um\" \"um\" \"um\"\n", h.x * 1e6, h.y * 1e6, h.z * 1e6);
    return std::make_unique<PlainWriter>(file, info, file, header + "\n", true);
}

}  // namespace craze::io
