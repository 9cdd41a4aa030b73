#include "craze/core/json.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/loading/theory.hpp"

#include <fmt/core.h>

namespace craze::loading {
namespace {

Json per_axis(const Response& response, const std::string& specimen, double Modulus::*value)
{
    Json axes = Json::object();
    for (const auto& m : response.moduli)
        if (m.specimen == specimen) axes[std::string(1, "xyz"[m.axis])] = m.*value;
    return axes;
}

Json calibration_summary(const Calibration& c)
{
    Json path = Json::array();
    for (const auto& t : c.path) path.push_back({{"r_tilde", t.r_tilde}, {"nu_z", t.nu.z}, {"E_z_Pa", t.E.z}});
    return {{"E_B_Pa", c.beam.E_B},
            {"nu_B", c.beam.nu_B},
            {"r_tilde", c.beam.r_tilde},
            {"E_Pa", c.E},
            {"nu", c.nu},
            {"E_D_Pa", c.target.E_D},
            {"nu_D", c.target.nu_D},
            {"error", c.error},
            {"anisotropy", c.anisotropy},
            {"calibrated", c.done},
            {"from_library", c.from_library},
            {"recipe", c.recipe},
            {"path", std::move(path)}};
}

}  // namespace

Json summary(const Response& response)
{
    Json s = Json::object();
    s["calibration"] = calibration_summary(response.calibration);

    Json moduli = Json::object();
    for (const auto& m : response.moduli) {
        if (moduli.contains(m.specimen)) continue;
        moduli[m.specimen] = {{"tension_Pa", per_axis(response, m.specimen, &Modulus::tension)},
                              {"compression_Pa", per_axis(response, m.specimen, &Modulus::compression)},
                              {"face_strain_Pa", per_axis(response, m.specimen, &Modulus::face)},
                              {"interior_strain_Pa", per_axis(response, m.specimen, &Modulus::interior)},
                              {"poisson_ratio", per_axis(response, m.specimen, &Modulus::nu)}};
    }
    s["moduli"] = std::move(moduli);

    const auto& target = response.calibration.target;
    const Elastic dense{target.E_D, target.nu_D};
    Json triaxial = Json::object();
    for (const auto& curve : response.curves) {
        if (curve.loading.kind != Loading::Kind::triaxial || curve.points.size() < 2) continue;
        const Point &first = curve.points.front(), &last = curve.points.back();
        triaxial[specimen_name(curve.loading.specimen)] = {{"K_first_Pa", first.bulk},
                                                           {"K_last_Pa", last.bulk},
                                                           {"K_first_over_dense", first.bulk / dense.bulk()},
                                                           {"eta_last", last.eta},
                                                           {"pressure_last_Pa", last.pressure},
                                                           {"closure_first", first.closure},
                                                           {"closure_last", last.closure}};
    }
    s["triaxial"] = std::move(triaxial);

    Json strengths = Json::array();
    for (const auto& u : response.strengths) {
        Json row{{"loading", u.loading},
                 {"specimen", u.specimen},
                 {"axis", std::string(1, "xyz"[u.axis])},
                 {"load", u.tension ? "tension" : "compression"},
                 {"sigma_failure_Pa", u.sigma_failure},
                 {"strength_Pa", u.strength},
                 {"strain", u.strain},
                 {"new_contact_beams", u.new_cracks}};
        if (u.change >= 0.0) row["change_at_half_rate"] = u.change;
        strengths.push_back(std::move(row));
    }
    s["strengths"] = std::move(strengths);

    const double p = response.porosity;
    const Elastic bound = hashin_shtrikman(dense, p);
    s["theory_pores"] = {{"porosity", p},
                         {"E_eq18_Pa", porous_modulus(dense, p)},
                         {"E_hashin_shtrikman_Pa", bound.E},
                         {"K_hashin_shtrikman_Pa", bound.bulk()}};

    Json curves = Json::array();
    for (const auto& curve : response.curves) {
        Json row{{"name", curve.loading.name}, {"points", curve.points.size()}, {"seconds", curve.seconds}};
        if (!curve.stopped.empty()) row["stopped"] = curve.stopped;
        curves.push_back(std::move(row));
    }
    s["curves"] = std::move(curves);
    s["notes"] = Json::array(
        {response.calibration.done
             ? fmt::format("Fitted: E_B and r~, so that the dense packing has E_D and nu_D to {:.2g} %.",
                           100.0 * response.calibration.error)
             : std::string("Given, not fitted: E_B, nu_B and r~."),
         "Predicted: everything else. E is stress over box strain [Eqs. 16, 17]; nu is from interior strains.",
         "K = (1 + eta) dP/deta: the second form printed in Eq. 22 lacks the 1."});
    s["seconds"] = response.seconds;
    return s;
}

}  // namespace craze::loading
