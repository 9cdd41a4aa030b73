#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/synth/synth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace craze::synth {

namespace {

Json json_of(const Porosity& p) { return {{"total", p.total}, {"pores", p.pores}, {"cracks", p.cracks}}; }

std::string_view kind(const Pore& pore) { return pore.lobes.size() > 1 ? "irregular pore" : "globular pore"; }

std::string_view kind(const Crack& crack)
{
    if (crack.outline == Outline::rectangle) return "rectangular crack";
    if (crack.curvature != 0.0) return "bent crack";
    if (crack.wave_height[0] != 0.0) return "wavy crack";
    return crack.a == crack.b ? "disc crack" : "elliptic crack";
}

std::string table_of_defects(const Coating& coating)
{
    std::string csv = "kind,population,x_m,y_m,z_m,normal_x,normal_y,normal_z,a_m,b_m,c_or_aperture_m,lobes\n";
    const auto row = [&](std::string_view what, const std::string& population, const Vec3& at, const Vec3& n, double a,
                         double b, double c, std::size_t lobes) {
        csv += fmt::format("{},{},{:.6e},{:.6e},{:.6e},{:.5f},{:.5f},{:.5f},{:.6e},{:.6e},{:.6e},{}\n", what,
                           population, at.x, at.y, at.z, n.x, n.y, n.z, a, b, c, lobes);
    };
    for (const auto& pore : coating.pores) {
        const Ellipsoid& main = pore.lobes.front();
        row(kind(pore), coating.pore_names[static_cast<std::size_t>(pore.population)], main.centre, main.frame.n,
            main.semi.x, main.semi.y, main.semi.z, pore.lobes.size());
    }
    for (const auto& crack : coating.cracks)
        row(kind(crack), coating.crack_names[static_cast<std::size_t>(crack.population)], crack.centre, crack.frame.n,
            crack.a, crack.b, crack.aperture, 0);
    return csv;
}

void write_ply(const std::filesystem::path& file, const mesh::CrackSurface& sheet)
{
    io::write_atomically(file, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out << fmt::format(
            "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex {}\n"
            "property double x\nproperty double y\nproperty double z\nelement face {}\n"
            "property list uchar int vertex_indices\nend_header\n",
            sheet.vertices.size(), sheet.triangles.size());
        for (const auto& v : sheet.vertices) out.write(reinterpret_cast<const char*>(&v), 3 * sizeof(double));
        for (const auto& t : sheet.triangles) {
            out.put(3);
            out.write(reinterpret_cast<const char*>(t.data()), 3 * sizeof(std::int32_t));
        }
        if (!out.flush()) throw InvalidInput(fmt::format("cannot write {}; is the disk full?", file.string()));
    });
}

}  // namespace

Json summary(const Coating& coating, const Observation& observation, const Settings& settings)
{
    const Vec3& size = coating.size;
    double cubes = 0.0;
    for (const auto& crack : coating.cracks) {
        const Vec3& c = crack.centre;
        const bool in = c.x >= 0 && c.x <= size.x && c.y >= 0 && c.y <= size.y && c.z >= 0 && c.z <= size.z;
        if (in) cubes += std::pow(crack.a * crack.b, 1.5);
    }
    Json populations = Json::array();
    for (std::size_t p = 0; p < coating.pore_names.size(); ++p)
        populations.push_back(
            {{"name", coating.pore_names[p]},
             {"defects", std::count_if(coating.pores.begin(), coating.pores.end(), [&](const Pore& pore) {
                  return pore.population == static_cast<std::int32_t>(p);
              })}});
    for (std::size_t p = 0; p < coating.crack_names.size(); ++p)
        populations.push_back(
            {{"name", coating.crack_names[p]},
             {"defects", std::count_if(coating.cracks.begin(), coating.cracks.end(), [&](const Crack& crack) {
                  return crack.population == static_cast<std::int32_t>(p);
              })}});
    return {{"shape", settings.shape},
            {"voxel_size_m", settings.voxel_size},
            {"seed", settings.seed},
            {"pores", coating.pores.size()},
            {"cracks", coating.cracks.size()},
            {"populations", populations},
            {"crack_density", cubes / (size.x * size.y * size.z)},
            {"true_porosity", json_of(observation.fraction)},
            {"true_porosity_voxels", json_of(observation.voxels)}};
}

void save(const Coating& coating, const Observation& observation, const Settings& settings,
          const std::filesystem::path& folder)
{
    std::filesystem::create_directories(folder);
    const double h = settings.voxel_size;
    io::write_volume(folder / "stack.tif", observation.stack.level, h);
    io::write_volume(folder / "truth.mhd", observation.label, h);
    io::write_text(folder / "defects.csv", table_of_defects(coating));
    write_ply(folder / "cracks.ply", crack_surface(coating, 4.0 * h));
    Json truth = summary(coating, observation, settings);
    truth["labels"] = {{"matter", 255}, {"pore", 0}, {"crack", 128}};
    Json positions = Json::array();
    for (const auto& p : observation.positions) positions.push_back({p.x, p.y, p.z});
    truth["slice_positions_voxels"] = positions;
    io::write_text(folder / "truth.json", truth.dump(1) + "\n");
}

}  // namespace craze::synth
