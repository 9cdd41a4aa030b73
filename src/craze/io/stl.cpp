#include "craze/core/errors.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/binary_file.hpp"
#include "craze/io/triangles.hpp"

#include <limits>

namespace craze::io {

namespace {

void put_vector(BinaryFile& out, const Vec3& v)
{
    out.put(static_cast<float>(v.x)), out.put(static_cast<float>(v.y)), out.put(static_cast<float>(v.z));
}

}  // namespace

void write_stl(const std::filesystem::path& file, const TriangleView& mesh)
{
    if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
        throw InvalidInput(fmt::format("{}: STL counts triangles with 32 bits; use PLY or VTP", file.string()));
    write_atomically(file, [&](const std::filesystem::path& temporary) {
        BinaryFile out(temporary);
        std::string title = "binary STL by craze";  // must not begin with "solid"
        title.resize(80, ' ');
        out.text(title);
        out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
        for (const Corners& t : mesh.triangles) {
            const auto corner = [&](int k) {
                return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
            };
            const Vec3 a = corner(0), b = corner(1), c = corner(2);
            const Vec3 n = cross(b - a, c - a);
            const double size = norm(n);
            put_vector(out, size > 0.0 ? n / size : Vec3{});
            for (const Vec3& v : {a, b, c}) put_vector(out, v);
            out.put(std::uint16_t{0});
        }
        out.close();
    });
}

}  // namespace craze::io
