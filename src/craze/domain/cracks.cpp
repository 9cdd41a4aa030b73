#include "craze/domain/cracks.hpp"

#include "craze/core/index.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/orientation.hpp"
#include "craze/domain/voxel_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace craze::domain {

namespace {

struct Bounds {
    Vec3 least, most;
};

Bounds bounds(const Vec3& a, const Vec3& b)
{
    return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
            {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

Bounds bounds(const Bounds& a, const Vec3& b) { return {bounds(a.least, b).least, bounds(a.most, b).most}; }

/// Segments listed in every cell that they pass.
class SegmentGrid {
public:
    SegmentGrid(const Elements& elements, std::span<const std::int32_t> i, std::span<const std::int32_t> j)
    {
        const auto segments = static_cast<std::int64_t>(i.size());
        box_ = bounds(elements.centre(i[0]), elements.centre(j[0]));
        for (std::size_t s = 0; s < i.size(); ++s)
            box_ = bounds(bounds(box_, elements.centre(i[s])), elements.centre(j[s]));
        const double length = parallel_sum(
            segments, [&](std::int64_t s) { return norm(elements.centre(j[at(s)]) - elements.centre(i[at(s)])); });
        // A third of a segment: few cells to a segment, few segments to a cell.
        const Vec3 size = box_.most - box_.least;
        edge_ = length / static_cast<double>(segments) / 3.0;
        edge_ = std::max({edge_, std::max({size.x, size.y, size.z}) / 2000.0, 1e-300});
        while (cells_along(size) > 16.0 * static_cast<double>(segments) + 1000.0) edge_ *= 1.25;
        for (int axis = 0; axis < 3; ++axis) count_[at(axis)] = static_cast<std::int32_t>(size[axis] / edge_) + 1;

        std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> found(at((segments + block - 1) / block));
        parallel_tasks(static_cast<std::int64_t>(found.size()), [&](std::int64_t b) {
            for (std::int64_t s = b * block; s < std::min(segments, (b + 1) * block); ++s)
                for_cells_of(elements.centre(i[at(s)]), elements.centre(j[at(s)]), [&](std::int64_t cell) {
                    found[at(b)].emplace_back(static_cast<std::int32_t>(cell), static_cast<std::int32_t>(s));
                });
        });
        start_.assign(at(std::int64_t{count_[0]} * count_[1] * count_[2]) + 1, 0);
        for (const auto& part : found)
            for (const auto& entry : part) ++start_[at(entry.first) + 1];
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        segment_.resize(at(start_.back()));
        std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
        for (const auto& part : found)
            for (const auto& [cell, s] : part) segment_[at(next[at(cell)]++)] = s;
    }

    /// visit(segment) for those of every cell that the triangle can touch; one may come more than once.
    template <class Visit>
    void near_triangle(const Vec3& a, const Vec3& b, const Vec3& c, Visit&& visit) const
    {
        const Bounds t = bounds(bounds(a, b), c);
        std::array<std::int32_t, 3> first, last;
        for (int axis = 0; axis < 3; ++axis) {
            if (t.most[axis] < box_.least[axis] || t.least[axis] > box_.most[axis]) return;
            first[at(axis)] = along(axis, t.least[axis]);
            last[at(axis)] = along(axis, t.most[axis]);
        }
        const bool large = (last[0] - first[0] + 1) * (last[1] - first[1] + 1) > 16;
        const Vec3 normal = large ? cross(b - a, c - a) : Vec3{};
        const double reach = 0.51 * edge_ * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
        for (std::int32_t cz = first[2]; cz <= last[2]; ++cz)
            for (std::int32_t cy = first[1]; cy <= last[1]; ++cy) {
                const std::int64_t row = std::int64_t{count_[0]} * (cy + std::int64_t{count_[1]} * cz);
                if (!large) {
                    for (auto e = start_[at(row + first[0])]; e < start_[at(row + last[0]) + 1]; ++e)
                        visit(segment_[at(e)]);
                    continue;
                }
                // A large triangle fills little of its bounds: leave out cells that its plane misses.
                for (std::int32_t cx = first[0]; cx <= last[0]; ++cx) {
                    const Vec3 centre = box_.least + edge_ * Vec3{cx + 0.5, cy + 0.5, cz + 0.5};
                    if (std::abs(dot(normal, centre - a)) > reach) continue;
                    for (auto e = start_[at(row + cx)]; e < start_[at(row + cx) + 1]; ++e) visit(segment_[at(e)]);
                }
            }
    }

private:
    static constexpr std::int64_t block = 4096;

    double cells_along(const Vec3& size) const
    {
        return (size.x / edge_ + 1.0) * (size.y / edge_ + 1.0) * (size.z / edge_ + 1.0);
    }
    std::int32_t along(int axis, double position) const
    {
        const double cell = (position - box_.least[axis]) / edge_;
        return static_cast<std::int32_t>(std::clamp(cell, 0.0, static_cast<double>(count_[at(axis)] - 1)));
    }

    /// The cells that a segment passes, or comes so near to that rounding could tell otherwise.
    template <class Visit>
    void for_cells_of(const Vec3& p, const Vec3& q, Visit&& visit) const
    {
        const Bounds s = bounds(p, q);
        const Vec3 d = q - p;
        const double slack = 1e-6 * edge_;
        std::array<std::int32_t, 3> first, last;
        for (int axis = 0; axis < 3; ++axis) {
            first[at(axis)] = along(axis, s.least[axis] - slack);
            last[at(axis)] = along(axis, s.most[axis] + slack);
        }
        for (std::int32_t cz = first[2]; cz <= last[2]; ++cz)
            for (std::int32_t cy = first[1]; cy <= last[1]; ++cy)
                for (std::int32_t cx = first[0]; cx <= last[0]; ++cx) {
                    const Vec3 corner = box_.least + edge_ * Vec3{double(cx), double(cy), double(cz)};
                    double enter = 0.0, leave = 1.0;
                    for (int axis = 0; axis < 3; ++axis) {
                        if (std::abs(d[axis]) < slack) continue;  // the range of cells has seen to this axis
                        const double t0 = (corner[axis] - slack - p[axis]) / d[axis];
                        const double t1 = (corner[axis] + edge_ + slack - p[axis]) / d[axis];
                        enter = std::max(enter, std::min(t0, t1));
                        leave = std::min(leave, std::max(t0, t1));
                    }
                    if (enter <= leave) visit(cx + std::int64_t{count_[0]} * (cy + std::int64_t{count_[1]} * cz));
                }
    }

    Bounds box_;
    double edge_ = 0.0;
    std::array<std::int32_t, 3> count_{};
    std::vector<std::int32_t> start_, segment_;
};

std::uint8_t capped(std::int32_t count) { return static_cast<std::uint8_t>(std::min(count, 255)); }

}  // namespace

std::vector<std::uint8_t> triangles_met(const Elements& elements, std::span<const std::int32_t> i,
                                        std::span<const std::int32_t> j, const mesh::CrackSurface& surface)
{
    std::vector<std::uint8_t> met(i.size(), 0);
    if (i.empty() || surface.triangles.empty()) return met;
    const SegmentGrid grid(elements, i, j);

    constexpr std::int64_t block = 1 << 15;
    const auto triangles = static_cast<std::int64_t>(surface.triangles.size());
    std::vector<std::vector<std::int32_t>> hits(at((triangles + block - 1) / block));
    parallel_tasks(static_cast<std::int64_t>(hits.size()), [&](std::int64_t task) {
        auto& mine = hits[at(task)];
        for (std::int64_t t = task * block; t < std::min(triangles, (task + 1) * block); ++t) {
            const auto& corner = surface.triangles[at(t)];
            const Vec3 &a = surface.vertices[at(corner[0])], &b = surface.vertices[at(corner[1])],
                       &c = surface.vertices[at(corner[2])];
            const std::size_t before = mine.size();
            grid.near_triangle(a, b, c, [&](std::int32_t s) {
                if (std::find(mine.begin() + static_cast<std::ptrdiff_t>(before), mine.end(), s) != mine.end()) return;
                if (meets(elements.centre(i[at(s)]), elements.centre(j[at(s)]), a, b, c)) mine.push_back(s);
            });
        }
    });
    for (const auto& part : hits)
        for (const std::int32_t s : part) met[at(s)] = capped(met[at(s)] + 1);
    return met;
}

std::vector<std::uint8_t> crack_voxel_runs_met(const Elements& elements, std::span<const std::int32_t> i,
                                               std::span<const std::int32_t> j, const Mask& crack, double voxel_size)
{
    std::vector<std::uint8_t> met(i.size(), 0);
    parallel_ranges(static_cast<std::int64_t>(i.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t s = begin; s < end; ++s) {
            bool in_crack = false;
            std::int32_t runs = 0;
            walk_voxels(elements.centre(i[at(s)]), elements.centre(j[at(s)]), voxel_size, crack.shape(),
                        [&](std::int64_t x, std::int64_t y, std::int64_t z) {
                            const bool now = crack(x, y, z);
                            runs += now && !in_crack;
                            in_crack = now;
                        });
            met[at(s)] = capped(runs);
        }
    });
    return met;
}

}  // namespace craze::domain
