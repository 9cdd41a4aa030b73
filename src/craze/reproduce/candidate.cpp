#include "craze/reproduce/candidate.hpp"

#include "craze/core/errors.hpp"
#include "craze/loading/calibration.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/synth/short_way.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace {

using Kind = loading::Loading::Kind;

std::string constant_thickness(double T)
{
    return loading::specimen_name(
        {.pores = false, .cracks = true, .thickness = domain::Defects::Thickness::constant, .constant = T});
}

loading::Settings laboratory(const Study& study, const loading::Calibration& calibration)
{
    loading::Settings s;
    s.beam.calibrate = false;
    s.beam.given = calibration.beam;
    s.specimens = {"dense", "pores", "cracks", "both"};
    s.residual = study.residual;
    s.moduli.run = study.moduli;
    s.moduli.specimens = {"dense", "pores", "cracks", "both"};
    s.uniaxial.run = false;
    s.triaxial.run = study.triaxial_points > 0;
    s.triaxial.points = std::max<std::int64_t>(1, study.triaxial_points);
    s.triaxial.specimens = {"pores", "cracks", "both"};
    for (const double T : study.thicknesses) {
        s.specimens.push_back(constant_thickness(T));
        s.triaxial.specimens.push_back(s.specimens.back());
    }
    s.fracture.run = !study.strengths.empty();
    s.fracture.strengths = study.strengths;
    s.fracture.crossings = study.crossings;
    s.fracture.damping = study.damping;
    return s;
}

const loading::Curve* triaxial_of(const loading::Response& response, const std::string& specimen)
{
    for (const auto& curve : response.curves)
        if (curve.loading.kind == Kind::triaxial && loading::specimen_name(curve.loading.specimen) == specimen)
            return &curve;
    return nullptr;
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

void read_response(const loading::Response& r, const Study& study, const mechanics::DenseMaterial& dense,
                   Numbers& numbers)
{
    for (const auto& m : r.moduli) numbers[fmt::format("E.{}.{}", m.specimen, "xyz"[m.axis])] = 1e-9 * m.tension;
    const double K_D = dense.E_D / (3.0 * (1.0 - 2.0 * dense.nu_D));
    for (const char* specimen : {"pores", "cracks", "both"})
        if (const auto* curve = triaxial_of(r, specimen); curve != nullptr && curve->points.size() > 2) {
            numbers[fmt::format("ratio.{}", specimen)] = curve->points.front().bulk / K_D;
            if (std::string_view(specimen) != "both") continue;
            numbers["K.start"] = 1e-9 * curve->points.front().bulk;
            numbers["K.end"] = 1e-9 * curve->points.back().bulk;
        }
    if (const double T = equivalent_thickness(r, study.thicknesses); T > 0.0) numbers["T.equivalent"] = 1e9 * T;
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

}  // namespace

Bench make_bench(const Vec3& box, const Study& study, std::int64_t seed, bool calibrate)
{
    Bench bench;
    bench.R_DE = study.domain.mean_radius.value_or(200e-9);
    domain::Settings settings = study.domain;
    settings.seed = seed;
    bench.dense = domain::pack(box, bench.R_DE, settings);
    if (!study.near_contacts) bench.dense.near = {};
    const mechanics::DenseMaterial ceramic = loading::dense_material({});
    bench.calibration = calibrate ? loading::calibrate(bench.dense, ceramic, {})
                                  : loading::measure_given(bench.dense, ceramic, mechanics::BeamMaterial{}, {});
    return bench;
}

Candidate measure(domain::Discretisation discretisation, const Bench& bench, const Study& study)
{
    Candidate out;
    out.numbers["elements"] = discretisation.dense.elements.size();
    out.numbers["bonds"] = discretisation.dense.bonds.size();
    out.numbers["E_B"] = 1e-9 * bench.calibration.beam.E_B;
    out.numbers["r_tilde"] = bench.calibration.beam.r_tilde;
    out.numbers["p_DE"] = 100.0 * domain::discrete_porosity(discretisation);
    read_thickness(discretisation, out.numbers);
    out.response = loading::load(discretisation, laboratory(study, bench.calibration));
    read_response(out.response, study, bench.calibration.target, out.numbers);
    out.discretisation = std::move(discretisation);
    return out;
}

Candidate measure(const synth::Settings& recipe, std::int64_t seed, const Bench& bench, const Study& study)
{
    synth::Settings settings = recipe;
    settings.seed = seed;
    const synth::Coating coating = synth::make_coating(settings);
    const synth::Sight sight =
        study.as_seen ? synth::Sight(settings.microscope, settings.voxel_size, study.threshold) : synth::Sight();
    const double R_B = bench.calibration.beam.r_tilde * bench.R_DE;
    Candidate out = measure(synth::discretise(coating, bench.dense, R_B, sight), bench, study);
    const Vec3& size = coating.size;
    const auto porosity = synth::porosity(coating, std::cbrt(size.x * size.y * size.z) / 192.0);
    out.numbers["porosity.total"] = 100.0 * porosity.total;
    out.numbers["porosity.pores"] = 100.0 * porosity.pores;
    out.numbers["porosity.cracks"] = 100.0 * porosity.cracks;
    return out;
}

double equivalent_thickness(const loading::Response& response, const std::vector<double>& thicknesses)
{
    const auto* open = triaxial_of(response, "cracks");
    if (open == nullptr || thicknesses.size() < 3) return 0.0;
    // Misfit of pressure at equal points; its parabola through the best thickness tried and its neighbours.
    std::vector<std::pair<double, double>> misfit;
    for (const double T : thicknesses) {
        const auto* curve = triaxial_of(response, constant_thickness(T));
        if (curve == nullptr || curve->points.size() != open->points.size()) return 0.0;
        double sum = 0.0;
        for (std::size_t p = 0; p < open->points.size(); ++p)
            sum += std::pow(curve->points[p].pressure - open->points[p].pressure, 2);
        misfit.emplace_back(T, sum);
    }
    std::sort(misfit.begin(), misfit.end());
    const auto best =
        static_cast<std::size_t>(std::min_element(misfit.begin(), misfit.end(),
                                                  [](const auto& a, const auto& b) { return a.second < b.second; }) -
                                 misfit.begin());
    if (best == 0 || best + 1 == misfit.size()) return misfit[best].first;
    const auto [x0, y0] = misfit[best - 1];
    const auto [x1, y1] = misfit[best];
    const auto [x2, y2] = misfit[best + 1];
    const double left = (y1 - y0) / (x1 - x0), right = (y2 - y1) / (x2 - x1), bend = (right - left) / (x2 - x0);
    return std::clamp(0.5 * (x0 + x1) - 0.5 * left / bend, x0, x2);
}

}  // namespace craze::reproduce
