// The settings file of `craze reproduce` and `craze fit-coating`: a recipe, and what is done with it.

#pragma once

#include "craze/pipeline/settings_file.hpp"
#include "craze/reproduce/reproduce.hpp"

namespace craze::reproduce {

struct AllSettings {
    synth::Settings synth = recipe();  ///< its shape is set by the size of what is done with it
    Settings reproduce;
    FitSettings fit;
};
void describe(Schema& schema, AllSettings& settings);

/// Reads and checks; nothing has been worked on when it throws.
/// @throws InvalidInput
AllSettings read(const pipeline::SettingsSource& source);

/// The manual of [reproduce] and [fit], Markdown, to stand below that of a run.
std::string settings_reference();

}  // namespace craze::reproduce
