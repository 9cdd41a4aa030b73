#include "craze/domain/pairs.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/index.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace craze::domain {

namespace {

/// Cells c-1, c, c+1, wrapped in a periodic box, none twice.
std::vector<std::int32_t> around(std::int32_t c, std::int32_t n, bool periodic)
{
    std::vector<std::int32_t> near;
    for (std::int32_t d = -1; d <= 1; ++d) {
        const std::int32_t other = periodic ? (c + d + n) % n : c + d;
        if (other >= 0 && other < n && std::ranges::find(near, other) == near.end()) near.push_back(other);
    }
    return near;
}

}  // namespace

Pairs pairs_within(const Elements& elements, const Vec3& box, double gap, bool periodic)
{
    const std::int64_t n = elements.size();
    if (n == 0) return {};
    const double r_max = *std::ranges::max_element(elements.r);
    const Cells cells(box, 2.0 * r_max + gap, elements.x, elements.y, elements.z);
    const auto count = cells.count();

    constexpr std::int64_t block = 4096;
    const std::int64_t blocks = (n + block - 1) / block;
    std::vector<Pairs> parts(at(blocks));
    parallel_tasks(blocks, [&](std::int64_t b) {
        Pairs& part = parts[at(b)];
        std::vector<std::pair<std::int32_t, double>> found;
        for (std::int64_t i = b * block; i < std::min(n, (b + 1) * block); ++i) {
            const Vec3 c = elements.centre(static_cast<std::int32_t>(i));
            const double r = elements.r[at(i)];
            found.clear();
            for (const std::int32_t cz : around(cells.along(2, c.z), count[2], periodic))
                for (const std::int32_t cy : around(cells.along(1, c.y), count[1], periodic))
                    for (const std::int32_t cx : around(cells.along(0, c.x), count[0], periodic))
                        for (const std::int32_t j : cells.row(cx, cx + 1, cy, cz)) {
                            if (j <= i) continue;
                            Vec3 d = elements.centre(j) - c;
                            if (periodic)
                                for (int axis = 0; axis < 3; ++axis)
                                    d[axis] -= box[axis] * std::nearbyint(d[axis] / box[axis]);
                            const double between = norm(d) - r - elements.r[at(j)];
                            if (between <= gap) found.emplace_back(j, between);
                        }
            std::ranges::sort(found);
            for (const auto& [j, between] : found) {
                part.i.push_back(static_cast<std::int32_t>(i));
                part.j.push_back(j);
                part.gap.push_back(between);
            }
        }
    });
    Pairs all;
    std::size_t total = 0;
    for (const Pairs& part : parts) total += part.i.size();
    all.i.reserve(total), all.j.reserve(total), all.gap.reserve(total);
    for (Pairs& part : parts) {
        all.i.insert(all.i.end(), part.i.begin(), part.i.end());
        all.j.insert(all.j.end(), part.j.begin(), part.j.end());
        all.gap.insert(all.gap.end(), part.gap.begin(), part.gap.end());
        part = {};
    }
    return all;
}

std::vector<std::uint8_t> interior(const Elements& elements, const Vec3& box, double margin)
{
    std::vector<std::uint8_t> inside(at(elements.size()), 1);
    for (std::int32_t e = 0; e < elements.size(); ++e) {
        const Vec3 c = elements.centre(e);
        for (int axis = 0; axis < 3; ++axis)
            if (const double reach = elements.r[at(e)] + margin; !(c[axis] > reach && c[axis] < box[axis] - reach))
                inside[at(e)] = 0;
    }
    return inside;
}

Domain join(Elements elements, const Vec3& box, double mean_radius, const Bonding& bonding, bool periodic)
{
    // Gaps up to 0.3 R_DE hold the paper's 6.2 with ease; a larger cardinality needs a wider search.
    Pairs pairs;
    std::vector<std::size_t> order;
    std::size_t bonded = 0;
    constexpr double touching = 0.05;  // R_DE between surface and wall
    const auto inside =
        periodic ? std::vector<std::uint8_t>(at(elements.size()), 1) : interior(elements, box, touching * mean_radius);
    const auto ends_inside = std::ranges::count(inside, 1);
    const double wanted = bonding.cardinality * static_cast<double>(ends_inside);
    double reach = std::max(bonding.near_gap, 0.1) * mean_radius;
    for (bool enough = ends_inside == 0; !enough;) {
        pairs = pairs_within(elements, box, reach, periodic);
        double ends = 0.0;
        for (std::size_t p = 0; p < pairs.i.size(); ++p) ends += inside[at(pairs.i[p])] + inside[at(pairs.j[p])];
        if (enough = ends >= wanted; !enough) {
            if (reach >= mean_radius)
                throw InvalidInput(fmt::format(
                    "bonds: a cardinality of {:.3g} needs gaps above R_DE; pairs up to there give {:.3g}: pack more "
                    "densely "
                    "or ask for less",
                    bonding.cardinality, ends / static_cast<double>(std::max<std::int64_t>(ends_inside, 1))));
            reach = std::min(2.0 * reach, mean_radius);
        }
    }
    order.resize(pairs.i.size());
    for (std::size_t p = 0; p < order.size(); ++p) order[p] = p;
    // Equal gaps keep the order of pairs, which is that of (i, j).
    std::ranges::stable_sort(order, {}, [&](std::size_t p) { return pairs.gap[p]; });
    for (double ends = 0.0; bonded < order.size() && ends < wanted; ++bonded)
        ends += inside[at(pairs.i[order[bonded]])] + inside[at(pairs.j[order[bonded]])];
    std::vector<std::uint8_t> is_bond(pairs.i.size(), 0);
    for (std::size_t p = 0; p < bonded; ++p) is_bond[order[p]] = 1;

    Domain domain;
    domain.box = box;
    domain.mean_radius = mean_radius;
    for (std::size_t p = 0; p < pairs.i.size(); ++p) {
        if (periodic) {
            const Vec3 d = elements.centre(pairs.j[p]) - elements.centre(pairs.i[p]);
            if (norm(d) - elements.r[at(pairs.i[p])] - elements.r[at(pairs.j[p])] > reach) continue;
        }
        if (is_bond[p] != 0) {
            domain.bonds.i.push_back(pairs.i[p]);
            domain.bonds.j.push_back(pairs.j[p]);
        } else if (pairs.gap[p] <= bonding.near_gap * mean_radius) {
            domain.near.i.push_back(pairs.i[p]);
            domain.near.j.push_back(pairs.j[p]);
        }
    }
    domain.bonds.kind.assign(domain.bonds.i.size(), BondKind::beam);
    domain.bonds.thickness.assign(domain.bonds.i.size(), 0.0);
    domain.near.thickness.assign(domain.near.i.size(), 0.0);
    for (const double r : elements.r) domain.dense_volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    domain.elements = std::move(elements);
    return domain;
}

}  // namespace craze::domain
