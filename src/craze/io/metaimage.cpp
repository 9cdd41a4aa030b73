// MetaImage: "Key = Value" lines, the last of them ElementDataFile; lengths in millimetres.

#include "craze/io/text_lines.hpp"
#include "craze/io/volume_formats.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

constexpr double millimetre = 1e-3;

struct Header {
    VolumeInfo info;
    bool big_endian = false;
    std::string data;  // value of ElementDataFile
    std::int64_t header_size = 0;
    std::int64_t length = 0;  // of the text up to the end of the last line
};

template <class Number>
std::vector<Number> numbers(const fs::path& file, const std::string& key, const std::string& value)
{
    std::istringstream in(value);
    std::vector<Number> all;
    for (Number number{}; in >> number;) all.push_back(number);
    if (!in.eof() || all.empty()) refuse(file, fmt::format("{}: needed numbers, got \"{}\"", key, value));
    return all;
}

bool is_true(const std::string& value) { return value == "True" || value == "true" || value == "1"; }

Sample sample_of_element_type(const fs::path& file, const std::string& type)
{
    if (type == "MET_UCHAR") return Sample::u8;
    if (type == "MET_USHORT") return Sample::u16;
    if (type == "MET_FLOAT") return Sample::f32;
    refuse(file, fmt::format("ElementType: needed MET_UCHAR, MET_USHORT or MET_FLOAT, got \"{}\"", type));
}

Header read_header(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in) refuse(file, "cannot be read");
    Header header;
    std::vector<std::int64_t> size;
    std::vector<double> spacing;
    std::optional<Sample> sample;
    std::int64_t dimensions = 3;
    std::string line;
    for (int lines = 0; lines < 200 && header.data.empty(); ++lines) {
        if (!std::getline(in, line) || line.size() > 4096)
            refuse(file, "not a MetaImage header: it ends without ElementDataFile");
        header.length += static_cast<std::int64_t>(line.size()) + 1;
        const auto equals = line.find('=');
        if (equals == std::string::npos) continue;
        const std::string key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
        if (key == "NDims")
            dimensions = numbers<std::int64_t>(file, key, value).front();
        else if (key == "DimSize")
            size = numbers<std::int64_t>(file, key, value);
        else if (key == "ElementType")
            sample = sample_of_element_type(file, value);
        else if (key == "ElementSpacing" || (key == "ElementSize" && spacing.empty()))
            spacing = numbers<double>(file, key, value);
        else if (key == "ElementByteOrderMSB" || key == "BinaryDataByteOrderMSB")
            header.big_endian = is_true(value);
        else if (key == "HeaderSize")
            header.header_size = numbers<std::int64_t>(file, key, value).front();
        else if (key == "CompressedData" && is_true(value))
            refuse(file, "compressed data is not read; save it uncompressed");
        else if (key == "ElementNumberOfChannels" && value != "1")
            refuse(file, fmt::format("needed one channel, got {}", value));
        else if (key == "ElementDataFile")
            header.data = value.empty() ? "?" : value;
    }
    if (header.data.empty()) refuse(file, "not a MetaImage header: it ends without ElementDataFile");
    if (!sample) refuse(file, "ElementType is missing");
    if ((dimensions != 3 && dimensions != 2) || size.size() != static_cast<std::size_t>(dimensions))
        refuse(file, fmt::format("DimSize: needed {} numbers for NDims = {} (2 or 3), got {}", dimensions, dimensions,
                                 size.size()));
    header.info.sample = *sample;
    header.info.shape = {size[0], size[1], dimensions == 3 ? size[2] : 1};
    for (int axis = 0; axis < 3; ++axis)
        if (static_cast<std::size_t>(axis) < spacing.size() && std::isfinite(spacing[static_cast<std::size_t>(axis)]))
            header.info.voxel_size[axis] = spacing[static_cast<std::size_t>(axis)] * millimetre;
    return header;
}

}  // namespace

ReaderPtr open_metaimage(const fs::path& file)
{
    const Header header = read_header(file);
    check_shape(file, header.info.shape);
    if (header.data == "LOCAL") return read_plain(file, file, header.info, header.length, header.big_endian);
    if (header.data == "LIST" || header.data.find('%') != std::string::npos)
        refuse(file, "a list of data files is not read; give the folder of the slices");
    const fs::path data = file.parent_path() / header.data;
    if (!fs::exists(data)) refuse(file, fmt::format("its data file {} does not exist", data.string()));
    std::int64_t offset = header.header_size;
    if (offset < 0)  // -1: whatever comes before the values
        offset = static_cast<std::int64_t>(fs::file_size(data)) - header.info.slice_bytes() * header.info.shape.nz;
    if (offset < 0) offset = 0;
    return read_plain(file, data, header.info, offset, header.big_endian);
}

WriterPtr create_metaimage(const fs::path& file, const VolumeInfo& info)
{
    const bool local = file.extension() == ".mha" || file.extension() == ".MHA";
    const fs::path data = local ? file : fs::path(file).replace_extension(".raw");
    const auto mm = [&](int axis) { return info.voxel_size[axis] > 0.0 ? info.voxel_size[axis] / millimetre : 1.0; };
    std::string header =
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
        "CompressedData = False\n";
    // The corner of the first voxel is the origin of space; MetaImage names the centre of that voxel.
    header += fmt::format("Offset = {} {} {}\n", 0.5 * mm(0), 0.5 * mm(1), 0.5 * mm(2));
    if (info.voxel_size.x > 0.0) header += fmt::format("ElementSpacing = {} {} {}\n", mm(0), mm(1), mm(2));
    header += fmt::format("DimSize = {} {} {}\n", info.shape.nx, info.shape.ny, info.shape.nz);
    constexpr std::array names{"MET_UCHAR", "MET_USHORT", "MET_FLOAT"};
    header += fmt::format("ElementType = {}\nElementDataFile = {}\n", names[static_cast<std::size_t>(info.sample)],
                          local ? "LOCAL" : data.filename().string());
    return std::make_unique<PlainWriter>(file, info, data, header, local);
}

}  // namespace craze::io
