#include "craze/core/errors.hpp"
#include "craze/domain/room.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::domain {

void describe(Schema& schema, Settings& s)
{
    schema.quantity("mean_radius", s.mean_radius, Dimension::length, {1e-10, 1.0},
                    "mean radius R_DE of the elements; auto: the closing radius R_C [Eq. 11]");
    schema.quantity("dispersion", s.dispersion, Dimension::fraction, {0.0, 0.9}, "spread of the radii [3.1.1]");
    schema.option("dispersion_means", s.dispersion_means, {"total_width", "each_side"},
                  "total_width: 25 % is -12.5 % to +12.5 %; each_side: -25 % to +25 %");
    schema.number("density", s.density, {0.0, 0.3}, "elements per R_DE^3 away from walls; 0: the paper's 0.152");
    schema.number("cardinality", s.cardinality, {1.0, 12.0}, "mean bonds of an element that touches no wall");
    schema.number("near_gap", s.near_gap, {0.0, 1.0}, "unbonded pairs nearer than this many R_DE may touch under load");
    schema.flag("periodic", s.periodic, "pack a box without walls: the domain is a cut through an endless packing");
    schema.integer("seed", s.seed, {0, 9.0e15}, "another seed, another packing of the same kind");
    schema.option("cut_by", s.cut_by, {"surface", "voxels"},
                  "bonds are cut by the triangles of the crack surface, or by crack voxels on their line");
    schema.option("counted", s.counted, {"crack", "all"},
                  "void that counts as crack opening in a bond: voxels of cracks, or all void [Eqs. 14, 15]");
    schema.number("r_tilde", s.r_tilde, {0.01, 1.0},
                  "radius over R_DE of the cylinder in which a bond's crack is measured [Eq. 3]");
}

void check(const Settings& s)
{
    const auto needs = [](bool good, const char* key, const char* what, double got) {
        if (!good) throw InvalidInput(fmt::format("domain.{}: needs {}, got {}", key, what, got));
    };
    if (s.mean_radius)
        needs(*s.mean_radius > 0.0 && std::isfinite(*s.mean_radius), "mean_radius", "a positive length",
              *s.mean_radius);
    needs(s.dispersion >= 0.0 && s.dispersion <= 0.9, "dispersion", "0 to 90 %", s.dispersion);
    needs(s.density >= 0.0 && s.density <= 0.3, "density", "0 to 0.3 elements per R_DE^3", s.density);
    needs(s.cardinality >= 1.0 && s.cardinality <= 12.0, "cardinality", "1 to 12", s.cardinality);
    needs(s.near_gap >= 0.0 && s.near_gap <= 1.0, "near_gap", "0 to 1", s.near_gap);
    needs(s.r_tilde > 0.0 && s.r_tilde <= 1.0, "r_tilde", "more than 0, at most 1", s.r_tilde);
}

}  // namespace craze::domain
