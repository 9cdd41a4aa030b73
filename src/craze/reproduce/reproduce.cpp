#include "craze/reproduce/reproduce.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/hash.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/version.hpp"
#include "craze/loading/theory.hpp"
#include "craze/pipeline/pipeline.hpp"
#include "craze/pipeline/steps.hpp"
#include "craze/synth/sight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace fs = std::filesystem;

namespace {

Study study_of(const Settings& s)
{
    Study study;
    study.uniaxial_points = s.uniaxial_points;
    study.triaxial_points = s.triaxial_points;
    study.eta = s.eta;
    study.closed = true;
    study.thicknesses = s.thicknesses;
    study.strengths = s.strengths;
    study.tension = s.tension;
    study.compression = s.compression;
    study.crossings = s.crossings;
    study.damping = s.damping;
    study.bending_share = s.bending_share;
    study.cycles = s.cycles;
    study.near_contacts = s.near_contacts;
    study.threshold = s.threshold;
    return study;
}

/// All that decides what a seed gives.
std::string key_of(synth::Settings recipe, const Settings& settings, std::int64_t seed)
{
    const auto text = [](auto& value) {
        return pipeline::settings_json([&](Schema& schema) { describe(schema, value); }, false).dump();
    };
    Settings s = settings;
    s.seeds = {seed};
    s.images = false;
    s.search = 21;
    s.fitted.clear();
    s.openings.clear();
    s.bending_shares.clear();
    s.cycles = seed == settings.seeds.front() ? s.cycles : std::vector<double>{};
    return Hash().add(version).add(text(recipe)).add(text(s)).digest();
}

/// The first coating as images, with every fault of the microscope, through the whole chain.
Numbers by_images(const synth::Settings& coating, const Bench& bench, Study study, std::int64_t search,
                  const Place& place)
{
    pipeline::Settings p;
    p.synth = coating;
    p.images.denoise.search = search;
    p.microstructure.R_C = R_C / coating.voxel_size;
    p.microstructure.R_E = R_E / coating.voxel_size;
    p.mesh.skeleton = mesh::SkeletonKind::medial_surface;
    p.domain = study.domain;
    p.domain.seed = coating.seed;
    p.domain.mean_radius = bench.R_DE;
    p.domain.r_tilde = bench.calibration.beam.r_tilde;
    if (!study.near_contacts) p.domain.near_gap = 0.0;
    study.thicknesses.clear();  // they say nothing about how a coating was read
    // The longer curves are for the thicknesses: here they end where the paper's do, in the same steps.
    if (study.eta > eta_paper) {
        study.triaxial_points =
            std::max(3L, std::lround(static_cast<double>(study.triaxial_points) * eta_paper / study.eta));
        study.eta = eta_paper;
    }
    study.strengths.resize(std::min<std::size_t>(1, study.strengths.size()));
    study.cycles.clear();
    p.loading = laboratory(study, bench.calibration);
    if (const auto fracture = fracture_laboratories(study, bench.calibration); !fracture.empty())
        p.loading.fracture = fracture.front().fracture;
    pipeline::check(p);
    pipeline::run(p, {"", place.folder, {}, place.resume});

    Numbers numbers = numbers_of(domain::load_discretisation(place.folder / "domain"),
                                 loading::load_response(place.folder / "loading"), study);
    const Json micro = pipeline::read_summary(place.folder, "microstructure");
    for (const char* part : {"total", "pores", "cracks"})
        numbers[fmt::format("porosity.{}", part)] = 100.0 * micro.at("porosity").at(part).get<double>();
    return numbers;
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
    constexpr Range strain{0.0, 0.2};
    schema.option("size", s.size, {"small", "paper"}, "a cube of 8 um, or the paper's box");
    schema.integers("seeds", s.seeds, {0, 9e15}, "one coating and one packing each");
    schema.flag("images", s.images, "send the first seed through the image chain too");
    schema.integer("search", s.search, {3, 63}, "its window of non-local means, px, odd");
    schema.flag("calibrate", s.calibrate, "beams for each packing; else those of Table 2");
    schema.integer("uniaxial_points", s.uniaxial_points, {0, 500}, "points of the stress-strain curves; 0: none");
    schema.integer("triaxial_points", s.triaxial_points, {3, 500}, "points of the triaxial curves");
    schema.quantity("eta", s.eta, Dimension::fraction, {1e-3, 0.1}, "largest normalised density of these");
    schema.quantities("thicknesses", s.thicknesses, Dimension::length, {0, 1e-6},
                      "constant crack thicknesses of Fig. 22");
    schema.quantities("strengths", s.strengths, Dimension::pressure, {1e6, 1e13},
                      "bond strengths of Table 4; none: no fracture");
    schema.quantity("tension", s.tension, Dimension::fraction, strain,
                    "strain at the end of a tension with bonds of 10 GPa; others in proportion");
    schema.quantity("compression", s.compression, Dimension::fraction, strain, "the same in compression");
    schema.number("crossings", s.crossings, {1, 1e4},
                  "fracture loadings: wave crossings per strain of sigma_failure / E_B");
    schema.number("damping", s.damping, {0, 1e3}, "mass damping of fracture loadings, times the reference");
    schema.quantities("cycles", s.cycles, Dimension::fraction, {-0.2, 0.2},
                      "peaks of strain at the first strength, first seed only; none: no cycles");
    schema.number("bending_share", s.bending_share, {0, 1},
                  "of a beam's bending stress, this share counts towards its strength [Eq. 24]; 1 as printed");
    schema.quantities("bending_shares", s.bending_shares, Dimension::fraction, {0, 1},
                      "strengths of the first seed with each of these shares too; none: not run");
    schema.quantities("openings", s.openings, Dimension::fraction, {0, 100},
                      "all openings times each of these, first seed: UCS/UTS beside K; 0 is closed, none: not run");
    schema.flag("near_contacts", s.near_contacts, "let unbonded neighbours push in states of rest");
    schema.number("threshold", s.threshold, {1, 255},
                  "the short way sees cracks as with this gray level S; images find their own");
    schema.texts("fitted", s.fitted, "numbers that the recipe was fitted to");
}

void check(const Settings& s)
{
    if (s.seeds.empty()) throw InvalidInput("reproduce.seeds: needs at least one");
    for (std::size_t i = 0; i < s.seeds.size(); ++i)
        if (std::count(s.seeds.begin(), s.seeds.end(), s.seeds[i]) > 1)
            throw InvalidInput(fmt::format("reproduce.seeds: each counts once, got {} twice", s.seeds[i]));
    if (s.search % 2 == 0) throw InvalidInput(fmt::format("reproduce.search must be odd, got {}", s.search));
    for (const auto& key : s.fitted) target(key);
}

Reproduction reproduce(const synth::Settings& recipe, const Settings& settings, const Place& place)
{
    check(settings);
    synth::check(recipe);
    if (settings.images && place.folder.empty())
        throw InvalidInput("reproduce.images: the image chain needs a folder to work in");
    const Stopwatch watch;
    synth::Settings coating = recipe;
    coating.shape = shape_of(settings.size, recipe.voxel_size);
    const Study study = study_of(settings);
    synth::Sight(coating.microscope, coating.voxel_size, study.threshold);  // refuses a threshold before work starts

    Reproduction out;
    out.settings = settings;
    for (const auto seed : settings.seeds) {
        say(fmt::format("reproduce: seed {} ({} of {})", seed, out.seeds.size() + 1, settings.seeds.size()));
        const bool first = out.seeds.empty();
        const Bench bench = make_bench(synth::box_of(coating), study, seed, settings.calibrate);
        Study mine = study;
        if (!first) mine.cycles.clear();
        Keep keep;
        if (!place.folder.empty())
            keep = {place.folder / "reproduce" / fmt::format("seed_{}", seed), key_of(coating, settings, seed),
                    place.resume};
        coating.seed = seed;
        Candidate candidate = measure(coating, bench, mine, keep);
        out.seeds.push_back(std::move(candidate.numbers));
        out.curves.push_back(std::move(candidate.response));
        if (first) {
            Study one = mine;
            one.strengths.resize(std::min<std::size_t>(1, one.strengths.size()));
            out.openings = by_opening(coating, bench, one, settings.openings, keep);
            out.bending = by_bending_share(coating, bench, one, settings.bending_shares, keep);
        }
        if (first && settings.images) {
            say("reproduce: the first seed by images");
            out.images = by_images(coating, bench, study, settings.search, place);
        }
    }
    const auto ceramic = loading::dense_material({});
    const double p = statistics(out.seeds).at("p_DE").mean / 100.0;
    out.E_eq18 = 1e-9 * loading::porous_modulus({ceramic.E_D, ceramic.nu_D}, p);
    out.E_bound = 1e-9 * loading::hashin_shtrikman({ceramic.E_D, ceramic.nu_D}, p).E;
    out.seconds = watch.seconds();
    if (!place.folder.empty()) {
        save(out, place.folder / "reproduce");
        report::write_report(place.folder, {});
    }
    return out;
}

}  // namespace craze::reproduce
