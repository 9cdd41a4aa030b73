// Writes a small output folder and its report: report_sample FOLDER. Every room's own code makes its part, at a size
// that takes seconds.

#include "craze/core/json.hpp"
#include "craze/domain/room.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/loading/loading.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/microstructure/analysis.hpp"
#include "craze/report/report.hpp"
#include "craze/synth/synth.hpp"

#include <cstdio>
#include <filesystem>

using namespace craze;
namespace fs = std::filesystem;

namespace {

void write_summary(const fs::path& folder, const Json& json) { io::write_text(folder / "summary.json", json.dump(2)); }

void make(const fs::path& out)
{
    fs::remove_all(out);
    synth::Settings recipe;
    recipe.microscope.noise = 4.0;
    recipe.shape = {120, 110, 100};
    recipe.voxel_size = 50e-9;
    const auto coating = synth::make_coating(recipe);
    const auto seen = synth::observe(coating, recipe);
    synth::save(coating, seen, recipe, out / "synth");
    write_summary(out / "synth", synth::summary(coating, seen, recipe));

    fs::create_directories(out / "images");
    io::write_volume(out / "images" / "gray.mhd", seen.stack.level, recipe.voxel_size);
    write_summary(out / "images", {{"voxel_size_m", recipe.voxel_size},
                                   {"notices", {"The sample is shown as recorded, without cleaning."}}});

    microstructure::Settings how;
    how.R_C = 4.5, how.R_E = 2.5;
    const auto micro = microstructure::classify({seen.stack.level.copy(), recipe.voxel_size}, how);
    const auto analysis = microstructure::analyse(micro, how);
    fs::create_directories(out / "microstructure");
    microstructure::save(micro, out / "microstructure");
    microstructure::save(analysis, micro, out / "microstructure");
    write_summary(out / "microstructure", microstructure::summary(micro, analysis));

    const auto surface = mesh::mesh_cracks(micro.crack, recipe.voxel_size, {});
    fs::create_directories(out / "mesh");
    const auto measures = mesh::measure(surface, micro.crack, recipe.voxel_size);
    mesh::save(surface, measures, {}, out / "mesh");
    write_summary(out / "mesh", mesh::summary(surface, measures));

    const domain::Settings packed;
    const auto cut = domain::discretise(micro, surface, how.R_C, packed);
    fs::create_directories(out / "domain");
    domain::save(cut, packed, out / "domain");
    write_summary(out / "domain", domain::summary(cut));

    loading::Settings tests;
    tests.beam.calibrate = false;
    tests.uniaxial.points = 4, tests.uniaxial.axes = "xz";
    tests.triaxial.points = 5;
    const auto response = loading::load(cut, tests);
    fs::create_directories(out / "loading");
    loading::save(response, out / "loading");
    write_summary(out / "loading", loading::summary(response));
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: report_sample FOLDER\n");
        return 2;
    }
    try {
        make(argv[1]);
        report::Settings settings;
        settings.slices = 6, settings.render_width = 600;
        std::printf("%s\n", report::write_report(argv[1], settings).c_str());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
