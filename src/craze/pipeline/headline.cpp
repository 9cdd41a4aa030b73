#include "craze/pipeline/headline.hpp"

#include "craze/core/json.hpp"
#include "craze/pipeline/steps.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::pipeline {

namespace {

// A number at a path of keys, NaN where there is none.
double at(const Json& json, std::initializer_list<const char*> path)
{
    const Json* here = &json;
    for (const char* key : path) {
        if (!here->is_object() || !here->contains(key)) return std::nan("");
        here = &here->at(key);
    }
    return here->is_number() ? here->get<double>() : std::nan("");
}

std::string shown(double value, double unit, int decimals)
{
    return std::isfinite(value) ? fmt::format("{:.{}f}", value / unit, decimals) : "-";
}

std::string porosities(const char* name, double total, double pores, double cracks)
{
    return fmt::format("  porosity, {:<9} {:>6} % total {:>6} % pores {:>6} % cracks\n", name, shown(total, 0.01, 2),
                       shown(pores, 0.01, 2), shown(cracks, 0.01, 2));
}

std::string moduli(const Json& loading)
{
    if (!loading.contains("moduli") || loading["moduli"].empty()) return "";
    std::string text = fmt::format("  {:<26} {:>8} {:>8} {:>8}\n", "Young's modulus, GPa", "x", "y", "z");
    for (const auto& item : loading["moduli"].items())
        for (const char* sense : {"tension", "compression"}) {
            const auto key = fmt::format("{}_Pa", sense);
            const auto axis = [&](const char* a) { return shown(at(item.value(), {key.c_str(), a}), 1e9, 1); };
            text += fmt::format("    {:<24} {:>8} {:>8} {:>8}\n", fmt::format("{}, {}", item.key(), sense), axis("x"),
                                axis("y"), axis("z"));
        }
    return text;
}

std::string triaxial(const Json& loading)
{
    if (!loading.contains("triaxial") || loading["triaxial"].empty()) return "";
    std::string text = fmt::format("  {:<26} {:>12} {:>14} {:>20}\n", "triaxial compression", "K(0), GPa",
                                   "K(last), GPa", "gamma at last eta");
    for (const auto& [specimen, t] : loading["triaxial"].items())
        text += fmt::format("    {:<24} {:>12} {:>14} {:>10} % at {:>4} %\n", specimen,
                            shown(at(t, {"K_first_Pa"}), 1e9, 1), shown(at(t, {"K_last_Pa"}), 1e9, 1),
                            shown(at(t, {"closure_last"}), 0.01, 1), shown(at(t, {"eta_last"}), 0.01, 2));
    return text;
}

std::string strengths(const Json& loading)
{
    std::string text;
    if (!loading.contains("strengths")) return text;
    for (const Json& s : loading["strengths"])
        text +=
            fmt::format("  strength: {:<40} {:>8} MPa\n", s.value("test", ""), shown(at(s, {"strength_Pa"}), 1e6, 1));
    return text;
}

}  // namespace

std::string headline(const std::filesystem::path& out)
{
    const Json synth = read_summary(out, "synth"), micro = read_summary(out, "microstructure");
    const Json domain = read_summary(out, "domain"), loading = read_summary(out, "loading");
    std::string text;
    if (!synth.is_null()) {
        const double pores = at(synth, {"true_porosity", "pores"}), cracks = at(synth, {"true_porosity", "cracks"});
        text += porosities("truth", pores + cracks, pores, cracks);
    }
    if (!micro.is_null())
        text += porosities("measured", at(micro, {"porosity", "total"}), at(micro, {"porosity", "pores"}),
                           at(micro, {"porosity", "cracks"}));
    if (!domain.is_null())
        text += fmt::format(
            "  elements {}, bonds {}, contact beams {}\n", shown(at(domain, {"specimen", "elements"}), 1, 0),
            shown(at(domain, {"specimen", "bonds"}), 1, 0), shown(at(domain, {"specimen", "contact_beams"}), 1, 0));
    if (!loading.is_null()) {
        const Json c = loading.value("calibration", Json::object());
        text +=
            fmt::format("  {} E_B = {} GPa, r~ = {}; they give E = {} GPa, nu = {}\n",
                        c.value("calibrated", false) ? "calibrated" : "given", shown(at(c, {"E_B_Pa"}), 1e9, 0),
                        shown(at(c, {"r_tilde"}), 1, 4), shown(at(c, {"E_Pa"}), 1e9, 1), shown(at(c, {"nu"}), 1, 4));
        text += moduli(loading) + triaxial(loading) + strengths(loading);
    }
    if (std::filesystem::exists(out / "report" / "index.html"))
        text += fmt::format("  report: {}\n", (out / "report" / "index.html").string());
    return text;
}

}  // namespace craze::pipeline
