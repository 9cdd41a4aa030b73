#include "craze/synth/render.hpp"

#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace craze::synth {

namespace {

constexpr double half_diagonal = 0.8660254037844387;  // of a unit cube

double cubed_if_positive(double s) { return s > 0.0 ? s * s * s : 0.0; }

/// Voxels whose centres lie in [least, most] along one axis.
struct Run {
    std::int64_t begin, end;
};
Run run_of(double least, double most, double origin, double h, std::int64_t n)
{
    const double first = std::ceil((least - origin) / h), last = std::floor((most - origin) / h);
    return {static_cast<std::int64_t>(std::clamp(first, 0.0, static_cast<double>(n))),
            static_cast<std::int64_t>(std::clamp(last + 1.0, 0.0, static_cast<double>(n)))};
}

double reach_of(const Ellipsoid& body, int axis)
{
    const double u = body.frame.u[axis] * body.semi.x, v = body.frame.v[axis] * body.semi.y,
                 n = body.frame.n[axis] * body.semi.z;
    return std::sqrt(u * u + v * v + n * n);
}

/// Lobes of one pore are joined by the greatest share; `own` (zero before and after) holds them while it is drawn.
void render_pore(const Pore& pore, const SliceGrid& grid, std::span<float> share, std::span<float> own)
{
    struct Window {
        Run rows, columns;
    };
    std::vector<Window> windows;
    for (const auto& lobe : pore.lobes) {
        const double margin = half_diagonal * grid.h;
        if (std::abs(grid.origin.z - lobe.centre.z) > reach_of(lobe, 2) + margin) continue;
        const double dx = reach_of(lobe, 0) + margin, dy = reach_of(lobe, 1) + margin;
        const Run rows = run_of(lobe.centre.y - dy, lobe.centre.y + dy, grid.origin.y, grid.h, grid.ny);
        const Run columns = run_of(lobe.centre.x - dx, lobe.centre.x + dx, grid.origin.x, grid.h, grid.nx);
        windows.push_back({rows, columns});
        for (std::int64_t y = rows.begin; y < rows.end; ++y)
            for (std::int64_t x = columns.begin; x < columns.end; ++x) {
                const Facing seen = facing(lobe, {grid.origin.x + static_cast<double>(x) * grid.h,
                                                  grid.origin.y + static_cast<double>(y) * grid.h, grid.origin.z});
                // A curved face lies behind its tangent plane by curvature h / 12 on average over a voxel's section.
                const double distance = seen.distance / grid.h + std::min(0.1, seen.curvature * grid.h / 12.0);
                if (distance >= half_diagonal) continue;
                float& here = own[static_cast<std::size_t>(x + grid.nx * y)];
                // The void lies where normal . x < -distance from the voxel's centre.
                here = std::max(here, static_cast<float>(share_below_plane(seen.normal, -distance)));
            }
    }
    for (const auto& window : windows)
        for (std::int64_t y = window.rows.begin; y < window.rows.end; ++y)
            for (std::int64_t x = window.columns.begin; x < window.columns.end; ++x) {
                const auto i = static_cast<std::size_t>(x + grid.nx * y);
                share[i] = 1.0F - (1.0F - share[i]) * (1.0F - own[i]);
                own[i] = 0.0F;
            }
}

void render_crack(const Crack& crack, const SliceGrid& grid, std::span<float> share)
{
    const double margin = half_diagonal * grid.h;
    const double radius = reach(crack);
    // Slopes are below about 1, so the part of a voxel's diagonal across the plane covers the opening across the sheet.
    const double thick = relief(crack) + crack.aperture + 2.0 * margin;
    const double ball = std::sqrt(radius * radius + thick * thick);
    const double dz = grid.origin.z - crack.centre.z;
    if (std::abs(dz) > ball) return;
    const double in_slice = std::sqrt(ball * ball - dz * dz);
    const Run rows = run_of(crack.centre.y - in_slice, crack.centre.y + in_slice, grid.origin.y, grid.h, grid.ny);
    for (std::int64_t y = rows.begin; y < rows.end; ++y) {
        const double dy = grid.origin.y + static_cast<double>(y) * grid.h - crack.centre.y;
        const double half = std::sqrt(std::max(0.0, in_slice * in_slice - dy * dy));
        double least = -half, most = half;
        const double w = dy * crack.frame.n.y + dz * crack.frame.n.z, slope = crack.frame.n.x;
        if (std::abs(slope) > 1e-9) {
            const double one = (-thick - w) / slope, other = (thick - w) / slope;
            least = std::max(least, std::min(one, other));
            most = std::min(most, std::max(one, other));
        } else if (std::abs(w) > thick) {
            continue;
        }
        const Run columns = run_of(crack.centre.x + least, crack.centre.x + most, grid.origin.x, grid.h, grid.nx);
        const double u_row = dy * crack.frame.u.y + dz * crack.frame.u.z,
                     v_row = dy * crack.frame.v.y + dz * crack.frame.v.z;
        for (std::int64_t x = columns.begin; x < columns.end; ++x) {
            const double dx = grid.origin.x + static_cast<double>(x) * grid.h - crack.centre.x;
            const double u = dx * crack.frame.u.x + u_row, v = dx * crack.frame.v.x + v_row;
            if (rim(crack, u, v) >= 1.0) continue;
            const CrackView seen =
                view(crack, {grid.origin.x + static_cast<double>(x) * grid.h, crack.centre.y + dy, grid.origin.z});
            const double opening = 0.5 * seen.opening / grid.h, distance = seen.distance / grid.h;
            if (!(opening > 0.0) || std::abs(distance) >= opening + half_diagonal) continue;
            const double part = share_below_plane(seen.normal, opening - distance) -
                                share_below_plane(seen.normal, -opening - distance);
            float& here = share[static_cast<std::size_t>(x + grid.nx * y)];
            here = 1.0F - (1.0F - here) * (1.0F - static_cast<float>(part));
        }
    }
}

}  // namespace

double share_below_plane(const Vec3& normal, double distance)
{
    // Inclusion and exclusion of corner tetrahedra. Components near zero are lifted: the formula divides by them, and
    // a face turned by 1e-4 moves by less than that share of a voxel.
    const double a = std::max(std::abs(normal.x), 1e-4), b = std::max(std::abs(normal.y), 1e-4),
                 c = std::max(std::abs(normal.z), 1e-4);
    const double whole = a + b + c;
    bool beyond_middle = false;
    double s = distance + 0.5 * whole;
    if (s <= 0.0) return 0.0;
    if (s >= whole) return 1.0;
    if (s > 0.5 * whole) {
        s = whole - s;
        beyond_middle = true;
    }
    const double sum = s * s * s - cubed_if_positive(s - a) - cubed_if_positive(s - b) - cubed_if_positive(s - c) +
                       cubed_if_positive(s - a - b) + cubed_if_positive(s - a - c) + cubed_if_positive(s - b - c);
    const double share = std::clamp(sum / (6.0 * a * b * c), 0.0, 1.0);
    return beyond_middle ? 1.0 - share : share;
}

void render_slice(const Coating& coating, const SliceGrid& grid, std::span<float> pore, std::span<float> crack)
{
    std::fill(pore.begin(), pore.end(), 0.0F);
    std::fill(crack.begin(), crack.end(), 0.0F);
    for (const auto& body : coating.pores) render_pore(body, grid, pore, crack);
    for (const auto& sheet : coating.cracks) render_crack(sheet, grid, crack);
    for (std::size_t i = 0; i < pore.size(); ++i) crack[i] *= 1.0F - pore[i];
}

Porosity porosity(const Coating& coating, double h)
{
    const auto count = [&](double edge) {
        return std::max<std::int64_t>(1, static_cast<std::int64_t>(edge / h + 0.5));
    };
    const Shape shape{count(coating.size.x), count(coating.size.y), count(coating.size.z)};
    const auto per_slice = static_cast<std::size_t>(shape.nx * shape.ny);
    std::vector<double> pores(static_cast<std::size_t>(shape.nz)), cracks(pores.size());
    parallel_ranges(shape.nz, [&](std::int64_t begin, std::int64_t end) {
        std::vector<float> pore(per_slice), crack(per_slice);
        for (std::int64_t z = begin; z < end; ++z) {
            render_slice(coating, {shape.nx, shape.ny, h, {0.5 * h, 0.5 * h, (static_cast<double>(z) + 0.5) * h}}, pore,
                         crack);
            double of_pores = 0.0, of_cracks = 0.0;
            for (std::size_t i = 0; i < per_slice; ++i) of_pores += pore[i], of_cracks += crack[i];
            pores[static_cast<std::size_t>(z)] = of_pores;
            cracks[static_cast<std::size_t>(z)] = of_cracks;
        }
    });
    Porosity found;
    for (std::size_t z = 0; z < pores.size(); ++z) found.pores += pores[z], found.cracks += cracks[z];
    found.pores /= static_cast<double>(shape.voxels());
    found.cracks /= static_cast<double>(shape.voxels());
    found.total = found.pores + found.cracks;
    return found;
}

}  // namespace craze::synth
