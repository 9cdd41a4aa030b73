// What do we impose, what do we measure? The virtual laboratory [3.1.2, 4]: calibration, tension, compression,
// triaxial compression, cycles, fracture, and any program of strain.
//
// A specimen is named by its defects ("dense", "pores", "cracks closed", "both", "cracks 40 nm"); all specimens share
// one packing and one calibration, so Table 3 or Fig. 22 is one list in the settings and one run.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/schema.hpp"
#include "craze/domain/discretisation.hpp"
#include "craze/loading/response.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace craze::loading {

/// A loading of one's own making.
struct Program {
    std::string name = "program";
    std::string specimen = "both";
    std::vector<std::string> axes{"free", "free", "1"};  ///< x, y, z: free, or strain over the program's
    std::vector<double> turns{2e-3, 0.0};                ///< program strain goes straight from one to the next
    std::int64_t points = 20;                            ///< per straight part
    bool motion = false;
    double strength = 0.0;  ///< sigma_failure, Pa; 0: bonds never break
    double crossings = 40.0;
    double local_damping = 0.1;
    double damping = 0.0;
    double stop_drop = 1.0;
    double stop_damage = 1.0;
};
void describe(Schema& schema, Program& program);

struct Settings {
    struct Dense {
        std::string material = "8YSZ";           ///< of the library
        std::optional<double> E_D, nu_D, rho_D;  ///< instead of the library's, Pa, -, kg/m3
    } dense;
    struct Beam {
        bool calibrate = true;
        mechanics::BeamMaterial given;  ///< [Table 2]; used as it is when calibrate is off, else nu_B and first guess
        double tolerance = 1e-3;        ///< on E and nu
        std::string library;            ///< JSON file that keeps calibrations; empty: none
    } beam;
    std::vector<std::string> specimens{"dense", "pores", "cracks", "both"};
    double face_reach = 1.05;       ///< sides: centre within this many own radii of the wall
    double interior_margin = 10.0;  ///< interior: this many mean radii away from every wall
    double residual = 1e-6;         ///< of the equilibria of moduli, over the driving forces
    double curve_residual = 5e-5;   ///< of those along a curve: docs/benchmarks.md says what it costs K

    struct Moduli {
        bool run = true;
        std::vector<std::string> specimens;  ///< empty: all of the run
        std::string axes = "xyz";
        double strain = 1e-3;
    } moduli;
    struct Uniaxial {
        bool run = true;
        std::vector<std::string> specimens{"both"};
        std::string axes = "xyz";
        double tension = 2e-3, compression = 6e-3;  ///< largest strains; 0: not run
        std::int64_t points = 12;
    } uniaxial;
    struct Triaxial {
        bool run = true;
        std::vector<std::string> specimens;
        double eta = 0.015;
        std::int64_t points = 30;
        enum class Sides { displacement, strain } sides = Sides::displacement;
    } triaxial;
    struct Fracture {
        bool run = false;
        std::vector<std::string> specimens{"both"};
        std::string axes = "x";
        std::vector<double> strengths{10e9};        ///< sigma_failure, Pa [Table 4]
        double tension = 3e-3, compression = 8e-3;  ///< largest strains for each 10 GPa of bond strength
        double crossings = 40.0;     ///< wave crossings of the specimen per strain of sigma_failure / E_B
        double local_damping = 0.1;  ///< beta, share of the force out of balance that opposes motion
        double damping = 0.0;        ///< mass damping beside it, times 0.4 (2 pi c / L)
        double bending_share = 1.0;  ///< of the bending stress of a beam that counts towards its strength [Eq. 24]
        double stop_drop = 0.5;
        std::int64_t points = 200;
        std::int64_t halvings = 0;   ///< run again at a half, a quarter, ... of the rate: how far strength moves
        std::vector<double> cycles;  ///< peaks of strain, signed; empty: no cycles
    } fracture;
    std::vector<Program> programs;

    struct Output {
        std::vector<double> states;  ///< program strains at which states are kept for ParaView
        bool last_state = true;      ///< keep the last state of each curve
        double checkpoint = 60.0;    ///< seconds between restart files of a loading in motion; 0: none
    } output;
};

void describe(Schema& schema, Settings& settings);
/// @throws InvalidInput  naming the key, what is wrong and what would do
void check(const Settings& settings);

/// The dense ceramic that the settings name [Table 1].
/// @throws InvalidInput  when the library has no such material
mechanics::DenseMaterial dense_material(const Settings& settings);

/// Every loading that the settings ask for, in the order they are run.
/// @param box  edges of the specimen, m: a triaxial loading moves all sides by the same displacement [4.2.1]
std::vector<Loading> plan(const Settings& settings, const Vec3& box);

/// Calibrates (or takes the given beams), makes each specimen once, runs each loading.
/// @param folder  where states and restart files go as they come; empty: nowhere
/// @throws InvalidInput       when the settings or the discretisation are wrong
/// @throws ComputationFailed  when a loading cannot be solved, with the last strain reached and what to try
/// @throws Interrupted        after writing a restart file, when asked to stop
Response load(const domain::Discretisation& discretisation, const Settings& settings,
              const std::filesystem::path& folder = {});

/// response.json (all of it) and one CSV per curve, of its points and of its broken bonds.
void save(const Response& response, const std::filesystem::path& folder);
Response load_response(const std::filesystem::path& folder);

/// Keys: docs/results.md, "loading".
Json summary(const Response& response);

}  // namespace craze::loading
