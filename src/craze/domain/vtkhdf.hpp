// Domains as VTKHDF files: opened by ParaView as they are, read back without loss.
//
// An unstructured grid (version 1.0): points are centres with `radius`, cells are bonds as lines with `kind` and
// `thickness`. Near pairs, box and the rest stand in the group /craze, which ParaView passes over.

#pragma once

#include "craze/domain/discretisation.hpp"

#include <filesystem>

namespace craze::domain {

void write_vtkhdf(const Domain& domain, const std::filesystem::path& file);
/// @throws InvalidInput  when the file is missing, damaged, not made by craze, or its bonds make no sense
Domain read_vtkhdf(const std::filesystem::path& file);

/// The same with `in_pore` for points and `cut`, `T1`, `T2` for cells.
void write_vtkhdf(const Discretisation& discretisation, const std::filesystem::path& file);
/// @throws InvalidInput  as read_vtkhdf, and when the file holds a domain alone or a thickness is not in [0, L_0]
Discretisation read_discretisation_vtkhdf(const std::filesystem::path& file);
/// Only what the second adds, put into `d`, whose `dense` is the file's; false, and nothing done, where it is not
/// there.
bool read_defects_vtkhdf(const std::filesystem::path& file, Discretisation& d);

}  // namespace craze::domain
