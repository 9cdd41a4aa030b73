// What the page says of each room.

#pragma once

#include "craze/report/output_folder.hpp"
#include "craze/report/page.hpp"
#include "craze/report/report.hpp"

namespace craze::report {

/// All that a section reads from and writes to.
struct Work {
    const OutputFolder& folder;
    const Settings& settings;
    bool paper;  ///< whether the paper's numbers stand beside ours
    Page& page;
};

void write_overview(Work& work);
void write_synth(Work& work);
void write_images(Work& work);
void write_microstructure(Work& work);
void write_mesh(Work& work);
void write_domain(Work& work);
void write_loading(Work& work);
void write_record(Work& work);

}  // namespace craze::report
