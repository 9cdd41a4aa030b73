#include "craze/core/errors.hpp"
#include "craze/domain/room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace craze::domain {

void describe(Schema& schema, Settings& s)
{
    schema.quantity("mean_radius", s.mean_radius, Dimension::length, {1e-10, 1.0},
                    "mean radius R_DE of the elements; auto: the closing radius R_C [Eq. 11]");
    schema.quantity("dispersion", s.dispersion, Dimension::fraction, {0.0, 0.9}, "spread of the radii [3.1.1]");
    schema.option("dispersion_means", s.dispersion_means, {"total_width", "each_side"},
                  "total_width: 25 % is -12.5 % to +12.5 %; each_side: -25 % to +25 %");
    schema.number("density", s.density, {0.0, 0.3}, "elements per R_DE^3 away from walls; 0: the paper's 0.152");
    schema.number("cardinality", s.cardinality, {1.0, 12.0}, "mean bonds of an element that touches no wall");
    schema.number("near_gap", s.near_gap, {0.0, 1.0}, "unbonded pairs nearer than this many R_DE may touch under load");
    schema.flag("periodic", s.periodic, "pack a box without walls: the domain is a cut through an endless packing");
    schema.integer("seed", s.seed, {0, 9.0e15}, "another seed, another packing of the same kind");
    schema.option("cut_by", s.cut_by, {"surface", "voxels"},
                  "bonds are cut by the triangles of the crack surface, or by crack voxels on their line");
    schema.option("counted", s.counted, {"crack", "all"},
                  "void that counts as crack opening in a bond: voxels of cracks, or all void [Eqs. 14, 15]");
    schema.number("r_tilde", s.r_tilde, {0.01, 1.0},
                  "radius over R_DE of the cylinder in which a bond's crack is measured [Eq. 3]");
    schema.integers("voxel_sizes", s.voxel_sizes, {2, 64},
                    "thicknesses also at these multiples of the voxel size, all made again there [Fig. 16]; []: not");
    schema.texts("write", s.write,
                 "write the porous, cracked domain too: csv, lammps, lammps_hybrid, yade, vtkhdf (folder specimen)");
    schema.group("import", "a packing made elsewhere instead of one made here", [&] {
        auto& from = s.import_from;
        schema.path("elements", from.elements, "file of x, y, z, r; empty: pack");
        schema.path("bonds", from.bonds, "file of i, j (kind, T); empty: bonds are made from the elements");
        schema.path("near", from.near, "file of i, j, T of unbonded pairs; empty: they are found");
        schema.text("format", from.format, "auto, csv, lammps, yade, listing or vtkhdf");
        schema.quantity("unit", from.unit, Dimension::length, {1e-12, 1e3}, "what one of the file's lengths is");
        schema.quantities("box", from.box, Dimension::length, {1e-10, 1e3},
                          "three edges; empty: the stack's, else the file's, else around the elements");
        schema.flag("alone", from.alone,
                    "load the packing as it is, without images: only domain, loading and report run");
    });
}

void check(const Settings& s)
{
    const auto needs = [](bool good, const char* key, const char* what, double got) {
        if (!good) throw InvalidInput(fmt::format("domain.{}: needs {}, got {}", key, what, got));
    };
    if (s.mean_radius)
        needs(*s.mean_radius > 0.0 && std::isfinite(*s.mean_radius), "mean_radius", "a positive length",
              *s.mean_radius);
    needs(s.dispersion >= 0.0 && s.dispersion <= 0.9, "dispersion", "0 to 90 %", s.dispersion);
    needs(s.density >= 0.0 && s.density <= 0.3, "density", "0 to 0.3 elements per R_DE^3", s.density);
    needs(s.cardinality >= 1.0 && s.cardinality <= 12.0, "cardinality", "1 to 12", s.cardinality);
    needs(s.near_gap >= 0.0 && s.near_gap <= 1.0, "near_gap", "0 to 1", s.near_gap);
    const auto& from = s.import_from;
    if (!from.box.empty() && from.box.size() != 3)
        throw InvalidInput(fmt::format("domain.import.box: needs three edges, got {}", from.box.size()));
    needs(from.unit > 0.0 && std::isfinite(from.unit), "import.unit", "a positive length", from.unit);
    for (const auto& [key, file] : {std::pair{"elements", from.elements}, {"bonds", from.bonds}, {"near", from.near}})
        if (!file.empty() && !std::filesystem::is_regular_file(file))
            throw InvalidInput(fmt::format("domain.import.{}: {} is not there", key, file));
    if (from.elements.empty() && !(from.bonds.empty() && from.near.empty()))
        throw InvalidInput("domain.import: bonds or near pairs need elements; set domain.import.elements");
    if (from.alone && from.elements.empty())
        throw InvalidInput("domain.import.alone: needs a packing; set domain.import.elements");
    std::vector<std::string> readable = written_formats();
    readable.insert(readable.end(), {"auto", "listing"});
    const auto known = [](const char* key, const std::string& name, const std::vector<std::string>& names) {
        if (std::ranges::find(names, name) != names.end()) return;
        const std::string nearest = nearest_name(name, names.data(), names.data() + names.size());
        throw InvalidInput(fmt::format("domain.{}: \"{}\" is unknown; there is {}{}", key, name, fmt::join(names, ", "),
                                       nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
    };
    known("import.format", from.format, readable);
    for (const std::string& format : s.write) known("write", format, written_formats());
    needs(s.r_tilde > 0.0 && s.r_tilde <= 1.0, "r_tilde", "more than 0, at most 1", s.r_tilde);
}

}  // namespace craze::domain
