// Settings as files: TOML read and checked against what the rooms describe, written with comments, listed as a manual.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/schema.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace craze::pipeline {

/// Shows every settings struct to a schema: one group per room.
using Describe = std::function<void(Schema&)>;

/// A settings file, or nothing but defaults, with --set overrides laid over it.
struct SettingsSource {
    std::filesystem::path file;          ///< empty: defaults only
    std::vector<std::string> overrides;  ///< "images.denoise.search=15"; text without quotes is taken as a string
};

/// Reads the file and fills what `describe` shows. Relative paths are taken from the file's folder (from the working
/// folder in an override).
/// @throws InvalidInput  listing every wrong line: file, line, key, what was needed, what was got, the nearest name
void read_settings(const SettingsSource& source, const Describe& describe);

/// The same from text; `name` stands for the file in messages.
void read_settings_text(std::string_view toml, std::string_view name, const std::vector<std::string>& overrides,
                        const Describe& describe);

/// A settings file with every key at its present value, its meaning, range and choices as comments.
std::string write_settings(const Describe& describe);

/// All values, SI, keys as in the file. Paths are left out when `with_paths` is false, so that equal content has an
/// equal text wherever it lies.
Json settings_json(const Describe& describe, bool with_paths = true);

/// The manual of all keys as Markdown tables.
std::string settings_manual(const Describe& describe);

}  // namespace craze::pipeline
