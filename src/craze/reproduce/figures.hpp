// The paper's figures from our curves and states.

#pragma once

#include "craze/io/picture.hpp"
#include "craze/report/figure.hpp"
#include "craze/reproduce/reproduce.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace craze::reproduce {

/// Figs. 18, 21, 22, 23, 25 and the strengths of Table 4; those of curves that were not measured are left out.
std::vector<report::Figure> figures(const Reproduction& result);

/// A displaced specimen for print.
struct Field {
    std::string id, caption, paper;
    io::Picture picture;
};
/// Figs. 19 and 24 from the states that the loadings of the first seed left in `folder`.
std::vector<Field> fields(const std::filesystem::path& folder);

}  // namespace craze::reproduce
