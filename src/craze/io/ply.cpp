#include "craze/core/errors.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/binary_file.hpp"
#include "craze/io/triangles.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace craze::io {

namespace {

// ---- writing

const char* ply_type(const TriangleField& field)
{
    constexpr const char* names[] = {"uchar", "int", "float"};
    return names[field.values.index()];
}

std::string header_of(const TriangleView& mesh)
{
    std::string text = "ply\nformat binary_little_endian 1.0\ncomment craze\n";
    text += fmt::format("element vertex {}\n", mesh.vertices.size());
    text += "property double x\nproperty double y\nproperty double z\n";
    text += fmt::format("element face {}\n", mesh.triangles.size());
    text += "property list uchar int vertex_indices\n";
    for (const TriangleField& field : mesh.fields) text += fmt::format("property {} {}\n", ply_type(field), field.name);
    return text + "end_header\n";
}

// ---- reading

enum class Kind { i8, u8, i16, u16, i32, u32, f32, f64 };

std::size_t bytes_of(Kind kind)
{
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(kind)];
}

std::optional<Kind> kind_named(const std::string& name)
{
    constexpr const char* names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                        {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                        {"float", "float32"}, {"double", "float64"}};
    for (int k = 0; k < 8; ++k)
        if (name == names[k][0] || name == names[k][1]) return static_cast<Kind>(k);
    return std::nullopt;
}

struct Property {
    std::string name;
    Kind kind{};
    std::optional<Kind> count;  // of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

class Reader {
public:
    Reader(const std::filesystem::path& file, const std::string& tag) : file_(file.string()), tag_(tag)
    {
        in_.open(file, std::ios::binary);
        if (!in_ || std::filesystem::is_directory(file)) fail("cannot be read");
        size_ = std::filesystem::file_size(file);
    }

    TriangleMesh read()
    {
        TriangleMesh mesh;
        for (const Element& element : header()) {
            // Each item has at least a byte per property: a count beyond that is a damaged header.
            if (element.count * std::max<std::size_t>(element.properties.size(), 1) > size_)
                fail(fmt::format("says it has {} of element {}, more than the file can hold", element.count,
                                 element.name));
            if (element.name == "vertex")
                vertices(element, mesh);
            else if (element.name == "face")
                faces(element, mesh);
            else
                for (std::uint64_t i = 0; i < element.count; ++i)
                    for (const Property& p : element.properties) skip(p);
        }
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (const std::int32_t v : mesh.triangles[t])
                if (!(v >= 0 && static_cast<std::size_t>(v) < mesh.vertices.size()))
                    fail(fmt::format("triangle {} names vertex {}; there are {}", t, v, mesh.vertices.size()));
        return mesh;
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw InvalidInput(fmt::format("{}: {}", file_, what)); }

    std::string line()
    {
        std::string text;
        if (!std::getline(in_, text) || text.size() > 10'000) fail("is not a PLY file, or its header is damaged");
        if (!text.empty() && text.back() == '\r') text.pop_back();
        return text;
    }

    std::vector<Element> header()
    {
        if (line() != "ply") fail("is not a PLY file");
        std::vector<Element> elements;
        bool encoding = false;
        while (true) {
            std::istringstream words(line());
            std::string key;
            words >> key;
            if (key == "end_header") break;
            if (key == "format") {
                std::string name;
                words >> name;
                if (name != "binary_little_endian")
                    fail(fmt::format("is a PLY of format {}; needs binary_little_endian: export it as binary", name));
                encoding = true;
            } else if (key == "element") {
                Element element;
                words >> element.name >> element.count;
                if (!words) fail("has an element without a count in its header");
                elements.push_back(element);
            } else if (key == "property") {
                if (elements.empty()) fail("has a property before any element in its header");
                elements.back().properties.push_back(property(words));
            }
        }
        if (!encoding) fail("says no format in its header");
        return elements;
    }

    Property property(std::istringstream& words) const
    {
        Property p;
        std::string type;
        words >> type;
        if (type == "list") {
            std::string count;
            words >> count >> type;
            p.count = kind_named(count);
            if (!p.count) fail(fmt::format("has a list counted in \"{}\", which is no type of PLY", count));
        }
        words >> p.name;
        const auto kind = kind_named(type);
        if (!kind || p.name.empty()) fail(fmt::format("has a property of type \"{}\", which is no type of PLY", type));
        p.kind = *kind;
        return p;
    }

    double number(Kind kind)
    {
        char raw[8];
        if (!in_.read(raw, static_cast<std::streamsize>(bytes_of(kind)))) fail("ends too early; was it cut short?");
        const auto as = [&]<class T>(T value) {
            std::memcpy(&value, raw, sizeof value);
            return static_cast<double>(value);
        };
        switch (kind) {
            case Kind::i8: return as(std::int8_t{});
            case Kind::u8: return as(std::uint8_t{});
            case Kind::i16: return as(std::int16_t{});
            case Kind::u16: return as(std::uint16_t{});
            case Kind::i32: return as(std::int32_t{});
            case Kind::u32: return as(std::uint32_t{});
            case Kind::f32: return as(float{});
            case Kind::f64: return as(double{});
        }
        return 0.0;
    }

    void skip(const Property& p)
    {
        const double items = p.count ? number(*p.count) : 1.0;
        if (!(items >= 0.0)) fail("has a list of negative length");
        for (double i = 0; i < items; ++i) number(p.kind);
    }

    void vertices(const Element& element, TriangleMesh& mesh)
    {
        mesh.vertices.resize(element.count);
        for (Vec3& v : mesh.vertices)
            for (const Property& p : element.properties) {
                if (!p.count && p.name == "x")
                    v.x = number(p.kind);
                else if (!p.count && p.name == "y")
                    v.y = number(p.kind);
                else if (!p.count && p.name == "z")
                    v.z = number(p.kind);
                else
                    skip(p);
            }
    }

    void faces(const Element& element, TriangleMesh& mesh)
    {
        mesh.triangles.resize(element.count);
        for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
            bool found = false;
            for (const Property& p : element.properties) {
                if (p.count && (p.name == "vertex_indices" || p.name == "vertex_index")) {
                    if (const double corners = number(*p.count); corners != 3.0)
                        fail(fmt::format("face {} has {} corners; needs triangles", f, corners));
                    for (std::int32_t& v : mesh.triangles[f]) v = index(number(p.kind));
                    found = true;
                } else if (!p.count && !tag_.empty() && p.name == tag_ && p.kind == Kind::u8) {
                    mesh.tags.push_back(static_cast<std::uint8_t>(number(p.kind)));
                } else {
                    skip(p);
                }
            }
            if (!found) fail("has faces without vertex_indices");
        }
    }

    static std::int32_t index(double value)
    {
        return value >= 0.0 && value <= std::numeric_limits<std::int32_t>::max() ? static_cast<std::int32_t>(value)
                                                                                 : -1;
    }

    std::string file_, tag_;
    std::ifstream in_;
    std::uintmax_t size_ = 0;
};

}  // namespace

void write_ply(const std::filesystem::path& file, const TriangleView& mesh)
{
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        BinaryFile out(temporary);
        out.text(header_of(mesh));
        for (const Vec3& v : mesh.vertices) out.put(v.x), out.put(v.y), out.put(v.z);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            out.put(std::uint8_t{3});
            out.put(mesh.triangles[t]);
            for (const TriangleField& field : mesh.fields)
                std::visit([&](const auto& values) { out.put(values[t]); }, field.values);
        }
        out.close();
    });
}

TriangleMesh read_ply(const std::filesystem::path& file, const std::string& tag) { return Reader(file, tag).read(); }

}  // namespace craze::io
