// Which virtual specimen: "dense", "pores", "cracks closed", "both", "cracks 40 nm".

#pragma once

#include "craze/domain/discretisation.hpp"

#include <string>
#include <string_view>

namespace craze::loading {

/// Defects of one specimen, written in the settings as its name: dense | pores | cracks | both, the last two followed,
/// if one wishes, by the rule for the thickness of cracks: T2 (default) | T1 | closed | a length.
/// @throws InvalidInput  quoting what was written and what would do
domain::Defects parse_specimen(std::string_view name);

/// The shortest name that parses to the same defects: "both", "cracks closed", "cracks 40 nm".
std::string specimen_name(const domain::Defects& defects);

}  // namespace craze::loading
