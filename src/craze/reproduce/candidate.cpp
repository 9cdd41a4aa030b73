#include "craze/reproduce/candidate.hpp"

#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/loading/calibration.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/synth/short_way.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace craze::reproduce {

namespace {

using Kind = loading::Loading::Kind;

std::string constant_thickness(double T)
{
    return loading::specimen_name(
        {.pores = false, .cracks = true, .thickness = domain::Defects::Thickness::constant, .constant = T});
}

const loading::Curve* triaxial_of(const loading::Response& response, const std::string& specimen)
{
    for (const auto& curve : response.curves)
        if (curve.loading.kind == Kind::triaxial && loading::specimen_name(curve.loading.specimen) == specimen)
            return &curve;
    return nullptr;
}

/// K at a normalised density, between the points of a curve, Pa; at its last point where it ends before.
double bulk_at(const loading::Curve& curve, double eta)
{
    const auto after = std::find_if(curve.points.begin(), curve.points.end(),
                                    [&](const loading::Point& p) { return p.eta >= eta * (1.0 - 1e-9); });
    if (after == curve.points.end()) return curve.points.back().bulk;
    if (after == curve.points.begin()) return after->bulk;
    const auto before = std::prev(after);
    return std::lerp(before->bulk, after->bulk, (eta - before->eta) / (after->eta - before->eta));
}

void read_thickness(const domain::Discretisation& d, Numbers& numbers)
{
    std::vector<double> T;
    for (std::size_t b = 0; b < d.bonds.cut.size(); ++b)
        if (d.bonds.cut[b]) T.push_back(d.bonds.T2[b]);
    numbers["cut_share"] = static_cast<double>(T.size()) / static_cast<double>(d.bonds.cut.size());
    if (T.empty()) return;
    const auto middle = T.begin() + static_cast<std::ptrdiff_t>(T.size() / 2);
    std::nth_element(T.begin(), middle, T.end());
    numbers["T2.median"] = 1e9 * *middle;
    numbers["T2.most"] = 1e9 * *std::max_element(T.begin(), T.end());
}

void read_response(const loading::Response& r, const Study& study, Numbers& numbers)
{
    const mechanics::DenseMaterial& dense = r.calibration.target;
    for (const auto& m : r.moduli) numbers[fmt::format("E.{}.{}", m.specimen, "xyz"[m.axis])] = 1e-9 * m.tension;
    const double K_D = dense.E_D / (3.0 * (1.0 - 2.0 * dense.nu_D));
    for (const char* specimen : {"pores", "cracks", "both"})
        if (const auto* curve = triaxial_of(r, specimen); curve != nullptr && curve->points.size() > 2) {
            numbers[fmt::format("ratio.{}", specimen)] = curve->points.front().bulk / K_D;
            if (std::string_view(specimen) != "both") continue;
            numbers["K.start"] = 1e-9 * curve->points.front().bulk;
            numbers["K.end"] = 1e-9 * bulk_at(*curve, eta_paper);
        }
    for (const auto& [key, eta] : {std::pair{"T.equivalent", study.eta}, {"T.equivalent.short", eta_paper}})
        if (const double T = equivalent_thickness(r, study.thicknesses, eta); T > 0.0) numbers[key] = 1e9 * T;
    for (const auto& s : r.strengths) {
        const auto GPa = std::lround(1e-9 * s.sigma_failure);
        numbers[fmt::format("{}.{}", s.tension ? "UTS" : "UCS", GPa)] = 1e-6 * s.strength;
        // The paper finds the same share for each bond strength: the first stands for all.
        numbers.try_emplace(s.tension ? "new.tension" : "new.compression", 100.0 * s.new_cracks);
    }
    for (int k = 10; k <= 50; k += 10) {
        const auto tension = numbers.find(fmt::format("UTS.{}", k)),
                   compression = numbers.find(fmt::format("UCS.{}", k));
        if (tension != numbers.end() && compression != numbers.end() && tension->second > 0.0)
            numbers[fmt::format("UCS/UTS.{}", k)] = compression->second / tension->second;
    }
}

/// Loads, or takes what an earlier run has loaded under the same key.
loading::Response kept_load(const domain::Discretisation& discretisation, const loading::Settings& settings,
                            const std::string& name, const Keep& keep)
{
    if (keep.folder.empty()) return loading::load(discretisation, settings);
    const auto folder = keep.folder / name, stamp = folder / "stamp.txt";
    if (keep.resume && std::filesystem::exists(stamp) && io::read_text(stamp) == keep.key) {
        say(fmt::format("reproduce: {} unchanged, skipped", folder.string()));
        return loading::load_response(folder);
    }
    if (!keep.resume) std::filesystem::remove_all(folder);
    std::filesystem::remove(stamp);
    auto response = loading::load(discretisation, settings, folder);
    loading::save(response, folder);
    io::write_text(stamp, keep.key);
    return response;
}

}  // namespace

loading::Settings laboratory(const Study& study, const loading::Calibration& calibration)
{
    loading::Settings s;
    s.beam.calibrate = false;
    s.beam.given = calibration.beam;
    s.specimens = study.specimens;
    s.residual = study.residual;
    s.moduli.run = study.moduli;
    s.moduli.specimens = s.specimens;
    s.uniaxial.run = study.uniaxial_points > 0;
    s.uniaxial.points = std::max<std::int64_t>(1, study.uniaxial_points);
    s.uniaxial.compression = 5.9e-3;
    s.output.states = {-5.9e-3};  // [Fig. 19]
    s.output.last_state = false;
    s.triaxial.run = study.triaxial_points > 0;
    s.triaxial.points = std::max<std::int64_t>(1, study.triaxial_points);
    s.triaxial.eta = study.eta;
    s.triaxial.specimens = study.specimens;
    std::erase(s.triaxial.specimens, "dense");
    if (study.closed)
        s.triaxial.specimens.insert(s.triaxial.specimens.end(), {"dense", "cracks closed", "both closed"});
    for (const double T : study.thicknesses) {
        s.specimens.push_back(constant_thickness(T));
        s.triaxial.specimens.push_back(s.specimens.back());
    }
    return s;
}

std::vector<loading::Settings> fracture_laboratories(const Study& study, const loading::Calibration& calibration)
{
    loading::Settings quiet;
    quiet.beam.calibrate = false;
    quiet.beam.given = calibration.beam;
    quiet.specimens = {"both"};
    quiet.output.last_state = false;
    quiet.moduli.run = quiet.uniaxial.run = quiet.triaxial.run = false;
    quiet.fracture.run = true;
    quiet.fracture.crossings = study.crossings;
    quiet.fracture.damping = study.damping;
    quiet.fracture.bending_share = study.bending_share;
    std::vector<loading::Settings> all;
    for (const double strength : study.strengths) {
        auto s = quiet;
        s.fracture.strengths = {strength};
        s.output.last_state = strength == 30e9;  // [Fig. 24]
        s.fracture.tension = study.tension;
        s.fracture.compression = study.compression;
        all.push_back(s);
    }
    if (!study.cycles.empty() && !study.strengths.empty()) {
        auto s = quiet;
        s.fracture.strengths = {study.strengths.front()};
        s.fracture.tension = s.fracture.compression = 0.0;
        s.fracture.cycles = study.cycles;
        all.push_back(s);
    }
    return all;
}

Bench make_bench(const Vec3& box, const Study& study, std::int64_t seed, bool calibrate)
{
    Bench bench;
    bench.R_DE = study.domain.mean_radius.value_or(200e-9);
    domain::Settings settings = study.domain;
    settings.seed = seed;
    if (!study.near_contacts) settings.near_gap = 0.0;
    bench.dense = domain::pack(box, bench.R_DE, settings);
    const mechanics::DenseMaterial ceramic = loading::dense_material({});
    bench.calibration = calibrate ? loading::calibrate(bench.dense, ceramic, {})
                                  : loading::measure_given(bench.dense, ceramic, mechanics::BeamMaterial{}, {});
    return bench;
}

Numbers numbers_of(const domain::Discretisation& discretisation, const loading::Response& response, const Study& study)
{
    Numbers numbers;
    numbers["elements"] = discretisation.dense.elements.size();
    numbers["bonds"] = discretisation.dense.bonds.size();
    numbers["E_B"] = 1e-9 * response.calibration.beam.E_B;
    numbers["r_tilde"] = response.calibration.beam.r_tilde;
    numbers["p_DE"] = 100.0 * domain::discrete_porosity(discretisation);
    read_thickness(discretisation, numbers);
    read_response(response, study, numbers);
    return numbers;
}

namespace {

/// The coating put into the bench's packing as the study sees it.
domain::Discretisation discretised(const synth::Coating& coating, const synth::Settings& recipe, const Bench& bench,
                                   const Study& study)
{
    synth::Sight sight =
        study.as_seen ? synth::Sight(recipe.microscope, recipe.voxel_size, study.threshold) : synth::Sight();
    if (study.as_seen) {
        sight.rim = 2.0 * recipe.voxel_size;
        sight.margin = R_E;
    }
    return synth::discretise(coating, bench.dense, bench.calibration.beam.r_tilde * bench.R_DE, sight);
}

/// Every loading of a study, each kept under `prefix` and its name.
loading::Response load_all(const domain::Discretisation& discretisation, const Bench& bench, const Study& study,
                           const std::string& prefix, const Keep& keep)
{
    auto all = kept_load(discretisation, laboratory(study, bench.calibration), prefix + "elastic", keep);
    for (const auto& fracture : fracture_laboratories(study, bench.calibration)) {
        const auto name = fmt::format("{}{}_{:g}_GPa", prefix, fracture.fracture.cycles.empty() ? "fracture" : "cycles",
                                      1e-9 * fracture.fracture.strengths.front());
        auto more = kept_load(discretisation, fracture, name, keep);
        std::move(more.curves.begin(), more.curves.end(), std::back_inserter(all.curves));
        std::move(more.strengths.begin(), more.strengths.end(), std::back_inserter(all.strengths));
        all.seconds += more.seconds;
    }
    all.calibration = bench.calibration;
    return all;
}

}  // namespace

Candidate measure(const synth::Settings& recipe, const Bench& bench, const Study& study, const Keep& keep)
{
    const synth::Coating coating = synth::make_coating(recipe);
    Candidate out;
    out.discretisation = discretised(coating, recipe, bench, study);
    out.response = load_all(out.discretisation, bench, study, "", keep);
    out.numbers = numbers_of(out.discretisation, out.response, study);
    const Vec3& size = coating.size;
    const auto porosity = synth::porosity(coating, std::cbrt(size.x * size.y * size.z) / 192.0);
    out.numbers["porosity.total"] = 100.0 * porosity.total;
    out.numbers["porosity.pores"] = 100.0 * porosity.pores;
    out.numbers["porosity.cracks"] = 100.0 * porosity.cracks;
    return out;
}

namespace {

/// Strengths of the specimen with pores and cracks and, with points, its K.
Study narrowed(Study study, std::int64_t triaxial_points)
{
    study.specimens = {"both"};
    study.moduli = study.closed = false;
    study.uniaxial_points = 0;
    study.triaxial_points = std::min(triaxial_points, study.triaxial_points);
    study.eta = eta_paper;
    study.thicknesses.clear();
    study.cycles.clear();
    return study;
}

}  // namespace

std::vector<Variant> by_opening(const synth::Settings& recipe, const Bench& bench, const Study& study,
                                const std::vector<double>& factors, const Keep& keep)
{
    if (factors.empty()) return {};
    const Study narrow = narrowed(study, 5);
    const auto discretisation = discretised(synth::make_coating(recipe), recipe, bench, study);
    std::vector<Variant> out;
    for (const double factor : factors) {
        auto opened = discretisation;
        for (auto* pairs : {&opened.bonds, &opened.near})
            for (auto& T : pairs->T2) T *= factor;
        const auto response = load_all(opened, bench, narrow, fmt::format("openings_{:g}_", factor), keep);
        out.push_back({factor, numbers_of(opened, response, narrow)});
    }
    return out;
}

std::vector<Variant> by_bending_share(const synth::Settings& recipe, const Bench& bench, const Study& study,
                                      const std::vector<double>& shares, const Keep& keep)
{
    if (shares.empty()) return {};
    const auto discretisation = discretised(synth::make_coating(recipe), recipe, bench, study);
    std::vector<Variant> out;
    for (const double share : shares) {
        Study narrow = narrowed(study, 0);
        narrow.bending_share = share;
        // Beams that bear more are strained further.
        narrow.tension /= std::max(0.2, share), narrow.compression /= std::max(0.2, share);
        const auto response = load_all(discretisation, bench, narrow, fmt::format("bending_{:g}_", share), keep);
        out.push_back({share, numbers_of(discretisation, response, narrow)});
    }
    return out;
}

double equivalent_thickness(const loading::Response& response, std::vector<double> thicknesses, double eta)
{
    const auto* open = triaxial_of(response, "cracks");
    if (open == nullptr || thicknesses.size() < 2) return 0.0;
    std::sort(thicknesses.begin(), thicknesses.end());
    std::vector<const loading::Curve*> tried;
    for (const double T : thicknesses) {
        tried.push_back(triaxial_of(response, constant_thickness(T)));
        if (tried.back() == nullptr || tried.back()->points.size() != open->points.size()) return 0.0;
    }
    // Between neighbours P is a straight line in T: its misfit is a parabola with a known vertex.
    double best = 0.0, least = INFINITY;
    for (std::size_t k = 0; k + 1 < tried.size(); ++k) {
        double along = 0.0, square = 0.0;
        const auto each = [&](auto&& use) {
            for (std::size_t p = 0; p < open->points.size() && open->points[p].eta <= eta * (1.0 + 1e-9); ++p) {
                const double from = tried[k]->points[p].pressure;
                use(open->points[p].pressure - from, tried[k + 1]->points[p].pressure - from);
            }
        };
        each([&](double wanted, double step) { along += wanted * step, square += step * step; });
        const double share = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
        double misfit = 0.0;
        each([&](double wanted, double step) { misfit += std::pow(wanted - share * step, 2); });
        if (misfit < least) least = misfit, best = std::lerp(thicknesses[k], thicknesses[k + 1], share);
    }
    return best;
}

}  // namespace craze::reproduce
