#include "craze/reproduce/reproduce.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/theory.hpp"
#include "craze/mesh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace {

constexpr double R_C = 8.5;  // px [2.4.3]

/// The image chain without its cleaning: a microscope with blur and partial volume, but no noise, stripes or shading.
Candidate by_images(synth::Settings recipe, std::int64_t seed, const Bench& bench, const Study& study)
{
    recipe.seed = seed;
    auto& m = recipe.microscope;
    m.noise = m.stripes = m.shading_x = m.shading_y = m.shading_z = m.drift = m.thickness_jitter = 0.0;
    microstructure::Settings classes;
    classes.R_C = R_C;
    auto micro = microstructure::classify(synth::observe(synth::make_coating(recipe), recipe).stack, classes);
    const auto sheet = mesh::mesh_cracks(micro.crack, recipe.voxel_size, {});
    const auto voxels = static_cast<double>(micro.matter.shape().voxels());
    const double pores = 100.0 * static_cast<double>(micro.pore.count()) / voxels,
                 cracks = 100.0 * static_cast<double>(micro.crack.count()) / voxels;
    domain::Settings cutting = study.domain;
    cutting.r_tilde = bench.calibration.beam.r_tilde;
    Candidate out = measure(domain::discretise(bench.dense, micro, sheet, cutting), bench, study);
    out.numbers["porosity.pores"] = pores;
    out.numbers["porosity.cracks"] = cracks;
    out.numbers["porosity.total"] = pores + cracks;
    return out;
}

}  // namespace

std::vector<std::int64_t> shape_of(Size size, double voxel_size)
{
    const auto voxels = [&](double edge) { return std::max<std::int64_t>(16, std::lround(edge / voxel_size)); };
    if (size == Size::paper) return {voxels(746 * 23.6e-9), voxels(561 * 23.6e-9), voxels(899 * 23.6e-9)};
    return {voxels(8e-6), voxels(8e-6), voxels(8e-6)};
}

void describe(Schema& schema, Settings& s)
{
    schema.option("size", s.size, {"small", "paper"}, "a cube of 8 um, or the paper's box");
    schema.integers("seeds", s.seeds, {0, 9e15}, "one coating and one packing each");
    schema.flag("images", s.images, "send the first seed through the image chain too");
    schema.flag("calibrate", s.calibrate, "beams for each packing; else those of Table 2");
    schema.integer("triaxial_points", s.triaxial_points, {3, 500}, "points of the triaxial curves");
    schema.quantities("thicknesses", s.thicknesses, Dimension::length, {0, 1e-6},
                      "constant crack thicknesses of Fig. 22");
    schema.quantities("strengths", s.strengths, Dimension::pressure, {1e6, 1e13},
                      "bond strengths of Table 4; none: no fracture");
    schema.number("crossings", s.crossings, {1, 1e4}, "wave crossings of a fracture loading");
    schema.number("damping", s.damping, {0, 1e3}, "times the reference damping");
    schema.flag("near_contacts", s.near_contacts, "let unbonded neighbours push in states of rest");
    schema.texts("fitted", s.fitted, "numbers that the recipe was fitted to");
}

void check(const Settings& s)
{
    if (s.seeds.empty()) throw InvalidInput("reproduce.seeds: needs at least one");
    for (const auto& key : s.fitted) target(key);
}

Reproduction reproduce(const synth::Settings& recipe, const Settings& settings, const std::filesystem::path& folder)
{
    check(settings);
    const Stopwatch watch;
    synth::Settings coating = recipe;
    coating.shape = shape_of(settings.size, recipe.voxel_size);
    Study study;
    study.triaxial_points = settings.triaxial_points;
    study.thicknesses = settings.thicknesses;
    study.strengths = settings.strengths;
    study.crossings = settings.crossings;
    study.damping = settings.damping;
    study.near_contacts = settings.near_contacts;

    Reproduction out;
    out.settings = settings;
    Progress progress("reproduce: coatings", std::ssize(settings.seeds) + (settings.images ? 1 : 0));
    for (const auto seed : settings.seeds) {
        const Bench bench = make_bench(synth::box_of(coating), study, seed, settings.calibrate);
        Candidate candidate = measure(coating, seed, bench, study);
        if (!folder.empty()) loading::save(candidate.response, folder / fmt::format("seed_{}", seed));
        out.seeds.push_back(std::move(candidate.numbers));
        out.curves.push_back(std::move(candidate.response));
        progress.advance();
        if (!settings.images || seed != settings.seeds.front()) continue;
        Study short_study = study;  // strengths and constant thicknesses say nothing about how a coating was read
        short_study.strengths.clear();
        short_study.thicknesses.clear();
        out.images = by_images(coating, seed, bench, short_study).numbers;
        progress.advance();
    }
    const auto ceramic = loading::dense_material({});
    const double p = statistics(out.seeds).at("p_DE").mean / 100.0;
    out.E_eq18 = 1e-9 * loading::porous_modulus({ceramic.E_D, ceramic.nu_D}, p);
    out.E_bound = 1e-9 * loading::hashin_shtrikman({ceramic.E_D, ceramic.nu_D}, p).E;
    out.seconds = watch.seconds();
    return out;
}

}  // namespace craze::reproduce
