#include "craze/loading/loading.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/calibration.hpp"
#include "craze/loading/material_library.hpp"
#include "craze/loading/moving.hpp"
#include "craze/loading/response_files.hpp"
#include "craze/loading/restart.hpp"
#include "craze/loading/rig.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/loading/states.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numbers>

namespace craze::loading {
namespace {

RigOptions rig_options(const Settings& s) { return {s.face_reach, s.interior_margin, s.residual, s.curve_residual}; }

/// A packing that came without its pores' elements would be calibrated to be as stiff as the dense ceramic.
void tell_of_carved(const domain::Domain& dense)
{
    double spheres = 0.0;
    for (const double r : dense.elements.r) spheres += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    if (const double lost = 1.0 - spheres / dense.dense_volume; lost > 0.001)
        notice(fmt::format(
            "calibration: {:.1f} % of the packing's volume was carved out before it came here, so its beams are made "
            "too "
            "stiff; import the domain.vtkhdf of its run, or give the beams (loading.beam.calibrate = false)",
            100.0 * lost));
}

Calibration find_beams(const domain::Domain& dense, const Settings& s)
{
    const mechanics::DenseMaterial target = dense_material(s);
    CalibrationOptions options;
    options.nu_B = s.beam.given.nu_B;
    if (s.beam.given.r_tilde != mechanics::BeamMaterial{}.r_tilde) options.first_guess = s.beam.given.r_tilde;
    options.tolerance = s.beam.tolerance;
    options.rig = rig_options(s);
    if (s.beam.calibrate) tell_of_carved(dense);
    if (!s.beam.calibrate) return measure_given(dense, target, s.beam.given, options);
    const std::string recipe = calibration_recipe(dense, target, options.nu_B, options.rig);
    if (auto kept = find_calibration(recipe, s.beam.tolerance, s.beam.library)) return *kept;
    Calibration calibration = calibrate(dense, target, options);
    calibration.recipe = recipe;
    if (!s.beam.library.empty()) keep_calibration(calibration, s.beam.library);
    return calibration;
}

/// Tension and compression of one specimen along one axis make one row of [Table 3].
void add_modulus(std::vector<Modulus>& moduli, const Curve& curve)
{
    const std::string name = specimen_name(curve.loading.specimen);
    const int axis = curve.loading.axis;
    auto row = std::find_if(moduli.begin(), moduli.end(),
                            [&](const Modulus& m) { return m.specimen == name && m.axis == axis; });
    if (row == moduli.end()) {
        moduli.push_back({.specimen = name, .axis = axis});
        row = moduli.end() - 1;
    }
    const Point& p = curve.points.back();
    const double stress = p.stress[axis];
    (p.program > 0.0 ? row->tension : row->compression) = stress / p.strain[axis];
    if (p.program < 0.0) return;
    row->face = stress / p.face_strain[axis];
    row->interior = stress / p.interior_strain[axis];
    row->nu = -0.5 * (p.interior_strain[(axis + 1) % 3] + p.interior_strain[(axis + 2) % 3]) / p.interior_strain[axis];
}

/// UTS and UCS; a loading at half the rate says how far its twin would move.
void add_strengths(Response& response)
{
    for (const auto& curve : response.curves) {
        if (curve.loading.kind != Loading::Kind::fracture) continue;
        const Strength s = strength_of(curve);
        const auto twin =
            std::find_if(response.strengths.begin(), response.strengths.end(),
                         [&](const Strength& other) { return s.loading == half_rate_name(other.loading); });
        if (twin != response.strengths.end() && twin->strength > 0.0)
            twin->change = std::abs(s.strength / twin->strength - 1.0);
        response.strengths.push_back(s);
    }
}

/// Keeps what a stopped run has finished, and the states that were asked for.
class Keeper {
public:
    Keeper(std::filesystem::path folder, const Settings::Output& output) : folder_(std::move(folder)), output_(output)
    {
    }

    Curve run(Rig& rig, const Loading& loading) const
    {
        const bool keeps = !folder_.empty();
        const std::string key = keeps ? restart_key(rig, loading) : std::string{};
        const auto finished = folder_ / "partial" / (key + ".json");
        if (keeps && std::filesystem::exists(finished)) return read_curve(finished);

        double before = 0.0;
        const Watcher watch = [&](const Moment& moment) {
            const double s = moment.point.program;
            for (const double wanted : output_.states)
                if (moment.index > 0 && std::min(before, s) <= wanted && wanted <= std::max(before, s) &&
                    wanted != before)
                    write_state(state_file(loading, format_quantity(wanted, Dimension::fraction)), rig, moment);
            if (moment.last && output_.last_state && loading.kind != Loading::Kind::modulus)
                write_state(state_file(loading, "last"), rig, moment);
            before = s;
        };
        Curve curve;
        if (loading.solver == Solver::equilibrium) {
            curve = rig.rest(loading, keeps ? watch : Watcher{});
        } else {
            MovingOptions options;
            if (keeps) options.restart = folder_ / "partial" / (key + ".restart");
            options.checkpoint = output_.checkpoint;
            curve = move(rig, loading, options, keeps ? watch : Watcher{});
        }
        if (keeps) write_curve(curve, finished);
        return curve;
    }
    /// Once all is in the response.
    void clear() const
    {
        if (!folder_.empty()) std::filesystem::remove_all(folder_ / "partial");
    }

private:
    std::filesystem::path state_file(const Loading& loading, const std::string& when) const
    {
        return folder_ / "states" / fmt::format("{}_{}.vtu", file_name(loading.name), file_name(when));
    }

    std::filesystem::path folder_;
    const Settings::Output& output_;
};

}  // namespace

Response load(const domain::Discretisation& discretisation, const Settings& settings,
              const std::filesystem::path& folder)
{
    check(settings);
    const Stopwatch watch;
    Response response;
    response.porosity = domain::discrete_porosity(discretisation);
    response.calibration = find_beams(discretisation.dense, settings);
    const auto& c = response.calibration;
    say(fmt::format("loading: E_B {:.4g} GPa, r~ {:.4f} give E {:.4g} GPa, nu {:.4f} (isotropic to {:.2g} %)",
                    c.beam.E_B * 1e-9, c.beam.r_tilde, c.E * 1e-9, c.nu, 100.0 * c.anisotropy));

    // One specimen at a time, all its loadings together: a packing is held in memory once beside the dense one.
    std::vector<Loading> loadings = plan(settings, discretisation.dense.box);
    std::vector<std::string> specimens;
    for (const Loading& loading : loadings)
        if (const auto name = specimen_name(loading.specimen);
            std::find(specimens.begin(), specimens.end(), name) == specimens.end())
            specimens.push_back(name);
    const Keeper keeper(folder, settings.output);
    std::vector<Curve> curves(loadings.size());
    for (const auto& name : specimens) {
        const domain::Domain specimen = domain::with_defects(discretisation, parse_specimen(name));
        Rig rig(specimen, c.beam, c.target, rig_options(settings));
        for (std::size_t k = 0; k < loadings.size(); ++k) {
            if (specimen_name(loadings[k].specimen) != name) continue;
            check_interrupt();
            curves[k] = keeper.run(rig, loadings[k]);
        }
    }
    for (auto& curve : curves) {
        if (curve.loading.kind == Loading::Kind::modulus) add_modulus(response.moduli, curve);
        response.curves.push_back(std::move(curve));
    }
    add_strengths(response);
    keeper.clear();
    response.seconds = watch.seconds();
    return response;
}

}  // namespace craze::loading
