#include "craze/report/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace craze::report {

namespace {

using mesh::CrackSurface;

/// Each vertex's cell, as a rank in the order of cells.
std::vector<std::int32_t> ranked_cells(const std::vector<Vec3>& vertices, const Vec3& low, double cell)
{
    std::vector<std::uint64_t> key(vertices.size());
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        std::uint64_t word = 0;
        for (int axis = 0; axis < 3; ++axis)
            word =
                word << 21U | static_cast<std::uint64_t>(std::min(2097151.0, (vertices[k][axis] - low[axis]) / cell));
        key[k] = word;
    }
    auto order = key;
    std::sort(order.begin(), order.end());
    order.erase(std::unique(order.begin(), order.end()), order.end());
    std::vector<std::int32_t> rank(vertices.size());
    for (std::size_t k = 0; k < key.size(); ++k)
        rank[k] = static_cast<std::int32_t>(std::lower_bound(order.begin(), order.end(), key[k]) - order.begin());
    return rank;
}

/// Triangles of cells, none flat, none twice, each from its smallest corner on.
std::vector<std::array<std::int32_t, 3>> kept(const CrackSurface& surface, const std::vector<std::int32_t>& rank)
{
    struct Keyed {
        std::array<std::int32_t, 3> sorted, turned;
    };
    std::vector<Keyed> all;
    for (const auto& t : surface.triangles) {
        std::array<std::int32_t, 3> c{rank[static_cast<std::size_t>(t[0])], rank[static_cast<std::size_t>(t[1])],
                                      rank[static_cast<std::size_t>(t[2])]};
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        Keyed keyed{c, c};
        std::sort(keyed.sorted.begin(), keyed.sorted.end());
        all.push_back(keyed);
    }
    std::sort(all.begin(), all.end(), [](const Keyed& a, const Keyed& b) {
        return std::tie(a.sorted, a.turned) < std::tie(b.sorted, b.turned);
    });
    all.erase(std::unique(all.begin(), all.end(), [](const Keyed& a, const Keyed& b) { return a.sorted == b.sorted; }),
              all.end());
    std::vector<std::array<std::int32_t, 3>> out(all.size());
    for (std::size_t k = 0; k < all.size(); ++k) out[k] = all[k].turned;
    return out;
}

/// Vertices renumbered in the order triangles first name them: near in the list when near in the sheet.
CrackSurface compacted(std::vector<Vec3> vertices, std::vector<std::array<std::int32_t, 3>> triangles)
{
    std::vector<std::int32_t> now(vertices.size(), -1);
    CrackSurface out;
    for (auto& t : triangles)
        for (auto& corner : t) {
            auto& place = now[static_cast<std::size_t>(corner)];
            if (place < 0)
                place = static_cast<std::int32_t>(out.vertices.size()),
                out.vertices.push_back(vertices[static_cast<std::size_t>(corner)]);
            corner = place;
        }
    out.triangles = std::move(triangles);
    return out;
}

}  // namespace

CrackSurface decimated(const CrackSurface& surface, std::int64_t most)
{
    const auto count = [](const auto& list) { return static_cast<std::int64_t>(list.size()); };
    if (count(surface.triangles) <= most) return compacted(surface.vertices, surface.triangles);

    Vec3 low = surface.vertices.front();
    double area = 0.0;
    for (const auto& v : surface.vertices)
        for (int axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], v[axis]);
    for (const auto& t : surface.triangles) {
        const auto at = [&](std::size_t k) { return surface.vertices[static_cast<std::size_t>(t[k])]; };
        area += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
    }
    // Two triangles to a cell of a sheet is the first guess; the count then falls as the square of the cell.
    double cell = std::sqrt(2.0 * area / static_cast<double>(most));
    double least = 0.0, enough = 0.0;
    std::vector<std::int32_t> rank;
    std::vector<std::array<std::int32_t, 3>> triangles;
    for (int step = 0; step < 24; ++step) {
        auto trial_rank = ranked_cells(surface.vertices, low, cell);
        auto trial = kept(surface, trial_rank);
        const auto left = count(trial);
        if (left <= most) {
            enough = cell;
            rank = std::move(trial_rank), triangles = std::move(trial);
            if (left > most * 85 / 100 || (least > 0.0 && enough < 1.03 * least)) break;
        } else {
            least = cell;
        }
        if (enough == 0.0)
            cell *= std::clamp(1.02 * std::sqrt(static_cast<double>(left) / static_cast<double>(most)), 1.02, 3.0);
        else
            cell = least > 0.0 ? 0.5 * (least + enough) : 0.7 * cell;
    }
    const auto cells =
        rank.empty() ? std::size_t{0} : static_cast<std::size_t>(*std::max_element(rank.begin(), rank.end())) + 1;
    std::vector<Vec3> mean(cells);
    std::vector<double> members(cells, 0.0);
    for (std::size_t k = 0; k < rank.size(); ++k)
        mean[static_cast<std::size_t>(rank[k])] += surface.vertices[k],
            members[static_cast<std::size_t>(rank[k])] += 1.0;
    for (std::size_t k = 0; k < cells; ++k) mean[k] *= 1.0 / members[k];
    return compacted(std::move(mean), std::move(triangles));
}

}  // namespace craze::report
