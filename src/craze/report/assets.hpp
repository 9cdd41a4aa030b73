// Style and script of the page, carried by the library (sources in web/).

#pragma once

#include <string_view>

namespace craze::report {

std::string_view page_style();
/// Empty where craze was built without Node.js: the page then shows its drawings as they are.
std::string_view page_script();

}  // namespace craze::report
