// One word for all that a result depends on: the settings and the files they name.

#pragma once

#include "craze/images/settings.hpp"

#include <string>

namespace craze::images {

/// Changes with any setting that changes the result, and when the source is touched.
std::string fingerprint(const Settings& settings);

}  // namespace craze::images
