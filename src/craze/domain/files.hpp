// Domains to and from the files of others.
//
// | format | files | read by |
// |---|---|---|
// | csv | elements.csv: x, y, z, r; bonds.csv: i, j, kind, T; near.csv: i, j, T | anything |
// | lammps | domain.data: atoms of style bpm/sphere, bonds of type 1 (beam) or 2 (contact beam) | read_data, units si |
// | lammps_hybrid | domain.data: the same for atom_style hybrid bond sphere, which older releases have | read_data |
// | yade | spheres.txt: x y z r; bonds.txt: i j kind T | ymport.text |
// | listing | "N M", N lines x y z r, M lines i j | (read only) |
// | vtkhdf | domain.vtkhdf | ParaView |
//
// Text files may be gzipped. Indices count from 0, in LAMMPS from 1. Lengths are metres in what craze writes. Numbers
// are written so that they read back to the same bits. Near pairs travel in near.csv beside every text format.

#pragma once

#include "craze/domain/domain.hpp"
#include "craze/domain/pairs.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace craze::domain {

/// The formats that can be written, in the order of the table.
const std::vector<std::string>& written_formats();

/// Writes the domain into `folder` under the names of the table.
/// @param density  rho_D of the dense ceramic, kg/m3, for the formats that ask for one; the elements get
///                 rho_D box / dense_volume, so that they weigh what the ceramic does
/// @throws InvalidInput  when the format is unknown or the folder cannot be written
void write_domain(const Domain& domain, const std::string& format, const std::filesystem::path& folder,
                  double density = 6060.0);

/// Where a domain comes from.
struct Source {
    std::filesystem::path elements;     ///< the file, or the first of several
    std::filesystem::path bonds;        ///< csv, yade; empty: bonds are made, where the elements' file holds none
    std::filesystem::path near;         ///< not vtkhdf, which holds them; empty: near pairs are found
    std::string format = "auto";        ///< one of the table; auto: by ending and content
    double unit = 1.0;                  ///< m: one of the file's lengths; vtkhdf is in metres
    std::optional<Vec3> box;            ///< m; none: as the file says, else the least box that starts at 0
    std::optional<double> mean_radius;  ///< m; none: as the file says, else the mean
    Bonding bonding;                    ///< for bonds and near pairs that are not given
};

/// Reads and checks. Elements keep their order unless that is far from a Morton curve; bonds are sorted by (i, j).
/// @throws InvalidInput  naming file and line: no number, not finite, radius not positive, centre outside the box,
///                       one centre inside another element, index out of range, self bond, bond twice, T not in [0,
///                       L_0], an end before all that was announced; also when R_DE is not that of the elements
Domain read_domain(const Source& source);
/// The format of the table that `source` is in, told from the file where it says auto.
/// @throws InvalidInput  when it cannot be told
std::string format_of(const Source& source);

}  // namespace craze::domain
