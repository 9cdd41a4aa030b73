// Lattices to test on: small random packings made on the spot, chains, and the reference packing where it is there.

#pragma once

#include "craze/core/random.hpp"
#include "craze/core/vec3.hpp"
#include "craze/domain/domain.hpp"
#include "support/data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace craze::support {

/// Bonds the given pairs with beams, sorted, with everything else a Domain needs.
inline domain::Domain bonded(Vec3 box, std::vector<Vec3> centres, std::vector<double> radii,
                             std::vector<std::pair<std::int32_t, std::int32_t>> pairs)
{
    domain::Domain d;
    d.box = box;
    for (std::size_t e = 0; e < centres.size(); ++e) {
        d.elements.x.push_back(centres[e].x), d.elements.y.push_back(centres[e].y),
            d.elements.z.push_back(centres[e].z);
        d.elements.r.push_back(radii[e]);
        d.mean_radius += radii[e] / static_cast<double>(radii.size());
        d.dense_volume += 4.0 / 3.0 * std::numbers::pi * std::pow(radii[e], 3);
    }
    for (auto& [i, j] : pairs)
        if (i > j) std::swap(i, j);
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [i, j] : pairs) d.bonds.i.push_back(i), d.bonds.j.push_back(j);
    d.bonds.kind.assign(pairs.size(), domain::BondKind::beam);
    d.bonds.thickness.assign(pairs.size(), 0.0);
    return d;
}

/// A straight chain of `beams` equal beams of total length 1 m along x; radii of 1 m make R_B = r~.
inline domain::Domain chain(int beams)
{
    std::vector<Vec3> centres;
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (int e = 0; e <= beams; ++e) centres.push_back({static_cast<double>(e) / beams, 0.0, 0.0});
    for (int e = 0; e < beams; ++e) pairs.emplace_back(e, e + 1);
    return bonded({1.0, 1.0, 1.0}, centres, std::vector<double>(centres.size(), 1.0), pairs);
}

/// Pairs nearer than `reach` (surface to surface), sorted by surface gap.
inline std::vector<std::tuple<double, std::int32_t, std::int32_t>> close_pairs(const std::vector<Vec3>& at,
                                                                               const std::vector<double>& r,
                                                                               double reach)
{
    const double cell = 2.0 * *std::max_element(r.begin(), r.end()) + reach;
    std::map<std::tuple<int, int, int>, std::vector<std::int32_t>> cells;
    const auto cell_of = [&](const Vec3& p) {
        return std::tuple{static_cast<int>(std::floor(p.x / cell)), static_cast<int>(std::floor(p.y / cell)),
                          static_cast<int>(std::floor(p.z / cell))};
    };
    for (std::size_t e = 0; e < at.size(); ++e) cells[cell_of(at[e])].push_back(static_cast<std::int32_t>(e));
    std::vector<std::tuple<double, std::int32_t, std::int32_t>> pairs;
    for (std::size_t e = 0; e < at.size(); ++e) {
        const auto [cx, cy, cz] = cell_of(at[e]);
        for (int n = 0; n < 27; ++n) {
            const auto found = cells.find({cx + n % 3 - 1, cy + n / 3 % 3 - 1, cz + n / 9 - 1});
            if (found == cells.end()) continue;
            for (const std::int32_t other : found->second) {
                const auto o = static_cast<std::size_t>(other);
                const double gap = norm(at[o] - at[e]) - r[o] - r[e];
                if (o > e && gap < reach) pairs.emplace_back(gap, static_cast<std::int32_t>(e), other);
            }
        }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// About n elements of mean radius 200 nm in a cube, relaxed until they barely overlap, bonded to the given
/// cardinality; unbonded pairs nearer than 0.2 radii are near pairs. Sorted in columns along z, not along a Morton
/// curve.
inline domain::Domain small_packing(int n, std::uint64_t seed, double cardinality = 6.2)
{
    constexpr double R = 200e-9;
    const double edge = R * std::cbrt(4.0 / 3.0 * std::numbers::pi * n / 0.64);
    Random random(seed);
    std::vector<Vec3> at;
    std::vector<double> r;
    for (int e = 0; e < n; ++e) {
        r.push_back(R * random.uniform(0.875, 1.125));
        at.push_back({random.uniform(0.0, edge), random.uniform(0.0, edge), random.uniform(0.0, edge)});
    }
    for (int sweep = 0; sweep < 150; ++sweep) {
        for (const auto& [gap, i, j] : close_pairs(at, r, 0.0)) {
            auto &a = at[static_cast<std::size_t>(i)], &b = at[static_cast<std::size_t>(j)];
            const Vec3 d = b - a;
            const double now = norm(d), overlap = r[static_cast<std::size_t>(i)] + r[static_cast<std::size_t>(j)] - now;
            if (overlap <= 0.0) continue;
            const Vec3 push = d * (0.5 * overlap / now);
            a -= push, b += push;
        }
        for (std::size_t e = 0; e < at.size(); ++e)
            for (int axis = 0; axis < 3; ++axis) at[e][axis] = std::clamp(at[e][axis], r[e], edge - r[e]);
    }
    std::vector<std::size_t> order(at.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t e) {
        return std::tuple{std::floor(at[e].x / (4 * R)), std::floor(at[e].y / (4 * R)), at[e].z};
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    std::vector<Vec3> centres;
    std::vector<double> radii;
    for (const std::size_t e : order) centres.push_back(at[e]), radii.push_back(r[e]);

    const auto pairs = close_pairs(centres, radii, 0.5 * R);
    const auto wanted = std::min(pairs.size(), static_cast<std::size_t>(0.5 * cardinality * n));
    std::vector<std::pair<std::int32_t, std::int32_t>> bonds, near;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const auto& [gap, i, j] = pairs[p];
        if (p < wanted)
            bonds.emplace_back(i, j);
        else if (gap < 0.2 * R)
            near.emplace_back(i, j);
    }
    domain::Domain d = bonded({edge, edge, edge}, centres, radii, bonds);
    std::sort(near.begin(), near.end());
    for (const auto& [i, j] : near) d.near.i.push_back(i), d.near.j.push_back(j);
    d.near.thickness.assign(near.size(), 0.0);
    return d;
}

inline std::filesystem::path reference_packing_file()
{
    return data_folder().parent_path() / "reference" / "packing_92k.txt.gz";
}

/// The reference packing: 92 000 elements, 278 000 bonds, sorted along a Morton curve.
inline domain::Domain reference_packing()
{
    const std::string command = "gzip -dc '" + reference_packing_file().string() + "'";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> text(::popen(command.c_str(), "r"), ::pclose);
    int n = 0, m = 0;
    if (!text || std::fscanf(text.get(), "%d %d", &n, &m) != 2)
        throw std::runtime_error("cannot read the reference packing");
    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    std::vector<Vec3> at;
    std::vector<double> r;
    const auto spread = [](double um) {
        std::uint64_t bits = static_cast<std::uint64_t>(um * 1000.0), out = 0;
        for (int k = 0; k < 20; ++k) out |= ((bits >> k) & 1U) << (3 * k);
        return out;
    };
    for (int e = 0; e < n; ++e) {
        double x = 0, y = 0, z = 0, radius = 0;
        if (std::fscanf(text.get(), "%lf %lf %lf %lf", &x, &y, &z, &radius) != 4)
            throw std::runtime_error("short packing");
        order.emplace_back(spread(x) | spread(y) << 1 | spread(z) << 2, at.size());
        at.push_back(Vec3{x, y, z} * 1e-6), r.push_back(radius * 1e-6);
    }
    std::sort(order.begin(), order.end());
    std::vector<Vec3> centres;
    std::vector<double> radii;
    std::vector<std::int32_t> now_at(at.size());
    for (const auto& [key, old] : order) {
        now_at[old] = static_cast<std::int32_t>(centres.size());
        centres.push_back(at[old]), radii.push_back(r[old]);
    }
    std::vector<std::pair<std::int32_t, std::int32_t>> bonds;
    for (int b = 0; b < m; ++b) {
        int i = 0, j = 0;
        if (std::fscanf(text.get(), "%d %d", &i, &j) != 2) throw std::runtime_error("short packing");
        bonds.emplace_back(now_at[static_cast<std::size_t>(i)], now_at[static_cast<std::size_t>(j)]);
    }
    return bonded(Vec3{17.6, 13.2, 21.2} * 1e-6, centres, radii, bonds);
}

}  // namespace craze::support
