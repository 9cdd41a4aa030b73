#include "craze/core/errors.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/material_library.hpp"
#include "craze/loading/specimen.hpp"

#include <fmt/format.h>

#include <set>

namespace craze::loading {
namespace {

constexpr Range open_share{1e-9, 1.0}, strain_range{0.0, 0.2};
constexpr const char* axes_meaning = "axes to load along, any of x, y, z";

void check_specimens(const std::vector<std::string>& names, std::string_view key)
{
    std::set<std::string> seen;
    for (const auto& name : names) {
        try {
            if (!seen.insert(specimen_name(parse_specimen(name))).second)
                throw InvalidInput(fmt::format("specimen \"{}\" is listed twice", name));
        } catch (const InvalidInput& error) {
            throw InvalidInput(fmt::format("loading.{}: {}", key, error.what()));
        }
    }
}

void check_axes(const std::string& axes, std::string_view key)
{
    const bool fine = !axes.empty() && axes.find_first_not_of("xyz") == std::string::npos &&
                      std::set<char>(axes.begin(), axes.end()).size() == axes.size();
    if (!fine)
        throw InvalidInput(
            fmt::format("loading.{}: needed some of the letters x, y, z, each once, got \"{}\"", key, axes));
}

std::array<Drive, 3> drives_of(const Program& program)
{
    const auto wrong = [&](const std::string& why) {
        return InvalidInput(
            fmt::format("loading.programs \"{}\": axes: {}; needed three of \"free\" or a factor of the "
                        "program's strain, such as [\"free\", \"free\", \"1\"]",
                        program.name, why));
    };
    if (program.axes.size() != 3) throw wrong(fmt::format("got {} entries", program.axes.size()));
    std::array<Drive, 3> drives;
    bool moving = false;
    for (std::size_t a = 0; a < 3; ++a) {
        if (program.axes[a] == "free") continue;
        double factor = 0.0;
        try {
            factor = parse_quantity(program.axes[a], Dimension::pure);
        } catch (const InvalidInput&) {
            throw wrong(fmt::format("got \"{}\"", program.axes[a]));
        }
        if (!(std::abs(factor) <= 100.0)) throw wrong(fmt::format("factor {} is beyond 100", factor));
        drives[a] = {false, factor};
        moving = moving || factor != 0.0;
    }
    if (!moving) throw wrong("no axis moves");
    return drives;
}

}  // namespace

void describe(Schema& schema, Program& p)
{
    schema.text("name", p.name, "name of the loading in results");
    schema.text("specimen", p.specimen,
                "dense, pores, cracks or both, with T1, closed or a thickness after the last two");
    schema.texts("axes", p.axes, "x, y, z: free, or the factor of the program's strain (0: held)");
    schema.quantities("turns", p.turns, Dimension::fraction, {-0.2, 0.2},
                      "strain goes from 0 to each of these in turn");
    schema.integer("points", p.points, {1, 100000}, "points on each straight part");
    schema.flag("motion", p.motion, "solve Newton's law (cracking) instead of equilibrium");
    schema.quantity("strength", p.strength, Dimension::pressure, {0.0, 1e15},
                    "bond strength sigma_failure; 0: never breaks");
    schema.number(
        "crossings", p.crossings, {0.1, 1e6},
        "motion: wave crossings of the axial edge in the whole path; with a strength, per strain of sigma/E_B");
    schema.number("local_damping", p.local_damping, {0.0, 0.9},
                  "motion: this share of the force out of balance opposes motion");
    schema.number("damping", p.damping, {0.0, 1e4}, "motion: mass damping, times the reference");
    schema.quantity("stop_drop", p.stop_drop, Dimension::fraction, open_share,
                    "stop after this fall of stress from its peak; 1: never");
    schema.quantity("stop_damage", p.stop_damage, Dimension::fraction, open_share,
                    "stop when this share of bonds is broken; 1: never");
}

void describe(Schema& schema, Settings& s)
{
    schema.group("dense", "the dense ceramic [Table 1]", [&] {
        schema.text("material", s.dense.material, "name in the library: 8YSZ, or one of loading.beam.library");
        schema.quantity("young_modulus", s.dense.E_D, Dimension::pressure, {1e3, 1e14}, "E_D; auto: the material's");
        schema.quantity("poisson_ratio", s.dense.nu_D, Dimension::pure, {0.05, 0.45}, "nu_D; auto: the material's");
        schema.quantity("density", s.dense.rho_D, Dimension::density, {1.0, 1e5}, "rho_D; auto: the material's");
    });
    schema.group("beam", "the beams between elements [3.1.2, Table 2]", [&] {
        schema.flag("calibrate", s.beam.calibrate, "find E_B and r~ that give E_D and nu_D; off: use the values below");
        schema.quantity("young_modulus", s.beam.given.E_B, Dimension::pressure, {1e3, 1e16}, "E_B");
        schema.number("poisson_ratio", s.beam.given.nu_B, {0.0, 0.5}, "nu_B");
        schema.number("radius_ratio", s.beam.given.r_tilde, {0.05, 1.0},
                      "r~, beam radius over mean element radius [Eq. 3]");
        schema.quantity("tolerance", s.beam.tolerance, Dimension::fraction, {1e-5, 0.05},
                        "calibrated to this share of E_D and nu_D");
        schema.path("library", s.beam.library, "JSON file that keeps calibrations for use again; empty: none");
    });
    schema.texts("specimens", s.specimens,
                 "dense, pores, cracks, both; the last two also T1, closed or a thickness: cracks 40 nm");
    schema.number("face_reach", s.face_reach, {0.1, 10.0},
                  "sides: elements whose centre lies within this many of their radii of the wall");
    schema.number("interior_margin", s.interior_margin, {0.0, 1e3},
                  "interior strain: elements this many mean radii away from every wall");
    schema.number("residual", s.residual, {1e-12, 1e-2}, "residual of equilibrium over the driving forces, moduli");
    schema.number("curve_residual", s.curve_residual, {1e-12, 1e-2},
                  "the same along curves; 5e-5 gives the stress to 1e-5 and K to 1e-4");
    schema.group("moduli", "Young's moduli and Poisson's ratios at small strain [Table 3]", [&] {
        schema.flag("run", s.moduli.run, "measure them");
        schema.texts("specimens", s.moduli.specimens, "empty: all of loading.specimens");
        schema.text("axes", s.moduli.axes, axes_meaning);
        schema.quantity("strain", s.moduli.strain, Dimension::fraction, {1e-7, 0.01},
                        "strain, tension and compression");
    });
    schema.group("uniaxial", "stress-strain curves [Figs. 17, 18]", [&] {
        schema.flag("run", s.uniaxial.run, "run them");
        schema.texts("specimens", s.uniaxial.specimens, "empty: all of loading.specimens");
        schema.text("axes", s.uniaxial.axes, axes_meaning);
        schema.quantity("tension", s.uniaxial.tension, Dimension::fraction, strain_range,
                        "largest tensile strain; 0: no tension");
        schema.quantity("compression", s.uniaxial.compression, Dimension::fraction, strain_range,
                        "largest compressive strain; 0: no compression");
        schema.integer("points", s.uniaxial.points, {1, 10000}, "points on each curve");
    });
    schema.group("triaxial", "pressure, density, bulk modulus and crack closure [Figs. 20-22]", [&] {
        schema.flag("run", s.triaxial.run, "run it");
        schema.texts("specimens", s.triaxial.specimens, "empty: all of loading.specimens");
        schema.quantity("eta", s.triaxial.eta, Dimension::fraction, {1e-6, 0.2}, "largest normalised density [Eq. 20]");
        schema.integer("points", s.triaxial.points, {2, 10000}, "points on each curve");
        schema.option("sides", s.triaxial.sides, {"displacement", "strain"}, "what is the same along x, y and z");
    });
    schema.group("fracture", "tension, compression and cycles with bonds that break [4.3]", [&] {
        schema.flag("run", s.fracture.run, "run them");
        schema.texts("specimens", s.fracture.specimens, "empty: all of loading.specimens");
        schema.text("axes", s.fracture.axes, axes_meaning);
        schema.quantities("strengths", s.fracture.strengths, Dimension::pressure, {1.0, 1e15},
                          "bond strengths sigma_failure [Table 4]");
        schema.quantity("tension", s.fracture.tension, Dimension::fraction, strain_range,
                        "largest tensile strain for each 10 GPa of bond strength; 0: no tension");
        schema.quantity("compression", s.fracture.compression, Dimension::fraction, strain_range,
                        "largest compressive strain for each 10 GPa of bond strength; 0: no compression");
        schema.number("crossings", s.fracture.crossings, {0.1, 1e6},
                      "wave crossings of the specimen while strain grows by sigma_failure / E_B: more is slower");
        schema.number("local_damping", s.fracture.local_damping, {0.0, 0.9},
                      "this share of the force out of balance on an element opposes its motion");
        schema.number("damping", s.fracture.damping, {0.0, 1e4},
                      "mass damping beside it, times 0.4 (2 pi c / L): drags, so strengths hang on the rate");
        schema.number("bending_share", s.fracture.bending_share, {0.0, 1.0},
                      "of a beam's bending stress, this share counts towards its strength [Eq. 24]; 1 as printed");
        schema.quantity("stop_drop", s.fracture.stop_drop, Dimension::fraction, open_share,
                        "stop after this fall of stress from its peak; 1: never");
        schema.integer("points", s.fracture.points, {2, 100000}, "points on each curve");
        schema.integer("halvings", s.fracture.halvings, {0, 8},
                       "rate convergence: run again at a half, a quarter, ... of the rate, this many times");
        schema.quantities("cycles", s.fracture.cycles, Dimension::fraction, {-0.2, 0.2},
                          "peaks of strain, each followed by unloading [Fig. 25]; empty: no cycles");
    });
    schema.items("programs", s.programs, "loadings of your own making");
    schema.group("output", "states for ParaView and restart files", [&] {
        schema.quantities("states", s.output.states, Dimension::fraction, {-0.2, 0.2},
                          "program strains at which states are kept");
        schema.flag("last_state", s.output.last_state, "keep the last state of each curve");
        schema.quantity("checkpoint", s.output.checkpoint, Dimension::time, {0.0, 1e6},
                        "between restart files; 0: none");
    });
}

mechanics::DenseMaterial dense_material(const Settings& s)
{
    const bool given = s.dense.E_D && s.dense.nu_D && s.dense.rho_D;
    mechanics::DenseMaterial dense =
        given ? mechanics::DenseMaterial{} : find_material(s.dense.material, s.beam.library);
    return {s.dense.E_D.value_or(dense.E_D), s.dense.nu_D.value_or(dense.nu_D), s.dense.rho_D.value_or(dense.rho_D)};
}

void check(const Settings& s)
{
    dense_material(s);
    if (s.specimens.empty())
        throw InvalidInput("loading.specimens: needed at least one of dense, pores, cracks, both, got an empty list");
    check_specimens(s.specimens, "specimens");
    check_specimens(s.moduli.specimens, "moduli.specimens");
    check_specimens(s.uniaxial.specimens, "uniaxial.specimens");
    check_specimens(s.triaxial.specimens, "triaxial.specimens");
    check_specimens(s.fracture.specimens, "fracture.specimens");
    check_axes(s.moduli.axes, "moduli.axes");
    check_axes(s.uniaxial.axes, "uniaxial.axes");
    check_axes(s.fracture.axes, "fracture.axes");
    if (s.fracture.run && s.fracture.strengths.empty())
        throw InvalidInput(
            "loading.fracture.strengths: needed at least one bond strength, such as [\"10 GPa\"], got an empty list");
    std::set<std::string> names;
    for (const auto& program : s.programs) {
        check_specimens({program.specimen}, fmt::format("programs \"{}\"", program.name));
        drives_of(program);
        if (program.turns.empty())
            throw InvalidInput(
                fmt::format("loading.programs \"{}\": turns: needed at least one strain, got none", program.name));
        if (program.name.empty() || !names.insert(program.name).second)
            throw InvalidInput(fmt::format("loading.programs: each needs a name of its own, got \"{}\" {}",
                                           program.name, program.name.empty() ? "" : "twice"));
        if (program.strength > 0.0 && !program.motion)
            throw InvalidInput(
                fmt::format("loading.programs \"{}\": bonds break in motion only; set motion = true or strength = 0",
                            program.name));
    }
}

namespace {

using Names = std::vector<std::string>;
const Names& or_all(const Names& some, const Settings& s) { return some.empty() ? s.specimens : some; }

std::vector<double> even(double end, std::int64_t points)
{
    std::vector<double> path;
    for (std::int64_t k = 1; k <= points; ++k)
        path.push_back(end * static_cast<double>(k) / static_cast<double>(points));
    return path;
}

/// From 0 to each turn in straight lines of `points` each.
std::vector<double> through(const std::vector<double>& turns, std::int64_t points)
{
    std::vector<double> path;
    double from = 0.0;
    for (const double to : turns) {
        for (const double share : even(1.0, points)) path.push_back(share == 1.0 ? to : from + (to - from) * share);
        from = to;
    }
    return path;
}

Loading uniaxial_test(Loading::Kind kind, const std::string& specimen, int axis, double end, std::int64_t points)
{
    Loading loading;
    loading.kind = kind;
    loading.specimen = parse_specimen(specimen);
    loading.axis = axis;
    loading.drive[static_cast<std::size_t>(axis)] = {false, 1.0};
    loading.path = even(end, points);
    const char* verb = kind == Loading::Kind::modulus    ? "modulus"
                       : kind == Loading::Kind::fracture ? "fracture"
                                                         : "uniaxial";
    loading.name = fmt::format("{} {} {} {}", specimen_name(loading.specimen), verb, "xyz"[axis],
                               end > 0.0 ? "tension" : "compression");
    return loading;
}

}  // namespace

std::vector<Loading> plan(const Settings& s, const Vec3& box)
{
    std::vector<Loading> loadings;
    const auto axis_of = [](char c) { return c - 'x'; };
    if (s.moduli.run)
        for (const auto& specimen : or_all(s.moduli.specimens, s))
            for (const char axis : s.moduli.axes)
                for (const double sign : {1.0, -1.0})
                    loadings.push_back(
                        uniaxial_test(Loading::Kind::modulus, specimen, axis_of(axis), sign * s.moduli.strain, 1));
    if (s.uniaxial.run)
        for (const auto& specimen : or_all(s.uniaxial.specimens, s))
            for (const char axis : s.uniaxial.axes)
                for (const double end : {s.uniaxial.tension, -s.uniaxial.compression})
                    if (end != 0.0)
                        loadings.push_back(
                            uniaxial_test(Loading::Kind::uniaxial, specimen, axis_of(axis), end, s.uniaxial.points));
    if (s.triaxial.run)
        for (const auto& specimen : or_all(s.triaxial.specimens, s)) {
            Loading loading;
            loading.kind = Loading::Kind::triaxial;
            loading.specimen = parse_specimen(specimen);
            loading.name = fmt::format("{} triaxial", specimen_name(loading.specimen));
            const double mean = (box.x + box.y + box.z) / 3.0;
            for (int a = 0; a < 3; ++a)
                loading.drive[static_cast<std::size_t>(a)] = {
                    false, s.triaxial.sides == Settings::Triaxial::Sides::strain ? 1.0 : mean / box[a]};
            for (const double eta : even(s.triaxial.eta, s.triaxial.points))
                loading.path.push_back(strain_at_density(loading.drive, eta));
            loadings.push_back(std::move(loading));
        }
    if (s.fracture.run)
        for (const auto& specimen : or_all(s.fracture.specimens, s))
            for (const char axis : s.fracture.axes)
                for (const double strength : s.fracture.strengths) {
                    const auto in_motion = [&](Loading loading) {
                        loading.solver = Solver::motion;
                        loading.strength = strength;
                        loading.crossings = s.fracture.crossings;
                        loading.local_damping = s.fracture.local_damping;
                        loading.damping = s.fracture.damping;
                        loading.bending_share = s.fracture.bending_share;
                        loading.name =
                            fmt::format("{} {}", loading.name, format_quantity(strength, Dimension::pressure));
                        return loading;
                    };
                    for (const double end : {s.fracture.tension, -s.fracture.compression}) {
                        if (end == 0.0) continue;
                        auto loading = in_motion(uniaxial_test(Loading::Kind::fracture, specimen, axis_of(axis),
                                                               end * strength / 10e9, s.fracture.points));
                        loading.stop_drop = s.fracture.stop_drop;
                        loadings.push_back(loading);
                        for (std::int64_t h = 0; h < s.fracture.halvings; ++h) {
                            loading.crossings *= 2.0;
                            loading.name = half_rate_name(loading.name);
                            loadings.push_back(loading);
                        }
                    }
                    if (s.fracture.cycles.empty()) continue;
                    Loading loading =
                        uniaxial_test(Loading::Kind::cycles, specimen, axis_of(axis), s.fracture.cycles.front(), 1);
                    std::vector<double> turns;
                    for (const double peak : s.fracture.cycles) turns.insert(turns.end(), {peak, 0.0});
                    const auto legs = static_cast<std::int64_t>(turns.size());
                    loading.path = through(turns, std::max<std::int64_t>(10, s.fracture.points / legs));
                    loading.name = fmt::format("{} cycles {}", specimen_name(loading.specimen), axis);
                    loading = in_motion(std::move(loading));
                    // Turns make waves that would ring on under local damping alone.
                    loading.crossings *= 4.0;
                    loading.damping = std::max(loading.damping, 1.0);
                    loadings.push_back(std::move(loading));
                }
    for (const auto& program : s.programs) {
        Loading loading;
        loading.kind = Loading::Kind::program;
        loading.name = program.name;
        loading.specimen = parse_specimen(program.specimen);
        loading.drive = drives_of(program);
        for (int a = 2; a >= 0; --a)
            if (!loading.drive[static_cast<std::size_t>(a)].free &&
                loading.drive[static_cast<std::size_t>(a)].factor != 0.0)
                loading.axis = a;
        loading.path = through(program.turns, program.points);
        loading.solver = program.motion ? Solver::motion : Solver::equilibrium;
        if (program.strength > 0.0) loading.strength = program.strength;
        loading.crossings = program.crossings;
        loading.local_damping = program.local_damping;
        loading.damping = program.damping;
        loading.stop_drop = program.stop_drop;
        loading.stop_damage = program.stop_damage;
        loadings.push_back(std::move(loading));
    }
    return loadings;
}

}  // namespace craze::loading
