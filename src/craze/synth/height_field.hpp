// The surface of a growing coating as heights over a grid, and patches of it.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/synth/coating.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace craze::synth {

/// Heights at the middles of square cells over [0, x] x [0, y], x fastest.
struct HeightField {
    std::int64_t nx, ny;
    double cell;            ///< m
    std::vector<double> z;  ///< m, shape (nx ny,)

    HeightField(double x, double y, double edge)
        : nx(std::max<std::int64_t>(2, std::lround(std::ceil(x / edge)))),
          ny(std::max<std::int64_t>(2, std::lround(std::ceil(y / edge)))),
          cell(edge),
          z(static_cast<std::size_t>(nx * ny), 0.0)
    {
    }
    std::array<double, 2> place(std::size_t i) const
    {
        const auto k = static_cast<std::int64_t>(i), row = k / nx;
        return {(static_cast<double>(k % nx) + 0.5) * cell, (static_cast<double>(row) + 0.5) * cell};
    }
    double distance(std::size_t i, std::size_t j) const
    {
        const auto a = place(i), b = place(j);
        return std::hypot(a[0] - b[0], a[1] - b[1]);
    }
    bool holds(double x, double y) const
    {
        return x >= 0.0 && y >= 0.0 && x < static_cast<double>(nx) * cell && y < static_cast<double>(ny) * cell;
    }
    /// Height of the cell that holds (x, y).
    double at(double x, double y) const
    {
        const auto i = static_cast<std::int64_t>(x / cell), j = static_cast<std::int64_t>(y / cell);
        return z[static_cast<std::size_t>(i + nx * j)];
    }
};

/// Gray closing by paraboloids of the given radius of curvature: the lowest surface above `field` that has no valley
/// sharper than that.
HeightField closed_by_parabola(const HeightField& field, double radius);

/// Cells of `in`, by 4-connected patches, in order of their first cell.
std::vector<std::vector<std::size_t>> connected_patches(const HeightField& field, const std::vector<std::uint8_t>& in);

/// The ellipse with a patch's centroid and second moments, in the plane that fits its heights best.
struct PatchShape {
    Vec3 centre;
    Frame frame;
    double a, b;  ///< semi-axes along u and v, m
};
template <class Height>
PatchShape shape_of(const HeightField& field, const std::vector<std::size_t>& patch, Height&& height)
{
    const auto n = static_cast<double>(patch.size());
    double x = 0, y = 0, z = 0;
    for (const std::size_t i : patch) {
        const auto p = field.place(i);
        x += p[0] / n, y += p[1] / n, z += height(i) / n;
    }
    const double own = field.cell * field.cell / 12.0;  // a cell's own second moment
    double xx = own, xy = 0, yy = own, xz = 0, yz = 0;
    for (const std::size_t i : patch) {
        const auto p = field.place(i);
        const double dx = p[0] - x, dy = p[1] - y, dz = height(i) - z;
        xx += dx * dx / n, xy += dx * dy / n, yy += dy * dy / n, xz += dx * dz / n, yz += dy * dz / n;
    }
    const double det = xx * yy - xy * xy, slope_x = (xz * yy - yz * xy) / det, slope_y = (yz * xx - xz * xy) / det;
    const double middle = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const Vec3 n_up = normalized(Vec3{-slope_x, -slope_y, 1.0});
    const Vec3 u =
        normalized(Vec3{std::cos(angle), std::sin(angle), slope_x * std::cos(angle) + slope_y * std::sin(angle)});
    // A uniform ellipse has second moments a^2/4 and b^2/4.
    return {{x, y, z},
            {u, cross(n_up, u), n_up},
            2.0 * std::sqrt(middle + half),
            2.0 * std::sqrt(std::max(own, middle - half))};
}

}  // namespace craze::synth
