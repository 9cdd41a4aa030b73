#include "craze/synth/coating.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::synth {

using std::numbers::pi;

Frame frame_about(const Vec3& n, double angle)
{
    const Vec3 other = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 p = normalized(cross(n, other));
    const Vec3 q = cross(n, p);
    const Vec3 u = std::cos(angle) * p + std::sin(angle) * q;
    return {u, cross(n, u), n};
}

Facing facing(const Ellipsoid& body, const Vec3& point)
{
    const Vec3 rel = point - body.centre;
    const Vec3 q{dot(rel, body.frame.u) / body.semi.x, dot(rel, body.frame.v) / body.semi.y,
                 dot(rel, body.frame.n) / body.semi.z};
    const Vec3 slope{q.x / body.semi.x, q.y / body.semi.y, q.z / body.semi.z};
    const double level = norm(q), steepness = norm(slope);
    if (!(steepness > 0.0)) return {-std::min({body.semi.x, body.semi.y, body.semi.z}), body.frame.n, 0.0};
    const Vec3 s = slope / steepness;
    const Vec3 inverse2{1.0 / (body.semi.x * body.semi.x), 1.0 / (body.semi.y * body.semi.y),
                        1.0 / (body.semi.z * body.semi.z)};
    const double along = s.x * s.x * inverse2.x + s.y * s.y * inverse2.y + s.z * s.z * inverse2.z;
    return {level * (level - 1.0) / steepness, s.x * body.frame.u + s.y * body.frame.v + s.z * body.frame.n,
            0.5 * (inverse2.x + inverse2.y + inverse2.z - along) / steepness};
}

Facing facing(const Pore& pore, const Vec3& point)
{
    Facing nearest = facing(pore.lobes.front(), point);
    for (std::size_t l = 1; l < pore.lobes.size(); ++l) {
        const Facing other = facing(pore.lobes[l], point);
        if (other.distance < nearest.distance) nearest = other;
    }
    return nearest;
}

bool contains(const Pore& pore, const Vec3& point)
{
    return std::any_of(pore.lobes.begin(), pore.lobes.end(), [&](const Ellipsoid& lobe) {
        const Vec3 rel = point - lobe.centre;
        const double u = dot(rel, lobe.frame.u) / lobe.semi.x, v = dot(rel, lobe.frame.v) / lobe.semi.y,
                     n = dot(rel, lobe.frame.n) / lobe.semi.z;
        return u * u + v * v + n * n < 1.0;
    });
}

std::array<double, 4> bounding_ball(const Pore& pore)
{
    const Vec3 centre = pore.lobes.front().centre;
    double radius = 0.0;
    for (const auto& lobe : pore.lobes)
        radius = std::max(radius, norm(lobe.centre - centre) + std::max({lobe.semi.x, lobe.semi.y, lobe.semi.z}));
    return {centre.x, centre.y, centre.z, radius};
}

CrackView view(const Crack& crack, const Vec3& point)
{
    const Vec3 rel = point - crack.centre;
    const double u = dot(rel, crack.frame.u), v = dot(rel, crack.frame.v), w = dot(rel, crack.frame.n);
    const double rho2 = rim(crack, u, v);
    double g = crack.curvature * (0.5 * u * u - 0.125 * crack.a * crack.a), g_u = crack.curvature * u, g_v = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
        if (crack.wave_height[k] == 0.0) continue;
        const double angle = crack.wave_u[k] * u + crack.wave_v[k] * v + crack.wave_phase[k];
        const double slope = crack.wave_height[k] * std::cos(angle);
        g += crack.wave_height[k] * std::sin(angle);
        g_u += slope * crack.wave_u[k];
        g_v += slope * crack.wave_v[k];
    }
    const double stretch = std::sqrt(1.0 + g_u * g_u + g_v * g_v);
    const double open = rho2 >= 1.0                              ? 0.0
                        : crack.profile == ApertureProfile::lens ? crack.aperture * std::sqrt(1.0 - rho2)
                                                                 : crack.aperture;
    return {rho2, (w - g) / stretch, open, (crack.frame.n - g_u * crack.frame.u - g_v * crack.frame.v) / stretch};
}

double reach(const Crack& crack)
{
    return crack.outline == Outline::ellipse ? std::max(crack.a, crack.b) : std::hypot(crack.a, crack.b);
}

double relief(const Crack& crack)
{
    return std::abs(crack.curvature) * 0.375 * crack.a * crack.a + std::abs(crack.wave_height[0]) +
           std::abs(crack.wave_height[1]);
}

double volume(const Crack& crack)
{
    const double mean_profile = crack.profile == ApertureProfile::lens ? 2.0 / 3.0 : 1.0;
    // Mean of the squared slope, weighted alike for both profiles: waves average to half, u^2 to a^2/5 (lens) or /4.
    double slope2 =
        crack.curvature * crack.curvature * crack.a * crack.a * (crack.profile == ApertureProfile::lens ? 0.2 : 0.25);
    for (std::size_t k = 0; k < 2; ++k)
        slope2 += 0.5 * crack.wave_height[k] * crack.wave_height[k] *
                  (crack.wave_u[k] * crack.wave_u[k] + crack.wave_v[k] * crack.wave_v[k]);
    const double area = (crack.outline == Outline::ellipse ? pi : 4.0) * crack.a * crack.b;
    return area * crack.aperture * mean_profile * (1.0 + 0.5 * slope2);
}

bool in_pore(const Coating& coating, const Vec3& point)
{
    return std::any_of(coating.pores.begin(), coating.pores.end(), [&](const Pore& pore) {
        const auto ball = bounding_ball(pore);
        const Vec3 rel = point - Vec3{ball[0], ball[1], ball[2]};
        return dot(rel, rel) < ball[3] * ball[3] && contains(pore, point);
    });
}

namespace {

Vec3 on_sheet(const Crack& crack, double u, double v)
{
    const Vec3 flat = crack.centre + u * crack.frame.u + v * crack.frame.v;
    // view() of a point of the plane gives -g / stretch along the normal; its foot along n is found from the slopes.
    const CrackView seen = view(crack, flat);
    return flat - (seen.distance / dot(seen.normal, crack.frame.n)) * crack.frame.n;
}

bool in_box(const Vec3& p, const Vec3& size)
{
    return p.x > 0 && p.x < size.x && p.y > 0 && p.y < size.y && p.z > 0 && p.z < size.z;
}

}  // namespace

mesh::CrackSurface crack_surface(const Coating& coating, double step)
{
    mesh::CrackSurface sheet;
    for (const auto& crack : coating.cracks) {
        // Rings of triangles: ring k has 6 k points, as a hexagonal disc stretched to the ellipse.
        const auto rings = static_cast<int>(std::max(2.0, std::ceil(std::max(crack.a, crack.b) / step)));
        std::vector<Vec3> points{on_sheet(crack, 0, 0)};
        for (int k = 1; k <= rings; ++k)
            for (int i = 0; i < 6 * k; ++i) {
                const double angle = 2 * pi * i / (6.0 * k), c = std::cos(angle), s = std::sin(angle);
                const double rho = static_cast<double>(k) / rings /
                                   (crack.outline == Outline::ellipse ? 1.0 : std::max(std::abs(c), std::abs(s)));
                points.push_back(on_sheet(crack, crack.a * rho * c, crack.b * rho * s));
            }
        std::vector<std::int32_t> renumbered(points.size(), -1);
        const auto add = [&](int p, int q, int r) {
            const auto at = [&](int i) { return points[static_cast<std::size_t>(i)]; };
            const Vec3 middle = (at(p) + at(q) + at(r)) / 3.0;
            if (!in_box(middle, coating.size) || in_pore(coating, middle)) return;
            std::array<std::int32_t, 3> corner{};
            for (std::size_t c = 0; c < 3; ++c) {
                const int from = c == 0 ? p : c == 1 ? q : r;
                auto& number = renumbered[static_cast<std::size_t>(from)];
                if (number < 0) {
                    number = static_cast<std::int32_t>(sheet.vertices.size());
                    sheet.vertices.push_back(at(from));
                }
                corner[c] = number;
            }
            sheet.triangles.push_back(corner);
        };
        const auto first = [](int k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); };
        for (int k = 1; k <= rings; ++k)
            for (int side = 0; side < 6; ++side)
                for (int i = 0; i < k; ++i) {
                    const auto outer = [&](int j) { return first(k) + (side * k + j) % (6 * k); };
                    const auto inner = [&](int j) {
                        return k == 1 ? 0 : first(k - 1) + (side * (k - 1) + j) % (6 * (k - 1));
                    };
                    add(outer(i), outer(i + 1), inner(i));
                    if (i + 1 < k) add(inner(i), outer(i + 1), inner(i + 1));
                }
    }
    return sheet;
}

}  // namespace craze::synth
