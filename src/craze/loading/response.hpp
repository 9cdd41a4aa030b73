// What the virtual loadings measured: the value that `loading` gives.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/loading/imposed.hpp"
#include "craze/loading/theory.hpp"
#include "craze/mechanics/material.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace craze::loading {

/// One state on a curve.
struct Point {
    double program = 0.0;   ///< strain of the program
    Vec3 strain;            ///< E_xx, E_yy, E_zz of the box, positive in tension [Eq. 17]
    Vec3 face_strain;       ///< between the mean centres of the elements of two sides
    Vec3 interior_strain;   ///< by regression over elements away from every wall
    Vec3 stress;            ///< mean force on the two sides over the initial section, Pa, positive in tension [Eq. 16]
    double eta = 0.0;       ///< density over the initial one, less 1 [Eq. 20]
    double pressure = 0.0;  ///< P_h, Pa [Eq. 19]
    double bulk = 0.0;      ///< K = (1 + eta) dP/deta, Pa; triaxial loadings only [Eq. 22]
    double closure = 0.0;   ///< gamma: share of contact beams in compression [Eq. 23]
    double cracked = 0.0;   ///< alpha: share of bonds that are contact beams [Eq. 25]
    std::int64_t broken = 0;  ///< beams turned into contact beams since the start

    double work = 0.0;            ///< of the driven sides since the start, J
    double elastic = 0.0;         ///< stored in bonds and contacts, J
    double kinetic = 0.0;         ///< J
    double damped = 0.0;          ///< lost to damping since the start, J
    double fracture = 0.0;        ///< lost when bonds broke since the start, J
    double imbalance = 0.0;       ///< difference of the forces on opposite driven sides over their mean
    double residual = 0.0;        ///< of equilibrium, over the driving forces; 0 in motion
    double time = 0.0;            ///< of motion, s
    std::int64_t iterations = 0;  ///< of the linear solver, or steps of motion, since the last point

    friend bool operator==(const Point&, const Point&) = default;
};

/// A bond that broke: which, where along the program and the axial strain, when.
struct BrokenBond {
    std::int32_t i = 0, j = 0;  ///< elements of the specimen
    Vec3 where;                 ///< middle of the bond at rest, m
    double strain = 0.0;        ///< of the program
    double stress = 0.0;        ///< axial stress of the specimen at that point, Pa
    std::int64_t point = 0;     ///< index of the point before which it broke

    friend bool operator==(const BrokenBond&, const BrokenBond&) = default;
};

struct Curve {
    Loading loading;
    std::vector<Point> points;  ///< the first is the unloaded state
    std::vector<BrokenBond> broken;
    std::string stopped;   ///< why it ended before its path did; empty when it did not
    double seconds = 0.0;  ///< wall time
};

/// Elastic constants at small strain along one axis [Table 3].
struct Modulus {
    std::string specimen;
    int axis = 0;
    double tension = 0.0;      ///< E = stress over box strain, Pa
    double compression = 0.0;  ///< Pa
    double face = 0.0;         ///< E in tension over face strain, Pa
    double interior = 0.0;     ///< E in tension over interior strain, Pa
    double nu = 0.0;           ///< mean of both transverse directions, from interior strains, in tension

    friend bool operator==(const Modulus&, const Modulus&) = default;
};

/// Strength of one fracture loading.
struct Strength {
    std::string loading;
    std::string specimen;
    int axis = 0;
    bool tension = true;
    double sigma_failure = 0.0;  ///< bond strength, Pa
    double strength = 0.0;       ///< UTS or UCS, Pa, positive [Table 4]
    double strain = 0.0;         ///< box strain at the peak
    double new_cracks = 0.0;     ///< alpha at the end less alpha at the start
    double change = -1.0;        ///< relative change when the rate was halved once more; negative: not asked for

    friend bool operator==(const Strength&, const Strength&) = default;
};

/// How micro-parameters were found [3.1.2].
struct Calibration {
    struct Trial {
        double r_tilde = 0.0;
        Vec3 E;  ///< with the E_B of that trial, along x, y, z, Pa; 0 where not measured
        Vec3 nu;
        friend bool operator==(const Trial&, const Trial&) = default;
    };

    mechanics::DenseMaterial target;
    mechanics::BeamMaterial beam;
    bool done = false;          ///< false: `beam` was given
    bool from_library = false;  ///< found in the library under the same recipe
    std::string recipe;         ///< content hash of packing, target and measure
    std::vector<Trial> path;    ///< the last one is `beam`'s own, re-scaled to E_D
    double E = 0.0, nu = 0.0;   ///< that `beam` gives: mean over the axes
    double anisotropy = 0.0;    ///< (most - least) / mean of E along the axes
    double error = 0.0;         ///< the larger of |E/E_D - 1| and |nu/nu_D - 1|
};

struct Response {
    Calibration calibration;
    std::vector<Modulus> moduli;
    std::vector<Strength> strengths;
    std::vector<Curve> curves;
    double porosity = 0.0;  ///< p_DE of the pores [Eq. 12], for theory beside "pores"
    double seconds = 0.0;
};

/// K = (1 + eta) dP/deta at each point of a triaxial curve, by three-point differences on its own spacing [Eq. 22].
void fill_bulk_modulus(std::vector<Point>& points);

}  // namespace craze::loading
