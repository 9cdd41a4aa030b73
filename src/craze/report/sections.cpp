#include "craze/report/sections.hpp"

#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace craze::report {

namespace fs = std::filesystem;

namespace {

/// The frame that every room's section has; true if the room left something.
bool begin(Work& work, std::string_view room, std::string_view title)
{
    work.page.section(room, title);
    if (work.folder.has(room)) return true;
    work.page.remark(fmt::format(
        "The folder holds no {0}/summary.json: this room has not run (craze {0} SETTINGS.toml runs it).", room));
    return false;
}

void all_numbers(Work& work, std::string_view room)
{
    work.page.folded("All numbers of this step", summary_table(work.folder.summary(room)));
}

void plain_pictures(Work& work, std::string_view room)
{
    std::vector<fs::path> files;
    if (!fs::is_directory(work.folder.room(room))) return;
    for (const auto& entry : fs::directory_iterator(work.folder.room(room)))
        if (entry.path().extension() == ".png") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        const auto bytes = io::read_text(file);
        work.page.picture(fmt::format("{}_{}", room, file.stem().string()), bytes, file.stem().string());
    }
}

void plain(Work& work, std::string_view room, std::string_view title)
{
    if (!begin(work, room, title)) return;
    plain_pictures(work, room);
    all_numbers(work, room);
}

}  // namespace

void write_synth(Work& work)
{
    if (work.folder.has("synth")) plain(work, "synth", "Synthetic coating");
}
void write_images(Work& work) { plain(work, "images", "Images"); }
void write_microstructure(Work& work) { plain(work, "microstructure", "Pores and cracks"); }
void write_mesh(Work& work) { plain(work, "mesh", "Crack surface"); }
void write_domain(Work& work) { plain(work, "domain", "Discrete domain"); }
void write_loading(Work& work) { plain(work, "loading", "Virtual tests"); }

void write_record(Work& work)
{
    work.page.section("run", "Record of the run");
    if (work.folder.run().is_null())
        work.page.remark("The folder holds no run.json: settings, versions and times of this run are not known.");
    else
        work.page.add(summary_table(work.folder.run()));
}

}  // namespace craze::report
