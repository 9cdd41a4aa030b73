#include "craze/loading/material_library.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/hash.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/loading/response_json.hpp"
#include "craze/loading/shipped_materials.hpp"

#include <fmt/format.h>

namespace craze::loading {
namespace {

Json open_library(const std::filesystem::path& file)
{
    if (file.empty() || !std::filesystem::exists(file)) return Json::object();
    try {
        Json library = Json::parse(io::read_text(file));
        if (!library.is_object())
            throw InvalidInput(fmt::format("{}: needed a JSON object with \"materials\"", file.string()));
        return library;
    } catch (const Json::exception& error) {
        throw InvalidInput(fmt::format("{}: not a material library: {}", file.string(), error.what()));
    }
}

}  // namespace

mechanics::DenseMaterial find_material(const std::string& name, const std::filesystem::path& file)
{
    std::vector<std::string> names;
    for (const Json& library : {open_library(file), Json::parse(shipped_materials)}) {
        if (!library.contains("materials")) continue;
        for (const auto& [key, m] : library.at("materials").items()) {
            names.push_back(key);
            if (key != name) continue;
            try {
                return {m.at("young_modulus").get<double>(), m.at("poisson_ratio").get<double>(),
                        m.at("density").get<double>()};
            } catch (const Json::exception& error) {
                throw InvalidInput(
                    fmt::format("{}: material \"{}\" needs the numbers young_modulus (Pa), poisson_ratio and "
                                "density (kg/m3): {}",
                                file.string(), name, error.what()));
            }
        }
    }
    throw InvalidInput(
        fmt::format("loading.dense.material: no \"{}\" in the library; there is {}; or give young_modulus, "
                    "poisson_ratio and density yourself",
                    name, fmt::join(names, ", ")));
}

std::string calibration_recipe(const domain::Domain& dense, const mechanics::DenseMaterial& target, double nu_B,
                               const RigOptions& rig)
{
    const std::vector<double> numbers{dense.box.x, dense.box.y, dense.box.z,    dense.mean_radius,  target.E_D,
                                      target.nu_D, nu_B,        rig.face_reach, rig.interior_margin};
    const auto all = [](const auto& v) { return std::span(v.data(), v.size()); };
    Hash hash;
    hash.add("calibration 1").add(std::span<const double>(numbers));
    hash.add(all(dense.elements.x)).add(all(dense.elements.y)).add(all(dense.elements.z)).add(all(dense.elements.r));
    hash.add(all(dense.bonds.i)).add(all(dense.bonds.j)).add(all(dense.near.i)).add(all(dense.near.j));
    return hash.digest();
}

std::optional<Calibration> find_calibration(const std::string& recipe, double tolerance,
                                            const std::filesystem::path& file)
{
    const Json library = open_library(file);
    if (!library.contains("calibrations") || !library.at("calibrations").contains(recipe)) return {};
    Calibration kept;
    try {
        read_json(library.at("calibrations").at(recipe), kept);
    } catch (const Json::exception& error) {
        throw InvalidInput(fmt::format("{}: calibration {} is damaged ({}); delete it to calibrate anew", file.string(),
                                       recipe, error.what()));
    }
    if (!(kept.error <= tolerance)) return {};
    kept.from_library = true;
    return kept;
}

void keep_calibration(const Calibration& calibration, const std::filesystem::path& file)
{
    Json library = open_library(file);
    if (!library.contains("materials")) library["materials"] = Json::object();
    library["calibrations"][calibration.recipe] = as_json(calibration);
    io::write_text(file, library.dump(2) + "\n");
}

}  // namespace craze::loading
