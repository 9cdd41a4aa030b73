#include "craze/pipeline/pipeline.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/hash.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/domain/voxel_size_study.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/microstructure/figures.hpp"
#include "craze/pipeline/headline.hpp"
#include "craze/pipeline/run_record.hpp"
#include "craze/pipeline/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace craze::pipeline {

namespace fs = std::filesystem;

namespace {

// Values on their way from room to room; one that an earlier run left on disk is read when it is asked for.
struct Workspace {
    Settings s;
    fs::path out;
    bool sweep = false;
    std::optional<images::Gray> gray_;
    std::optional<microstructure::Microstructure> micro_;
    std::optional<mesh::CrackSurface> surface_;
    std::optional<domain::Discretisation> discretisation_;

    images::Gray take_gray()
    {
        images::Gray gray = gray_ ? std::move(*gray_) : images::load_gray(out / "images");
        gray_.reset();
        return gray;
    }
    const microstructure::Microstructure& micro()
    {
        if (!micro_) micro_ = microstructure::load_microstructure(out / "microstructure", out / "images");
        return *micro_;
    }
    const mesh::CrackSurface& surface()
    {
        if (!surface_) surface_ = mesh::load_surface(out / "mesh");
        return *surface_;
    }
    const domain::Discretisation& discretisation()
    {
        if (!discretisation_) discretisation_ = domain::load_discretisation(out / "domain");
        return *discretisation_;
    }
};

Json do_synth(Workspace& w, const fs::path& folder)
{
    const synth::Coating coating = synth::make_coating(w.s.synth);
    const synth::Observation observation = synth::observe(coating, w.s.synth);
    synth::save(coating, observation, w.s.synth, folder);
    return synth::summary(coating, observation, w.s.synth);
}

Json do_images(Workspace& w, const fs::path& folder)
{
    images::Settings s = w.s.images;
    if (w.s.synthetic()) {
        s.source = (w.out / "synth" / "stack.tif").string();
        s.voxel_size = {w.s.synth.voxel_size};
    }
    return images::summary(images::preprocess(s, folder));
}

Json do_microstructure(Workspace& w, const fs::path& folder)
{
    w.micro_ = microstructure::classify(w.take_gray(), w.s.microstructure);
    const auto analysis = microstructure::analyse(*w.micro_, w.s.microstructure);
    microstructure::save(*w.micro_, folder);
    microstructure::save(analysis, *w.micro_, folder);
    if (w.s.microstructure.intermediates) microstructure::save_intermediates(*w.micro_, w.s.microstructure, folder);
    if (w.s.microstructure.figures) microstructure::save_figures(*w.micro_, folder);
    Json summary = microstructure::summary(*w.micro_, analysis);
    if (w.sweep) {
        const auto sweep = microstructure::swept(w.micro_->matter, w.s.microstructure);
        microstructure::save(sweep, w.micro_->gray, w.micro_->matter, w.s.microstructure, folder);
        summary["sweep"] = microstructure::summary(sweep);
        say(fmt::format("microstructure: the sweep proposes R_C = {} px and R_E = {} px", sweep.R_C, sweep.R_E));
    }
    return summary;
}

Json do_mesh(Workspace& w, const fs::path& folder)
{
    w.surface_ = mesh::mesh_cracks(w.micro().crack, w.micro().gray.voxel_size, w.s.mesh);
    const auto measures = mesh::measure(*w.surface_, w.micro().crack, w.micro().gray.voxel_size);
    mesh::save(*w.surface_, measures, w.s.mesh, folder);
    return mesh::summary(*w.surface_, measures);
}

// Nothing that follows needs the study: where it fails the run goes on.
void study_voxel_sizes(Workspace& w, const fs::path& folder)
{
    fs::remove(folder / "voxel_sizes.json");
    if (w.s.domain.voxel_sizes.empty()) return;
    const auto leave_out = [](const std::exception& error) {
        notice(fmt::format("domain.voxel_sizes: the study is left out: {}", error.what()));
    };
    try {
        domain::save(domain::voxel_size_study(*w.discretisation_, w.micro(), w.s.domain.voxel_sizes, w.s.microstructure,
                                              w.s.mesh, w.s.domain),
                     folder);
    } catch (const InvalidInput& error) {
        leave_out(error);
    } catch (const ComputationFailed& error) {
        leave_out(error);
    }
}

Json do_domain(Workspace& w, const fs::path& folder)
{
    if (w.s.without_images()) {
        w.discretisation_ = domain::import_domain(w.s.domain);
    } else {
        w.discretisation_ = domain::discretise(w.micro(), w.surface(), w.s.microstructure.R_C, w.s.domain);
        w.surface_.reset();
        study_voxel_sizes(w, folder);
    }
    w.micro_.reset();
    domain::save(*w.discretisation_, w.s.domain, folder, loading::dense_material(w.s.loading).rho_D);
    return domain::summary(*w.discretisation_);
}

Json do_loading(Workspace& w, const fs::path& folder)
{
    const loading::Response response = loading::load(w.discretisation(), w.s.loading, folder);
    loading::save(response, folder);
    return loading::summary(response);
}

Json do_report(Workspace& w, const fs::path&)
{
    const fs::path page = report::write_report(w.out, w.s.report);
    return {{"page", fs::relative(page, w.out).string()}};
}

// A room's settings as the text that decides its result: where files lie does not matter.
template <class RoomSettings>
std::string content(RoomSettings s)
{
    return settings_json([&](Schema& schema) { describe(schema, s); }, false).dump();
}

// What an imported packing's files hold.
std::string imported(const domain::Settings& s)
{
    Hash hash;
    for (const std::string& file : {s.import_from.elements, s.import_from.bonds, s.import_from.near})
        if (!file.empty()) hash.add_file(file);
    return hash.digest();
}

// The ceramic's density stands in files that are written for others.
std::string written_density(const Settings& s)
{
    return s.domain.write.empty() ? "" : fmt::format("{}", loading::dense_material(s.loading).rho_D);
}

std::vector<Step> steps(const Settings& s, const RunOptions& options)
{
    const auto w = std::make_shared<Workspace>();
    w->s = s;
    w->out = options.out;
    w->sweep = options.sweep;
    const auto with = [w](Json (*work)(Workspace&, const fs::path&)) {
        return [w, work](const fs::path& folder) { return work(*w, folder); };
    };
    std::vector<Step> all;
    if (!s.without_images()) {
        if (s.synthetic()) all.push_back({"synth", content(s.synth), {}, with(do_synth)});
        const std::string stack = s.synthetic() ? "" : Hash().add_file(s.images.source).digest();
        all.push_back({"images", content(s.images) + stack, {}, with(do_images)});
        if (s.synthetic()) all.back().after = {"synth"};
        all.push_back({"microstructure", content(s.microstructure), {"images"}, with(do_microstructure)});
        all.push_back({"mesh", content(s.mesh), {"microstructure"}, with(do_mesh)});
    }
    all.push_back({"domain", content(s.domain) + imported(s.domain) + written_density(s), {}, with(do_domain)});
    if (!s.without_images()) all.back().after = {"microstructure", "mesh"};
    all.push_back({"loading", content(s.loading), {"domain"}, with(do_loading)});
    all.push_back({"report", content(s.report), {"loading"}, with(do_report), true});
    return all;
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& rooms()
{
    static const std::vector<std::pair<std::string, std::string>> all{
        {"synth", "what would a microscope see of a coating whose truth we know?"},
        {"images", "what did the microscope see?"},
        {"microstructure", "which void is a pore, which a crack?"},
        {"mesh", "which sheet is each crack?"},
        {"domain", "which elements and bonds stand for the matter?"},
        {"loading", "what do we impose, what do we measure?"},
        {"report", "what do we say?"}};
    return all;
}

std::string run(const Settings& settings, const RunOptions& options)
{
    const auto plan = steps(settings, options);
    const fs::path record = options.out / "run.json";
    io::write_text(record, run_record(settings, options, {}, false).dump(2) + "\n");
    const auto done = run_steps(plan, options.out, options.resume);
    io::write_text(record, run_record(settings, options, done, true).dump(2) + "\n");
    return headline(options.out);
}

void run_room(const std::string& room, const Settings& settings, const RunOptions& options)
{
    run_one(steps(settings, options), room, options.out);
    say(headline(options.out));
}

std::string default_settings_text()
{
    Settings s;
    return "# Settings of craze. Every key has the default shown; delete what you do not change.\n"
           "# Numbers carry their units as text. Relative paths are taken from where this file lies.\n" +
           write_settings([&](Schema& schema) { describe(schema, s); });
}

std::string settings_reference()
{
    Settings s;
    return "# Settings\n\nEvery key of a settings file, as `craze settings` prints it. Numbers with a unit are texts: "
           "\"23.6 nm\".\n" +
           settings_manual([&](Schema& schema) { describe(schema, s); });
}

}  // namespace craze::pipeline
