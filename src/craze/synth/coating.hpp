// The truth of an artificial coating: every defect as exact geometry, in metres. Images, domains and tables are made
// from it, and what the chain finds is judged against it.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/mesh/crack_surface.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace craze::synth {

/// Three perpendicular unit vectors.
struct Frame {
    Vec3 u{1, 0, 0}, v{0, 1, 0}, n{0, 0, 1};
};

/// An orthonormal frame with the given third vector (unit length), turned about it by `angle` (radian).
Frame frame_about(const Vec3& n, double angle);

struct Ellipsoid {
    Vec3 centre;  ///< m
    Frame frame;
    Vec3 semi;  ///< semi-axes along u, v, n, m, > 0
};

/// The surface as seen from a point near it: exact on the surface, first order in the distance elsewhere.
struct Facing {
    double distance;   ///< signed, m, negative inside
    Vec3 normal;       ///< outward
    double curvature;  ///< mean of the two principal curvatures, 1/m, positive for a ball
};
Facing facing(const Ellipsoid& body, const Vec3& point);

/// A void with room inside: the union of its lobes.
struct Pore {
    std::vector<Ellipsoid> lobes;  ///< at least one
    std::int32_t population = 0;
};
Facing facing(const Pore& pore, const Vec3& point);
bool contains(const Pore& pore, const Vec3& point);
/// Centre and radius of a ball that holds the pore.
std::array<double, 4> bounding_ball(const Pore& pore);

enum class ApertureProfile {
    lens,  ///< t_0 sqrt(1 - rho^2): what an elastic crack opened by a uniform stress has
    flat,  ///< t_0 up to the rim
};

enum class Outline { ellipse, rectangle };

/// A thin void: a mid-surface of height g(u, v) over an ellipse or a rectangle of its plane, opened by t(u, v) across
/// the surface.
struct Crack {
    Vec3 centre;              ///< m
    Frame frame;              ///< n is the normal of its plane
    double a = 0.0, b = 0.0;  ///< semi-axes along u and v, m
    double aperture = 0.0;    ///< t_0: opening in the middle, m
    ApertureProfile profile = ApertureProfile::lens;
    Outline outline = Outline::ellipse;
    double curvature = 0.0;  ///< bend about v, 1/m: g gets curvature u^2 / 2, its mean over the ellipse taken off
    std::array<double, 2> wave_height{};       ///< m: g gets wave_height sin(wave_u u + wave_v v + phase), twice
    std::array<double, 2> wave_u{}, wave_v{};  ///< 1/m
    std::array<double, 2> wave_phase{};
    std::int32_t population = 0;
};

/// Where a point lies as seen from a crack.
struct CrackView {
    double rho2;      ///< see rim(): 1 at the rim
    double distance;  ///< from the mid-surface, signed, m
    double opening;   ///< t at the foot of the point, m; 0 outside the rim
    Vec3 normal;      ///< of the mid-surface there
};
/// rho^2 of a point of the plane: (u/a)^2 + (v/b)^2, for a rectangle the greater of the two. 1 at the rim.
inline double rim(const Crack& crack, double u, double v)
{
    const double p = u / crack.a, q = v / crack.b;
    return crack.outline == Outline::ellipse ? p * p + q * q : std::max(p * p, q * q);
}
/// Greatest distance of the rim from the centre, in the plane, m.
double reach(const Crack& crack);
CrackView view(const Crack& crack, const Vec3& point);
/// Greatest |g| over the ellipse (a bound, m).
double relief(const Crack& crack);
/// Volume between the faces (m3): exact when flat, to second order in the slopes otherwise.
double volume(const Crack& crack);

/// A box [0, size] of matter with its defects.
struct Coating {
    Vec3 size;  ///< m
    std::vector<Pore> pores;
    std::vector<Crack> cracks;
    std::vector<std::string> pore_names{}, crack_names{};  ///< of the populations
};

/// Is the point in a pore?
bool in_pore(const Coating& coating, const Vec3& point);

/// Mid-surfaces of all cracks inside the box and outside pores, as triangles with edges near `step` (m).
mesh::CrackSurface crack_surface(const Coating& coating, double step);

}  // namespace craze::synth
