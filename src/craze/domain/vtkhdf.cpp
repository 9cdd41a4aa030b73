#include "craze/domain/vtkhdf.hpp"

#include "craze/core/errors.hpp"
#include "craze/domain/validity.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/hdf5_file.hpp"

#include <fmt/format.h>

#include <array>

namespace craze::domain {

namespace fs = std::filesystem;
using io::Hdf5File;

namespace {

constexpr std::uint8_t vtk_line = 3;

void put(Hdf5File& out, const Domain& d)
{
    out.attribute("/VTKHDF", "Version", std::array<std::int64_t, 2>{1, 0});
    out.attribute("/VTKHDF", "Type", "UnstructuredGrid");
    const std::size_t points = d.elements.r.size(), cells = d.bonds.i.size();

    std::vector<double> xyz(3 * points);
    for (std::size_t e = 0; e < points; ++e) {
        xyz[3 * e] = d.elements.x[e];
        xyz[3 * e + 1] = d.elements.y[e];
        xyz[3 * e + 2] = d.elements.z[e];
    }
    std::vector<std::int64_t> ends(2 * cells), offsets(cells + 1);
    std::vector<std::uint8_t> kind(cells);
    for (std::size_t b = 0; b < cells; ++b) {
        ends[2 * b] = d.bonds.i[b];
        ends[2 * b + 1] = d.bonds.j[b];
        offsets[b + 1] = static_cast<std::int64_t>(2 * (b + 1));
        kind[b] = static_cast<std::uint8_t>(d.bonds.kind[b]);
    }
    const auto one = [](std::size_t n) { return std::vector<std::int64_t>{static_cast<std::int64_t>(n)}; };
    out.write("/VTKHDF/NumberOfPoints", one(points));
    out.write("/VTKHDF/NumberOfCells", one(cells));
    out.write("/VTKHDF/NumberOfConnectivityIds", one(ends.size()));
    out.write("/VTKHDF/Points", xyz, 3);
    out.write("/VTKHDF/Connectivity", ends);
    out.write("/VTKHDF/Offsets", offsets);
    out.write("/VTKHDF/Types", std::vector<std::uint8_t>(cells, vtk_line));
    out.write("/VTKHDF/PointData/radius", d.elements.r);
    out.write("/VTKHDF/CellData/kind", kind);
    out.write("/VTKHDF/CellData/thickness", d.bonds.thickness);
    out.write("/craze/near/i", d.near.i);
    out.write("/craze/near/j", d.near.j);
    out.write("/craze/near/thickness", d.near.thickness);
    out.write("/craze/box", std::vector{d.box.x, d.box.y, d.box.z});
    out.write("/craze/mean_radius", std::vector{d.mean_radius});
    out.write("/craze/dense_volume", std::vector{d.dense_volume});
}

[[noreturn]] void refuse(const fs::path& file, const std::string& why)
{
    throw InvalidInput(fmt::format("{}: {}; was it written by craze?", file.string(), why));
}

template <class T>
std::vector<T> array(const Hdf5File& in, const fs::path& file, const std::string& name, std::size_t size)
{
    std::vector<T> values = in.read<T>(name);
    if (values.size() != size) refuse(file, fmt::format("\"{}\" needs {} values, has {}", name, size, values.size()));
    return values;
}

Domain get(const Hdf5File& in, const fs::path& file)
{
    if (in.text_attribute("/VTKHDF", "Type") != "UnstructuredGrid") refuse(file, "is no VTKHDF unstructured grid");
    Domain d;
    const auto box = array<double>(in, file, "/craze/box", 3);
    d.box = {box[0], box[1], box[2]};
    d.mean_radius = array<double>(in, file, "/craze/mean_radius", 1)[0];
    d.dense_volume = array<double>(in, file, "/craze/dense_volume", 1)[0];

    d.elements.r = in.read<double>("/VTKHDF/PointData/radius");
    const std::size_t points = d.elements.r.size();
    const auto xyz = array<double>(in, file, "/VTKHDF/Points", 3 * points);
    for (std::size_t e = 0; e < points; ++e) {
        d.elements.x.push_back(xyz[3 * e]);
        d.elements.y.push_back(xyz[3 * e + 1]);
        d.elements.z.push_back(xyz[3 * e + 2]);
    }
    const auto kind = in.read<std::uint8_t>("/VTKHDF/CellData/kind");
    const std::size_t cells = kind.size();
    const auto ends = array<std::int64_t>(in, file, "/VTKHDF/Connectivity", 2 * cells);
    for (std::size_t b = 0; b < cells; ++b) {
        for (const std::int64_t e : {ends[2 * b], ends[2 * b + 1]})
            if (e < 0 || e >= static_cast<std::int64_t>(points))
                refuse(file, fmt::format("bond {} names element {}; there are 0 to {}", b, e,
                                         static_cast<std::int64_t>(points) - 1));
        if (kind[b] > 1) refuse(file, fmt::format("bond {} has the unknown kind {}", b, kind[b]));
        d.bonds.i.push_back(static_cast<std::int32_t>(ends[2 * b]));
        d.bonds.j.push_back(static_cast<std::int32_t>(ends[2 * b + 1]));
        d.bonds.kind.push_back(static_cast<BondKind>(kind[b]));
    }
    d.bonds.thickness = array<double>(in, file, "/VTKHDF/CellData/thickness", cells);
    d.near.i = in.read<std::int32_t>("/craze/near/i");
    d.near.j = array<std::int32_t>(in, file, "/craze/near/j", d.near.i.size());
    d.near.thickness = array<double>(in, file, "/craze/near/thickness", d.near.i.size());
    check_domain(
        d, [&](Part part, std::size_t index) { return fmt::format("{}: {} {}", file.string(), name_of(part), index); });
    return d;
}

}  // namespace

void write_vtkhdf(const Domain& domain, const fs::path& file)
{
    io::write_atomically(file, [&](const fs::path& temporary) {
        Hdf5File out = Hdf5File::create(temporary);
        put(out, domain);
    });
}

Domain read_vtkhdf(const fs::path& file) { return get(Hdf5File::open(file), file); }

void write_vtkhdf(const Discretisation& d, const fs::path& file)
{
    io::write_atomically(file, [&](const fs::path& temporary) {
        Hdf5File out = Hdf5File::create(temporary);
        put(out, d.dense);
        out.write("/VTKHDF/PointData/in_pore", d.in_pore);
        out.write("/VTKHDF/CellData/cut", d.bonds.cut);
        out.write("/VTKHDF/CellData/T1", d.bonds.T1);
        out.write("/VTKHDF/CellData/T2", d.bonds.T2);
        out.write("/craze/near/cut", d.near.cut);
        out.write("/craze/near/T1", d.near.T1);
        out.write("/craze/near/T2", d.near.T2);
        out.write("/craze/p_vx", std::vector{d.p_vx});
    });
}

Discretisation read_discretisation_vtkhdf(const fs::path& file)
{
    Discretisation d;
    d.dense = read_vtkhdf(file);
    if (!read_defects_vtkhdf(file, d)) refuse(file, "has no pores and cracks");
    return d;
}

bool read_defects_vtkhdf(const fs::path& file, Discretisation& d)
{
    const Hdf5File in = Hdf5File::open(file);
    if (!in.has("/VTKHDF/PointData/in_pore")) return false;
    const std::size_t bonds = d.dense.bonds.i.size(), near = d.dense.near.i.size();
    d.in_pore = array<std::uint8_t>(in, file, "/VTKHDF/PointData/in_pore", d.dense.elements.r.size());
    d.bonds = {array<std::uint8_t>(in, file, "/VTKHDF/CellData/cut", bonds),
               array<double>(in, file, "/VTKHDF/CellData/T1", bonds),
               array<double>(in, file, "/VTKHDF/CellData/T2", bonds)};
    d.near = {array<std::uint8_t>(in, file, "/craze/near/cut", near), array<double>(in, file, "/craze/near/T1", near),
              array<double>(in, file, "/craze/near/T2", near)};
    d.p_vx = array<double>(in, file, "/craze/p_vx", 1)[0];
    const auto check = [&](const PairCracks& cracks, const auto& pairs, const char* what) {
        for (std::size_t p = 0; p < cracks.cut.size(); ++p) {
            const double L_0 = norm(d.dense.elements.centre(pairs.j[p]) - d.dense.elements.centre(pairs.i[p]));
            for (const double T : {cracks.T1[p], cracks.T2[p]})
                if (!(T >= 0.0 && T <= L_0))
                    refuse(file, fmt::format("{} {} needs a crack thickness from 0 to L_0 = {:.4g} m, got {} m", what,
                                             p, L_0, T));
        }
    };
    check(d.bonds, d.dense.bonds, "bond");
    check(d.near, d.dense.near, "near pair");
    return true;
}

}  // namespace craze::domain
