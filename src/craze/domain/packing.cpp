#include "craze/domain/packing.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace craze::domain {

namespace {

constexpr std::int64_t block = 1024;  // elements that share a neighbour list and a partial sum

// The paper's domain: 92 000 elements of 0.2 um in 17.61 x 13.24 x 21.22 um [3.1.1, 2.3].
constexpr double paper_elements = 92000.0;
constexpr Vec3 paper_box{17.61 / 0.2, 13.24 / 0.2, 21.22 / 0.2};
constexpr double wall_layer = 0.25;  // R_DE: volume per wall area that elements cannot use

double volume(const Vec3& box) { return box.x * box.y * box.z; }
double wall_area(const Vec3& box) { return 2.0 * (box.x * box.y + box.y * box.z + box.z * box.x); }
double usable(const Vec3& box, bool periodic) { return volume(box) - (periodic ? 0.0 : wall_layer * wall_area(box)); }

struct Sphere {
    double x, y, z, r;
};

struct Sums {
    double power = 0.0, force2 = 0.0, speed2 = 0.0;  // F.v, F.F, v.v
    double overlap = 0.0;                            // of all contacts, each counted from both sides
    double most = 0.0;                               // largest overlap
    std::int64_t contacts = 0;
};

/// Lengths in R_DE, stiffness and mass 1.
struct Packing {
    Vec3 box;
    bool periodic;
    std::vector<Sphere> at;
    std::vector<Vec3> velocity, force, listed_at;
    std::vector<std::vector<std::int32_t>> neighbours;  // of each block, one element after the other
    std::vector<std::uint32_t> begin;                   // within the block's list; elements + blocks
    std::int64_t size() const { return static_cast<std::int64_t>(at.size()); }
    std::int64_t blocks() const { return (size() + block - 1) / block; }
};

void scatter(Packing& p, const Recipe& recipe)
{
    parallel_ranges(p.size(), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t i = begin; i < end; ++i) {
            Random random(recipe.seed, static_cast<std::uint64_t>(i));
            const double r = random.uniform(1.0 - recipe.half_width, 1.0 + recipe.half_width);
            const double wall = p.periodic ? 0.0 : r;
            Sphere& s = p.at[static_cast<std::size_t>(i)];
            s = {random.uniform(wall, p.box.x - wall), random.uniform(wall, p.box.y - wall),
                 random.uniform(wall, p.box.z - wall), r};
        }
    });
}

void reorder(Packing& p)
{
    std::vector<double> x(p.at.size()), y(p.at.size()), z(p.at.size());
    for (std::size_t k = 0; k < p.at.size(); ++k) x[k] = p.at[k].x, y[k] = p.at[k].y, z[k] = p.at[k].z;
    const auto order = morton_order(p.box, x, y, z);
    const auto permute = [&](auto& values) {
        auto sorted = values;
        for (std::size_t k = 0; k < sorted.size(); ++k) sorted[k] = values[static_cast<std::size_t>(order[k])];
        values = std::move(sorted);
    };
    permute(p.at);
    permute(p.velocity);
}

/// Runs of cells that hold the neighbours along one axis: one, or two where the box wraps around.
struct Runs {
    std::array<std::int32_t, 2> first{}, last{};  // last is one past
    int count = 0;
};

Runs runs_around(std::int32_t c, std::int32_t n, bool periodic)
{
    Runs runs;
    const auto add = [&](std::int32_t first, std::int32_t last) {
        runs.first[static_cast<std::size_t>(runs.count)] = first;
        runs.last[static_cast<std::size_t>(runs.count++)] = last;
    };
    if (!periodic || n <= 3) {
        add(periodic ? 0 : std::max(0, c - 1), periodic ? n : std::min(n, c + 2));
    } else if (c == 0 || c == n - 1) {
        add(c == 0 ? 0 : n - 2, c == 0 ? 2 : n);
        add(c == 0 ? n - 1 : 0, c == 0 ? n : 1);
    } else {
        add(c - 1, c + 2);
    }
    return runs;
}

Vec3 shortest(Vec3 d, const Vec3& box, bool periodic)
{
    if (periodic)
        for (int axis = 0; axis < 3; ++axis) d[axis] -= box[axis] * std::nearbyint(d[axis] / box[axis]);
    return d;
}

/// Appends to `list` the members of a run of cells within reach of sphere i. Spheres lie in the order of members.
template <bool periodic>
CRAZE_INLINE std::size_t search(const Sphere* sphere, const std::int32_t* member, std::size_t members, const Sphere& a,
                                std::int32_t i, double skin, const Vec3& box, std::int32_t* list)
{
    const Vec3 per_box{1.0 / box.x, 1.0 / box.y, 1.0 / box.z};
    std::size_t found = 0;
    for (std::size_t m = 0; m < members; ++m) {
        const Sphere& o = sphere[m];
        double dx = o.x - a.x, dy = o.y - a.y, dz = o.z - a.z;
        if constexpr (periodic) {
            dx -= box.x * std::nearbyint(dx * per_box.x);
            dy -= box.y * std::nearbyint(dy * per_box.y);
            dz -= box.z * std::nearbyint(dz * per_box.z);
        }
        const double reach = a.r + o.r + skin;
        // Written always, kept if near: no branch to foresee.
        list[found] = member[m];
        found += static_cast<std::size_t>(dx * dx + dy * dy + dz * dz < reach * reach) &
                 static_cast<std::size_t>(member[m] != i);
    }
    return found;
}

CRAZE_MULTIVERSION std::size_t search_walled(const Sphere* sphere, const std::int32_t* member, std::size_t members,
                                             const Sphere& a, std::int32_t i, double skin, const Vec3& box,
                                             std::int32_t* list)
{
    return search<false>(sphere, member, members, a, i, skin, box, list);
}

CRAZE_MULTIVERSION std::size_t search_periodic(const Sphere* sphere, const std::int32_t* member, std::size_t members,
                                               const Sphere& a, std::int32_t i, double skin, const Vec3& box,
                                               std::int32_t* list)
{
    return search<true>(sphere, member, members, a, i, skin, box, list);
}

/// Neighbours of every element up to `skin` beyond touching.
void list_neighbours(Packing& p, double r_max, double skin)
{
    std::vector<double> x(p.at.size()), y(p.at.size()), z(p.at.size());
    for (std::size_t k = 0; k < p.at.size(); ++k) x[k] = p.at[k].x, y[k] = p.at[k].y, z[k] = p.at[k].z;
    const Cells cells(p.box, 2.0 * r_max + skin, x, y, z);
    const auto n = cells.count();
    const std::int32_t* const members = cells.members().data();
    std::vector<Sphere> spheres(p.at.size());
    parallel_ranges(p.size(), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t m = begin; m < end; ++m)
            spheres[static_cast<std::size_t>(m)] = p.at[static_cast<std::size_t>(members[m])];
    });
    const auto search_run = p.periodic ? search_periodic : search_walled;

    parallel_tasks(p.blocks(), [&](std::int64_t b) {
        auto& list = p.neighbours[static_cast<std::size_t>(b)];
        list.clear();
        const std::int64_t first = b * block, last = std::min(p.size(), first + block);
        for (std::int64_t i = first; i < last; ++i) {
            const auto k = static_cast<std::size_t>(i);
            p.begin[static_cast<std::size_t>(i + b)] = static_cast<std::uint32_t>(list.size());
            p.listed_at[k] = {x[k], y[k], z[k]};
            const Runs xs = runs_around(cells.along(0, x[k]), n[0], p.periodic),
                       ys = runs_around(cells.along(1, y[k]), n[1], p.periodic),
                       zs = runs_around(cells.along(2, z[k]), n[2], p.periodic);
            const auto each = [](const Runs& runs, auto&& visit) {
                for (std::size_t run = 0; run < static_cast<std::size_t>(runs.count); ++run)
                    for (std::int32_t c = runs.first[run]; c < runs.last[run]; ++c) visit(c);
            };
            each(zs, [&](std::int32_t cz) {
                each(ys, [&](std::int32_t cy) {
                    for (std::size_t run = 0; run < static_cast<std::size_t>(xs.count); ++run) {
                        const auto row = cells.row(xs.first[run], xs.last[run], cy, cz);
                        const std::size_t before = list.size();
                        list.resize(before + row.size());
                        list.resize(before + search_run(spheres.data() + (row.data() - members), row.data(), row.size(),
                                                        p.at[k], static_cast<std::int32_t>(i), skin, p.box,
                                                        list.data() + before));
                    }
                });
            });
            // Touching ones first: the force loop's branch is then nearly always foreseen.
            std::partition(list.begin() + p.begin[static_cast<std::size_t>(i + b)], list.end(), [&](std::int32_t j) {
                const Sphere& a = p.at[k];
                const Sphere& o = p.at[static_cast<std::size_t>(j)];
                const Vec3 d = shortest(Vec3{o.x - a.x, o.y - a.y, o.z - a.z}, p.box, p.periodic);
                return dot(d, d) < (a.r + o.r) * (a.r + o.r);
            });
        }
        p.begin[static_cast<std::size_t>(last + b)] = static_cast<std::uint32_t>(list.size());
    });
}

/// Forces on elements [first, last) of one block, and the block's sums.
template <bool periodic>
CRAZE_INLINE Sums block_forces(const Sphere* at, Vec3* velocity, Vec3* force, const std::int32_t* list,
                               const std::uint32_t* begin, std::int64_t first, std::int64_t last, const Vec3& box)
{
    Sums sums;
    const Vec3 per_box{1.0 / box.x, 1.0 / box.y, 1.0 / box.z};
    for (std::int64_t i = first; i < last; ++i) {
        const Sphere a = at[i];
        double fx = 0.0, fy = 0.0, fz = 0.0, overlaps = 0.0;
        std::int64_t contacts = 0;
        for (std::uint32_t n = begin[i - first]; n < begin[i - first + 1]; ++n) {
            const Sphere& o = at[list[n]];
            double dx = a.x - o.x, dy = a.y - o.y, dz = a.z - o.z;
            if constexpr (periodic) {
                dx -= box.x * std::nearbyint(dx * per_box.x);
                dy -= box.y * std::nearbyint(dy * per_box.y);
                dz -= box.z * std::nearbyint(dz * per_box.z);
            }
            const double reach = a.r + o.r, d2 = dx * dx + dy * dy + dz * dz;
            if (d2 >= reach * reach) continue;
            const double d = std::sqrt(d2) + 1e-12;
            const double overlap = reach - d, push = overlap / d;
            fx += push * dx, fy += push * dy, fz += push * dz;
            overlaps += overlap;
            sums.most = std::max(sums.most, overlap / reach);
            ++contacts;
        }
        if constexpr (!periodic) {
            fx += std::max(0.0, a.r - a.x) - std::max(0.0, a.x + a.r - box.x);
            fy += std::max(0.0, a.r - a.y) - std::max(0.0, a.y + a.r - box.y);
            fz += std::max(0.0, a.r - a.z) - std::max(0.0, a.z + a.r - box.z);
        }
        force[i] = {fx, fy, fz};
        Vec3 v = velocity[i];
        if (fx == 0.0 && fy == 0.0 && fz == 0.0) velocity[i] = v = {};
        sums.power += fx * v.x + fy * v.y + fz * v.z;
        sums.force2 += fx * fx + fy * fy + fz * fz;
        sums.speed2 += v.x * v.x + v.y * v.y + v.z * v.z;
        sums.overlap += overlaps;
        sums.contacts += contacts;
    }
    return sums;
}

CRAZE_MULTIVERSION Sums walled_forces(const Sphere* at, Vec3* velocity, Vec3* force, const std::int32_t* list,
                                      const std::uint32_t* begin, std::int64_t first, std::int64_t last,
                                      const Vec3& box)
{
    return block_forces<false>(at, velocity, force, list, begin, first, last, box);
}

CRAZE_MULTIVERSION Sums periodic_forces(const Sphere* at, Vec3* velocity, Vec3* force, const std::int32_t* list,
                                        const std::uint32_t* begin, std::int64_t first, std::int64_t last,
                                        const Vec3& box)
{
    return block_forces<true>(at, velocity, force, list, begin, first, last, box);
}

Sums forces(Packing& p)
{
    std::vector<Sums> partial(static_cast<std::size_t>(p.blocks()));
    const auto kernel = p.periodic ? periodic_forces : walled_forces;
    parallel_ranges(p.blocks(), [&](std::int64_t b_begin, std::int64_t b_end) {
        for (std::int64_t b = b_begin; b < b_end; ++b)
            partial[static_cast<std::size_t>(b)] =
                kernel(p.at.data(), p.velocity.data(), p.force.data(), p.neighbours[static_cast<std::size_t>(b)].data(),
                       p.begin.data() + b * (block + 1), b * block, std::min(p.size(), (b + 1) * block), p.box);
    });
    Sums total;
    for (const Sums& s : partial) {
        total.power += s.power;
        total.force2 += s.force2;
        total.speed2 += s.speed2;
        total.overlap += s.overlap;
        total.contacts += s.contacts;
        total.most = std::max(total.most, s.most);
    }
    return total;
}

/// v <- keep v + steer F, x <- x + dt v; the largest distance from where the neighbours were listed.
double advance(Packing& p, double keep, double steer, double dt)
{
    std::vector<double> farthest(static_cast<std::size_t>(p.blocks()));
    parallel_ranges(p.blocks(), [&](std::int64_t b_begin, std::int64_t b_end) {
        for (std::int64_t b = b_begin; b < b_end; ++b) {
            double most = 0.0;
            for (auto i = static_cast<std::size_t>(b * block),
                      end = static_cast<std::size_t>(std::min(p.size(), (b + 1) * block));
                 i < end; ++i) {
                const Vec3 v = keep * p.velocity[i] + steer * p.force[i];
                p.velocity[i] = v;
                Sphere& s = p.at[i];
                s.x += dt * v.x, s.y += dt * v.y, s.z += dt * v.z;
                const Vec3 moved = Vec3{s.x, s.y, s.z} - p.listed_at[i];
                most = std::max(most, dot(moved, moved));
            }
            farthest[static_cast<std::size_t>(b)] = most;
        }
    });
    return std::sqrt(*std::ranges::max_element(farthest));
}

/// Back into the box what left it through a periodic face, or was pushed through a wall by a first huge overlap.
void bring_back(Packing& p)
{
    for (Sphere& s : p.at) {
        const auto back = [&](double c, double edge) {
            if (!p.periodic) return std::clamp(c, 0.0, edge);
            c -= edge * std::floor(c / edge);
            return c < edge ? c : 0.0;
        };
        s.x = back(s.x, p.box.x), s.y = back(s.y, p.box.y), s.z = back(s.z, p.box.z);
    }
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
    const double R = recipe.mean_radius, r_max = 1.0 + recipe.half_width;

    Packing p{.box = box / R,
              .periodic = recipe.periodic,
              .at = {},
              .velocity = {},
              .force = {},
              .listed_at = {},
              .neighbours = {},
              .begin = {}};
    p.at.resize(static_cast<std::size_t>(n));
    p.velocity.assign(p.at.size(), {});
    p.force.assign(p.at.size(), {});
    p.listed_at.assign(p.at.size(), {});
    p.neighbours.resize(static_cast<std::size_t>(p.blocks()));
    p.begin.resize(static_cast<std::size_t>(n + p.blocks()) + 1);
    scatter(p, recipe);
    reorder(p);

    // FIRE with the constants of Bitzek et al. 2006; the step is bounded by the stiffest oscillation.
    constexpr double dt_most = 0.5, alpha_start = 0.1;
    double dt = 0.1, alpha = alpha_start, skin = 0.5, residual = 1.0;
    std::int64_t downhill = 0, iteration = 0, list_age = 0;
    constexpr std::int64_t most_iterations = 20000;
    bool listed = false;
    // Enough when hardly anything overlaps (median below 0.3 %, all below 2 %), or when nothing moves any more.
    for (; iteration < most_iterations; ++iteration) {
        if (!listed) {
            bring_back(p);
            list_neighbours(p, r_max, skin);
            listed = true;
            list_age = 0;
        }
        const Sums s = forces(p);
        const double mean_overlap = s.overlap / static_cast<double>(std::max<std::int64_t>(s.contacts, 1));
        residual = std::sqrt(s.force2 / static_cast<double>(n)) / std::max(mean_overlap, 1e-9);
        if (residual < 1e-2 || (mean_overlap < 0.0069 && s.most < 0.0196 && residual < 0.1)) break;
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
        listed = advance(p, keep, steer, dt) < 0.5 * skin;
        if (++list_age; !listed)
            skin = std::clamp(list_age > 20 ? 0.8 * skin : list_age < 10 ? 1.25 * skin : skin, 0.02, 0.6);
    }
    bring_back(p);
    reorder(p);
    if (report) *report = {iteration, residual, watch.seconds()};

    Elements out;
    for (auto* axis : {&out.x, &out.y, &out.z, &out.r}) axis->reserve(p.at.size());
    for (const Sphere& s : p.at) {
        out.x.push_back(s.x * R);
        out.y.push_back(s.y * R);
        out.z.push_back(s.z * R);
        out.r.push_back(s.r * R);
    }
    return out;
}

}  // namespace craze::domain
