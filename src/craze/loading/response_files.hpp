// How results lie on disk.

#pragma once

#include "craze/loading/response.hpp"

#include <filesystem>
#include <string>

namespace craze::loading {

/// A loading's name as a file name: letters, digits, '.', '-', '+'; all else becomes '_'.
std::string file_name(const std::string& loading);

/// One curve, every bit.
void write_curve(const Curve& curve, const std::filesystem::path& file);
/// @throws InvalidInput  when the file is damaged
Curve read_curve(const std::filesystem::path& file);

}  // namespace craze::loading
