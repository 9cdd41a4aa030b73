// What would a microscope see of a coating whose truth we know?
//
// Populations of pores and cracks are placed in a box [make_coating], photographed by a microscope with the faults of a
// FIB-SEM [observe], and written as an image stack with the truth beside it [save]. The chain never reads the truth.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/schema.hpp"
#include "craze/images/gray.hpp"
#include "craze/synth/coating.hpp"
#include "craze/synth/length.hpp"
#include "craze/synth/microscope.hpp"
#include "craze/synth/render.hpp"
#include "craze/synth/splats.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace craze::synth {

enum class PoreShape { globular, irregular };

/// Pores alike. How many: one of porosity and count is above zero.
/// Globular: one ellipsoid. Irregular: flattened lobes grown into each other, as gaps between splats.
struct PorePopulation {
    std::string name = "pores";
    PoreShape shape = PoreShape::globular;
    Length radius{0.6e-6, 0.3, 0.25e-6, 2e-6};  ///< of the ball of the same volume (of the main lobe when irregular)
    double flatness = 1.0;                      ///< shortest over longest semi-axis, (0, 1]
    std::int64_t lobes = 4;                     ///< of an irregular pore
    double scatter = 0.0;                       ///< of an irregular pore's normal about z, as of cracks below
    double porosity = 0.0;                      ///< share of the volume; sizes are scaled a little to meet it exactly
    std::int64_t count = 0;                     ///< instead: number centred in the box
    double gap = 0.1e-6;           ///< least distance to pores placed before, m; negative lets them overlap
    double clustered = 0.0;        ///< share placed about an earlier pore of the population
    double cluster_radius = 2e-6;  ///< standard deviation of that distance along each axis, m
};

enum class CrackShape { disc, elliptic, wavy, bent };

/// Cracks alike. How many: by density or by count, or, where both are 0, until porosity is reached.
struct CrackPopulation {
    std::string name = "cracks";
    CrackShape shape = CrackShape::disc;
    Length radius{1.2e-6, 0.4, 0.4e-6, 3.5e-6};  ///< sqrt(a b)
    double elongation = 1.0;                     ///< a / b of elliptic and wavy and bent cracks, >= 1
    double waviness = 0.08;                      ///< wavy: height of the waves over the radius
    double bend = 0.4;                           ///< bent: radius over radius of curvature
    std::vector<double> normals{1, 1, 1};        ///< shares of cracks with normals about x, y, z
    double scatter = 0.3;  ///< normals are axis + scatter times a normal vector; large = isotropic
    ApertureProfile profile = ApertureProfile::lens;
    Length aperture{45e-9, 0.6, 2e-9, 380e-9};  ///< greatest opening
    double aperture_growth = 0.0;               ///< opening grows as (radius / median radius)^this
    double density = 0.0;    ///< sum a^3 / V of the cracks centred in the box; sizes are scaled to meet it exactly
    double porosity = 0.0;   ///< share of the box outside pores; openings are scaled to meet it; 0: as drawn
    std::int64_t count = 0;  ///< number centred in the box
    double gap = -1.0;       ///< least distance of centres over the sum of radii; negative = free
    double clustered = 0.0;  ///< share placed about an earlier crack of the population
    double cluster_radius = 2e-6;  ///< m
    double at_pores = 0.0;         ///< share that starts at the wall of a pore
};

enum class Generator { populations, splats };

struct Settings {
    std::vector<std::int64_t> shape{300, 300, 300};  ///< voxels along x, y, z
    double voxel_size = 23.6e-9;                     ///< m
    std::int64_t seed = 1;
    Generator generator = Generator::populations;
    std::vector<PorePopulation> pores;    ///< default: those of an air-plasma-sprayed 8YSZ coating
    std::vector<CrackPopulation> cracks;  ///< likewise
    Splats splats;                        ///< for the other generator
    Microscope microscope;

    Settings();
};

void describe(Schema& schema, PorePopulation& population);
void describe(Schema& schema, CrackPopulation& population);
void describe(Schema& schema, Settings& settings);
/// @throws InvalidInput  naming the key and what was needed
void check(const Settings& settings);

/// The box of the settings, m.
Vec3 box_of(const Settings& settings);

/// Places all populations, pores first, or sprays splats. Depends on the settings and their seed only.
/// @throws InvalidInput  when a population finds no room, saying which and what to change
Coating make_coating(const Settings& settings);

/// What the microscope saw, and what was there.
struct Observation {
    images::Gray stack;          ///< 8-bit slices as recorded
    Volume<std::uint8_t> label;  ///< 255 matter, 0 pore, 128 crack: void where at least half of the voxel is void
    Porosity fraction;           ///< true porosities by the void shares of the voxels
    Porosity voxels;             ///< true porosities by counting labels
    std::vector<Vec3>
        positions;  ///< where each slice was taken: (drift x, drift y, depth z), voxels; (0, 0, k) is right
};
Observation observe(const Coating& coating, const Settings& settings);

/// What summary.json says of synth; keys in docs/results.md.
Json summary(const Coating& coating, const Observation& observation, const Settings& settings);

/// Writes stack.tif (what the chain reads), and beside it truth.mhd, truth.json, defects.csv, cracks.ply.
void save(const Coating& coating, const Observation& observation, const Settings& settings,
          const std::filesystem::path& folder);

}  // namespace craze::synth
