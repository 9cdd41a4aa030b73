#include "craze/core/errors.hpp"
#include "craze/synth/synth.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::synth {

namespace {

constexpr Range sizes{1e-9, 1e-3};

}  // namespace

Settings::Settings()
{
    PorePopulation globular{.name = "globular pores",
                            .shape = PoreShape::globular,
                            .radius = {0.45e-6, 0.25, 0.28e-6, 0.9e-6},
                            .flatness = 0.75,
                            .porosity = 0.0248};
    PorePopulation irregular{.name = "irregular pores",
                             .shape = PoreShape::irregular,
                             .radius = {0.55e-6, 0.2, 0.4e-6, 0.9e-6},
                             .flatness = 0.6,
                             .porosity = 0.0330};
    pores = {globular, irregular};
    // Found by trying populations against the paper's moduli, K(eta) and T2: docs/reproduction.md.
    CrackPopulation intra{.name = "intra-splat cracks",
                          .shape = CrackShape::wavy,
                          .radius = {1.2e-6, 0.35, 0.3e-6, 4e-6},
                          .elongation = 1.3,
                          .normals = {0.32, 0.68, 0.0},
                          .scatter = 0.25,
                          .aperture = {80e-9, 0.45, 1e-9, 400e-9},
                          .density = 0.21,
                          .porosity = 0.0247};
    CrackPopulation inter{.name = "inter-splat cracks",
                          .shape = CrackShape::bent,
                          .radius = {1.2e-6, 0.35, 0.3e-6, 4e-6},
                          .elongation = 1.3,
                          .bend = 0.2,
                          .normals = {0.0, 0.0, 1.0},
                          .scatter = 0.25,
                          .aperture = {80e-9, 0.45, 1e-9, 400e-9},
                          .density = 0.04,
                          .porosity = 0.0050};
    cracks = {intra, inter};
}

void describe(Schema& schema, PorePopulation& p)
{
    schema.text("name", p.name, "name in tables and messages");
    schema.option("shape", p.shape, {"globular", "irregular"}, "one ellipsoid, or flattened lobes grown together");
    describe(schema, "radius", p.radius, "radius of the ball of the same volume; of the main lobe if irregular");
    schema.number("flatness", p.flatness, {0.05, 1}, "shortest over longest semi-axis");
    schema.integer("lobes", p.lobes, {2, 50}, "lobes of an irregular pore");
    schema.number("scatter", p.scatter, {0, 100},
                  "irregular pores: spread of their normals about z; above 10 nearly isotropic");
    schema.quantity("porosity", p.porosity, Dimension::fraction, {0, 0.5},
                    "share of the volume; 0 when count is given");
    schema.integer("count", p.count, {0, 1e6}, "number of pores; 0 when porosity is given");
    schema.quantity("gap", p.gap, Dimension::length, {-1e-3, 1e-3},
                    "least distance to other pores; negative: may overlap");
    schema.quantity("clustered", p.clustered, Dimension::fraction, {0, 1}, "share placed about an earlier pore");
    schema.quantity("cluster_radius", p.cluster_radius, Dimension::length, sizes, "spread of a cluster");
}

void describe(Schema& schema, CrackPopulation& c)
{
    schema.text("name", c.name, "name in tables and messages");
    schema.option("shape", c.shape, {"disc", "elliptic", "wavy", "bent"}, "outline and mid-surface");
    describe(schema, "radius", c.radius, "radius of the disc of the same area");
    schema.number("elongation", c.elongation, {1, 10}, "longer over shorter axis; not for discs");
    schema.number("waviness", c.waviness, {0, 0.2}, "wavy: height of the waves over the radius");
    schema.number("bend", c.bend, {0, 1}, "bent: radius over radius of curvature");
    schema.quantities("normals", c.normals, Dimension::pure, {0, 1e6}, "shares of cracks with normals about x, y, z");
    schema.number("scatter", c.scatter, {0, 100}, "spread of the normals about their axis; above 10 nearly isotropic");
    schema.option("profile", c.profile, {"lens", "flat"}, "opening: falling to 0 at the rim, or equal all over");
    describe(schema, "aperture", c.aperture, "greatest opening of a crack");
    schema.number("aperture_growth", c.aperture_growth, {0, 3}, "opening grows as (radius / median radius)^this");
    schema.number("density", c.density, {0, 10}, "sum a^3 / V, met by scaling sizes; 0: number by count or porosity");
    schema.quantity("porosity", c.porosity, Dimension::fraction, {0, 0.5},
                    "share of the volume, met by scaling openings; 0: openings as drawn");
    schema.integer("count", c.count, {0, 1e6}, "number of cracks centred in the box; 0: by density or porosity");
    schema.number("gap", c.gap, {-1, 2}, "least distance of centres over the sum of radii; negative: free");
    schema.quantity("clustered", c.clustered, Dimension::fraction, {0, 1}, "share placed about an earlier crack");
    schema.quantity("cluster_radius", c.cluster_radius, Dimension::length, sizes, "spread of a cluster");
    schema.quantity("at_pores", c.at_pores, Dimension::fraction, {0, 1}, "share that starts at the wall of a pore");
}

void describe(Schema& schema, Settings& s)
{
    schema.integers("shape", s.shape, {8, 20000}, "voxels along x, y, z");
    schema.quantity("voxel_size", s.voxel_size, Dimension::length, {1e-10, 1e-2}, "edge of a voxel");
    schema.integer("seed", s.seed, {0, 9e15}, "another seed, another coating of the same statistics");
    schema.option("generator", s.generator, {"populations", "splats"},
                  "defects placed at random, or left by splats sprayed one on another");
    schema.items("pores", s.pores, "populations of pores");
    schema.items("cracks", s.cracks, "populations of cracks");
    schema.group("splats", "the second generator", [&] { describe(schema, s.splats); });
    schema.group("microscope", "faults of the images", [&] { describe(schema, s.microscope); });
}

void check(const Settings& s)
{
    if (s.shape.size() != 3) throw InvalidInput(fmt::format("synth.shape needs three numbers, got {}", s.shape.size()));
    if (!(s.voxel_size > 0.0)) throw InvalidInput("synth.voxel_size must be above 0");
    const double voxels =
        static_cast<double>(s.shape[0]) * static_cast<double>(s.shape[1]) * static_cast<double>(s.shape[2]);
    if (voxels > 2e10) throw InvalidInput(fmt::format("synth.shape: {:g} voxels are more than 2e10", voxels));
    check(s.splats);
    for (const auto& p : s.pores) {
        check(p.radius, "radius of " + p.name);
        if ((p.porosity > 0.0) + (p.count > 0) != 1)
            throw InvalidInput(fmt::format("synth: {} needs either porosity or count above 0", p.name));
    }
    for (const auto& c : s.cracks) {
        check(c.radius, "radius of " + c.name);
        check(c.aperture, "aperture of " + c.name);
        if ((c.density > 0.0) + (c.count > 0) != 1 && !(c.porosity > 0.0 && c.density == 0.0 && c.count == 0))
            throw InvalidInput(fmt::format(
                "synth: {} needs density or count or porosity above 0, and not density with count", c.name));
        if (c.normals.size() != 3 || !(c.normals[0] + c.normals[1] + c.normals[2] > 0.0))
            throw InvalidInput(fmt::format("synth: normals of {} need three shares that are not all 0", c.name));
        if (c.at_pores > 0.0 && s.pores.empty())
            throw InvalidInput(fmt::format("synth: {} has at_pores above 0, but there are no pores", c.name));
    }
}

Vec3 box_of(const Settings& s)
{
    return {static_cast<double>(s.shape[0]) * s.voxel_size, static_cast<double>(s.shape[1]) * s.voxel_size,
            static_cast<double>(s.shape[2]) * s.voxel_size};
}

}  // namespace craze::synth
