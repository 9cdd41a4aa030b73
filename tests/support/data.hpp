// Where tests find the optional real data: beside the checkout in ../shared/data, or where CRAZE_DATA says.

#pragma once

#include <cstdlib>
#include <filesystem>

namespace craze::support {

inline std::filesystem::path data_folder()
{
    if (const char* set = std::getenv("CRAZE_DATA")) return set;
    return std::filesystem::path(CRAZE_SOURCE_DIR).parent_path() / "shared" / "data";
}

}  // namespace craze::support

/// Skips the test, saying so, where the data is not there.
#define CRAZE_NEEDS_DATA(path) \
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "data not found: " << (path).string()
