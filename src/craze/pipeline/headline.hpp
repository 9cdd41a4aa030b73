// The few numbers a user wants to see when a run ends.

#pragma once

#include <filesystem>
#include <string>

namespace craze::pipeline {

/// A text for the terminal from the summaries in `out`; rooms that left none are left out.
std::string headline(const std::filesystem::path& out);

}  // namespace craze::pipeline
