#include "craze/domain/validity.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/index.hpp"
#include "craze/domain/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace craze::domain {

std::string name_of(Part part) { return part == Part::element ? "element" : part == Part::bond ? "bond" : "near pair"; }

namespace {

double sphere_volume(double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; }

void check_elements(const Domain& d, const Origin& origin)
{
    const Elements& el = d.elements;
    const auto refuse = [&](std::size_t e, const std::string& why) {
        throw InvalidInput(fmt::format("{}: {}", origin(Part::element, e), why));
    };
    for (int axis = 0; axis < 3; ++axis)
        if (!(d.box[axis] > 0.0 && std::isfinite(d.box[axis])))
            throw InvalidInput(
                fmt::format("box: needs three positive edges, got {} m along {}", d.box[axis], "xyz"[axis]));
    double mean = 0.0, spheres = 0.0;
    for (const double r : el.r) mean += r / static_cast<double>(el.r.size()), spheres += sphere_volume(r);
    // Radii must be right before means of them say anything.
    const bool sound = !el.r.empty() && std::ranges::all_of(el.r, [](double r) { return r > 0.0 && std::isfinite(r); });
    if (sound && !(d.mean_radius > 0.5 * mean && d.mean_radius < 2.0 * mean))
        throw InvalidInput(
            fmt::format("mean radius: needs about {:.4g} m, as the elements have, got {} m; is the unit right?", mean,
                        d.mean_radius));
    if (sound && !(d.dense_volume > 0.999999 * spheres && std::isfinite(d.dense_volume)))
        throw InvalidInput(fmt::format("dense volume: needs at least the {:.6g} m3 of the elements, got {} m3", spheres,
                                       d.dense_volume));
    const double beyond = 0.5 * d.mean_radius;
    for (std::size_t e = 0; e < el.r.size(); ++e) {
        const Vec3 c{el.x[e], el.y[e], el.z[e]};
        if (!(el.r[e] > 0.0 && std::isfinite(el.r[e])))
            refuse(e, fmt::format("needs a positive radius, got {} m", el.r[e]));
        for (int axis = 0; axis < 3; ++axis)
            if (!(c[axis] >= -beyond && c[axis] <= d.box[axis] + beyond))
                refuse(e, fmt::format("centre at {0} = {1} m lies outside the box, [0, {2}] m along {0}; is the unit "
                                      "right, and the box?",
                                      "xyz"[axis], c[axis], d.box[axis]));
    }
    // Only pairs that overlap at all can overlap too much.
    const Pairs touching = pairs_within(el, d.box, 0.0);
    for (std::size_t p = 0; p < touching.i.size(); ++p) {
        const double r_i = el.r[at(touching.i[p])], r_j = el.r[at(touching.j[p])];
        if (r_i + r_j + touching.gap[p] < std::max(r_i, r_j))
            refuse(at(touching.j[p]),
                   fmt::format("overlaps {} beyond reason: centres {:.4g} m apart, radii {:.4g} m and {:.4g} m",
                               origin(Part::element, at(touching.i[p])), r_i + r_j + touching.gap[p], r_j, r_i));
    }
}

void check_pairs(const Domain& d, Part part, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                 std::span<const double> thickness, const Origin& origin)
{
    const std::int32_t n = d.elements.size();
    for (std::size_t p = 0; p < i.size(); ++p) {
        const auto refuse = [&](const std::string& why) {
            throw InvalidInput(fmt::format("{}: {}", origin(part, p), why));
        };
        if (i[p] < 0 || j[p] < 0 || i[p] >= n || j[p] >= n)
            refuse(fmt::format("names element {}, there are 0 to {}", i[p] < 0 || i[p] >= n ? i[p] : j[p], n - 1));
        if (i[p] == j[p]) refuse(fmt::format("joins element {} to itself", i[p]));
        if (i[p] > j[p]) refuse(fmt::format("needs i < j, got {} and {}", i[p], j[p]));
        if (p > 0 && i[p] == i[p - 1] && j[p] == j[p - 1])
            refuse(fmt::format("joins elements {} and {}, as {} does", i[p], j[p], origin(part, p - 1)));
        if (p > 0 && (i[p] < i[p - 1] || (i[p] == i[p - 1] && j[p] < j[p - 1]))) refuse("is not sorted by (i, j)");
        const double L_0 = norm(d.elements.centre(j[p]) - d.elements.centre(i[p]));
        if (!(thickness[p] >= 0.0 && thickness[p] <= L_0))
            refuse(
                fmt::format("needs a crack thickness from 0 to L_0 = {:.4g} m, got {} m [Eq. 9]", L_0, thickness[p]));
    }
}

}  // namespace

void check_domain(const Domain& d, const Origin& origin)
{
    check_elements(d, origin);
    check_pairs(d, Part::bond, d.bonds.i, d.bonds.j, d.bonds.thickness, origin);
    check_pairs(d, Part::near_pair, d.near.i, d.near.j, d.near.thickness, origin);
}

}  // namespace craze::domain
