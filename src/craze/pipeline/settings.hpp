// All settings of a run: one struct, one section of the file per room.

#pragma once

#include "craze/domain/room.hpp"
#include "craze/images/images.hpp"
#include "craze/loading/loading.hpp"
#include "craze/mesh/measures.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/microstructure/analysis.hpp"
#include "craze/microstructure/sweep.hpp"
#include "craze/pipeline/settings_file.hpp"
#include "craze/report/report.hpp"
#include "craze/synth/synth.hpp"

namespace craze::pipeline {

struct Settings {
    synth::Settings synth;
    images::Settings images;  ///< an empty source means the stack that synth makes
    microstructure::Settings microstructure;
    mesh::Settings mesh;
    domain::Settings domain;
    loading::Settings loading;
    report::Settings report;

    /// A packing made elsewhere goes through loading and report by itself.
    bool without_images() const { return domain.import_from.alone; }
    bool synthetic() const { return !without_images() && images.source.empty(); }
};

void describe(Schema& schema, Settings& settings);

/// What no single range can say, over all rooms; input files must exist.
/// @throws InvalidInput
void check(const Settings& settings);

/// Reads and checks; nothing has been worked on when it throws.
/// @throws InvalidInput
Settings read(const SettingsSource& source);

}  // namespace craze::pipeline
