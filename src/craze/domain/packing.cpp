#include "craze/domain/packing.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/cells.hpp"
#include "craze/domain/spheres.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace craze::domain {

namespace {

// The paper's domain: 92 000 elements of 0.2 um in 17.61 x 13.24 x 21.22 um [3.1.1, 2.3].
constexpr double paper_elements = 92000.0;
constexpr Vec3 paper_box{17.61 / 0.2, 13.24 / 0.2, 21.22 / 0.2};
constexpr double wall_layer = 0.25;  // R_DE: volume per wall area that elements cannot use

double volume(const Vec3& box) { return box.x * box.y * box.z; }
double wall_area(const Vec3& box) { return 2.0 * (box.x * box.y + box.y * box.z + box.z * box.x); }
double usable(const Vec3& box, bool periodic) { return volume(box) - (periodic ? 0.0 : wall_layer * wall_area(box)); }

struct Cloud {
    std::vector<Vec3> centre;
    std::vector<double> r;
};

/// Sorted along a Morton curve.
Cloud sorted(const Cloud& cloud, const Vec3& box)
{
    std::vector<double> x(cloud.r.size()), y(x.size()), z(x.size());
    for (std::size_t k = 0; k < x.size(); ++k)
        x[k] = cloud.centre[k].x, y[k] = cloud.centre[k].y, z[k] = cloud.centre[k].z;
    Cloud out;
    out.centre.reserve(x.size()), out.r.reserve(x.size());
    for (const std::int32_t k : morton_order(box, x, y, z)) {
        out.centre.push_back(cloud.centre[static_cast<std::size_t>(k)]);
        out.r.push_back(cloud.r[static_cast<std::size_t>(k)]);
    }
    return out;
}

Cloud scatter(std::int64_t n, const Vec3& box, const Recipe& recipe)
{
    Cloud cloud{std::vector<Vec3>(static_cast<std::size_t>(n)), std::vector<double>(static_cast<std::size_t>(n))};
    parallel_ranges(n, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            Random random(recipe.seed, static_cast<std::uint64_t>(i));
            const double r = random.uniform(1.0 - recipe.half_width, 1.0 + recipe.half_width);
            const double wall = recipe.periodic ? 0.0 : r;
            const double x = random.uniform(wall, box.x - wall), y = random.uniform(wall, box.y - wall),
                         z = random.uniform(wall, box.z - wall);
            cloud.centre[static_cast<std::size_t>(i)] = {x, y, z};
            cloud.r[static_cast<std::size_t>(i)] = r;
        }
    });
    return sorted(cloud, box);
}

}  // namespace

std::int64_t element_count(const Vec3& box, const Recipe& recipe)
{
    const double R = recipe.mean_radius;
    if (!(R > 0.0 && std::isfinite(R)))
        throw InvalidInput(fmt::format("packing: needs a positive mean radius, got {} m", R));
    for (int axis = 0; axis < 3; ++axis)
        if (!(box[axis] >= 2.0 * R * (1.0 + recipe.half_width) && std::isfinite(box[axis])))
            throw InvalidInput(
                fmt::format("packing: a box edge of {} m cannot hold elements of mean radius {} m", box[axis], R));
    const Vec3 scaled = box / R;
    const double density = recipe.density > 0.0 ? recipe.density : paper_elements / usable(paper_box, false);
    const double count = density * std::max(usable(scaled, recipe.periodic), 0.0);
    if (!(count < 2e9))
        throw InvalidInput(
            fmt::format("packing: {:.3g} elements are more than 2e9; is the mean radius, {} m, right?", count, R));
    return std::max<std::int64_t>(1, std::llround(count));
}

Elements pack_elements(const Vec3& box, const Recipe& recipe, PackingReport* report)
{
    const Stopwatch watch;
    const std::int64_t n = element_count(box, recipe);
    const double R = recipe.mean_radius;
    const Vec3 edges = box / R;
    Cloud cloud = scatter(n, edges, recipe);
    // Stiffer where the overlap is large, so that the largest overlap comes down as soon as the median.
    constexpr double stiffening = 0.3;
    Spheres spheres(edges, recipe.periodic, cloud.centre, cloud.r, stiffening);

    // FIRE with the constants of Bitzek et al. 2006; the step is bounded by the stiffest oscillation.
    constexpr double dt_most = 0.5, alpha_start = 0.1;
    double dt = 0.1, alpha = alpha_start, skin = 0.5, residual = 1.0;
    double mean_overlap = 0.0;
    std::int64_t downhill = 0, iteration = 0, list_age = 0;
    constexpr std::int64_t most_iterations = 20000;
    bool listed = false;
    // Enough when hardly anything overlaps (median below 0.3 %, all below 2 %), or when nothing moves any more.
    for (; iteration < most_iterations; ++iteration) {
        if (!listed) {
            spheres.list_neighbours(skin);
            listed = true;
            list_age = 0;
        }
        const Spheres::Sums s = spheres.push();
        mean_overlap = s.overlap / static_cast<double>(std::max<std::int64_t>(s.contacts, 1));
        residual = std::sqrt(s.force2 / static_cast<double>(n)) / std::max(mean_overlap, 1e-9);
        if (residual < 1e-2 || (mean_overlap < 0.0067 && s.most < 0.0196 && residual < 0.1)) break;
        if (iteration % 16 == 0) check_interrupt();
        double keep = 0.0, steer = dt;
        if (s.power > 0.0) {
            keep = 1.0 - alpha;
            steer += alpha * std::sqrt(s.speed2 / s.force2);
            if (++downhill > 5) {
                dt = std::min(dt * 1.1, dt_most);
                alpha *= 0.99;
            }
        } else if (iteration > 0) {
            downhill = 0;
            dt *= 0.5;
            alpha = alpha_start;
        }
        listed = spheres.advance(keep, steer, dt) < 0.5 * skin;
        if (++list_age; !listed)
            skin = std::clamp(list_age > 20 ? 0.8 * skin : list_age < 10 ? 1.25 * skin : skin, 0.02, 0.6);
    }
    if (report) *report = {iteration, residual, 0.5 * mean_overlap, iteration < most_iterations, watch.seconds()};

    for (std::int64_t k = 0; k < n; ++k) cloud.centre[static_cast<std::size_t>(k)] = spheres.centre(k);
    cloud = sorted(cloud, edges);
    Elements out;
    for (auto* axis : {&out.x, &out.y, &out.z, &out.r}) axis->reserve(cloud.r.size());
    for (std::size_t k = 0; k < cloud.r.size(); ++k) {
        out.x.push_back(cloud.centre[k].x * R);
        out.y.push_back(cloud.centre[k].y * R);
        out.z.push_back(cloud.centre[k].z * R);
        out.r.push_back(cloud.r[k] * R);
    }
    return out;
}

}  // namespace craze::domain
