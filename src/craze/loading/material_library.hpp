// Dense ceramics and calibrations kept by name and by recipe, in a JSON file that people can read and add to.

#pragma once

#include "craze/domain/domain.hpp"
#include "craze/loading/response.hpp"
#include "craze/loading/rig.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace craze::loading {

/// A material of the file, or of the library that craze ships (8YSZ).
/// @param file  may be empty, or not exist yet
/// @throws InvalidInput  when neither has it, with the names there are, or when the file is damaged
mechanics::DenseMaterial find_material(const std::string& name, const std::filesystem::path& file);

/// What a calibration depends on, in one hash: the packing and its bonds, the target, nu_B, and how E and nu are
/// measured.
std::string calibration_recipe(const domain::Domain& dense, const mechanics::DenseMaterial& target, double nu_B,
                               const RigOptions& rig);

/// The calibration kept under a recipe whose error is within `tolerance`.
std::optional<Calibration> find_calibration(const std::string& recipe, double tolerance,
                                            const std::filesystem::path& file);

/// Adds (or replaces) a calibration; the rest of the file stays. The file is made when there is none.
void keep_calibration(const Calibration& calibration, const std::filesystem::path& file);

}  // namespace craze::loading
