// Writes a small output folder and its report: report_sample FOLDER. Every room's own code makes its part, at a size
// that takes seconds.

#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/loading/loading.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/microstructure/analysis.hpp"
#include "craze/report/domain_pictures.hpp"
#include "craze/report/report.hpp"
#include "craze/synth/short_way.hpp"
#include "craze/synth/synth.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <tuple>

using namespace craze;
namespace fs = std::filesystem;

namespace {

/// A lattice of balls with its nearest bonds: no packing is needed to fill a page.
domain::Domain lattice(const Vec3& box, int n)
{
    domain::Domain d;
    d.box = box;
    const Vec3 step{box.x / n, box.y / n, box.z / n};
    d.mean_radius = 0.5 * step.x;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                d.elements.x.push_back((x + 0.5) * step.x);
                d.elements.y.push_back((y + 0.5) * step.y);
                d.elements.z.push_back((z + 0.5) * step.z);
                d.elements.r.push_back(d.mean_radius);
                d.dense_volume += 4.18879 * d.mean_radius * d.mean_radius * d.mean_radius;
            }
    for (int e = 0; e < n * n * n; ++e)
        for (int dz = 0; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int x = e % n + dx, y = e / n % n + dy, z = e / (n * n) + dz, other = x + n * (y + n * z);
                    if (x < 0 || y < 0 || x >= n || y >= n || z >= n || other <= e ||
                        std::abs(dx) + std::abs(dy) + dz > 2)
                        continue;
                    d.bonds.i.push_back(e), d.bonds.j.push_back(other);
                }
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) pairs.emplace_back(d.bonds.i[b], d.bonds.j[b]);
    std::sort(pairs.begin(), pairs.end());
    for (std::size_t b = 0; b < pairs.size(); ++b) std::tie(d.bonds.i[b], d.bonds.j[b]) = pairs[b];
    d.bonds.kind.assign(pairs.size(), domain::BondKind::beam);
    d.bonds.thickness.assign(pairs.size(), 0.0);
    return d;
}

void write_summary(const fs::path& folder, const Json& json) { io::write_text(folder / "summary.json", json.dump(2)); }

void make(const fs::path& out)
{
    fs::remove_all(out);
    synth::Settings recipe;
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

    const Vec3 box = synth::box_of(recipe);
    const auto surface = mesh::mesh_cracks(micro.crack, recipe.voxel_size, {});
    fs::create_directories(out / "mesh");
    mesh::save(surface, out / "mesh");
    write_summary(out / "mesh", mesh::summary(surface, box.x * box.y * box.z));

    const auto cut = synth::discretise(coating, lattice(box, 12), 0.345 * 0.2e-6);
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
