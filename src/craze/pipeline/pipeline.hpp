// The whole chain: in which order, from which settings, what can be skipped.

#pragma once

#include "craze/pipeline/settings.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace craze::pipeline {

/// The rooms in their order, each with the question it answers.
const std::vector<std::pair<std::string, std::string>>& rooms();

struct RunOptions {
    std::filesystem::path settings_file;  ///< for the record in run.json
    std::filesystem::path out;
    std::vector<std::string> overrides;  ///< for the record
    bool resume = false;
    bool sweep = false;  ///< microstructure: also try many R_C and R_E and propose some [2.4.3]
};

/// Runs all rooms and writes `<out>/run.json`. Returns the headline for the terminal.
/// @throws InvalidInput, ComputationFailed, Interrupted  finished rooms stay on disk
std::string run(const Settings& settings, const RunOptions& options);

/// Runs one room from what earlier ones left in `out`.
void run_room(const std::string& room, const Settings& settings, const RunOptions& options);

/// A commented settings file with every key at its default.
std::string default_settings_text();

/// The manual of all keys, Markdown.
std::string settings_reference();

}  // namespace craze::pipeline
