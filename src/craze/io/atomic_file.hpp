// Files appear whole or not at all.

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace craze::io {

/// Calls write(path of a temporary file beside `file`), then renames it to `file`; removes it if write throws.
/// @throws InvalidInput  when the folder cannot be written
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The same for text at hand.
void write_text(const std::filesystem::path& file, std::string_view text);

/// The whole of a text file.
/// @throws InvalidInput  when it cannot be read
std::string read_text(const std::filesystem::path& file);

}  // namespace craze::io
