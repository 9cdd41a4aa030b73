#include "craze/domain/quality.hpp"

#include "craze/core/index.hpp"
#include "craze/core/json.hpp"
#include "craze/domain/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace craze::domain {

namespace {

double sphere_volume(double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; }

void density(const Domain& d, Quality& q)
{
    const double box = d.box.x * d.box.y * d.box.z, margin = 4.0 * d.mean_radius;
    const double inner_box =
        std::max(0.0, d.box.x - 2 * margin) * std::max(0.0, d.box.y - 2 * margin) * std::max(0.0, d.box.z - 2 * margin);
    double all = 0.0, inner = 0.0;
    for (std::int32_t e = 0; e < d.elements.size(); ++e) {
        const Vec3 c = d.elements.centre(e);
        const double v = sphere_volume(d.elements.r[at(e)]);
        all += v;
        const auto in = [&](int axis) { return c[axis] > margin && c[axis] < d.box[axis] - margin; };
        if (in(0) && in(1) && in(2)) inner += v;
    }
    q.volume_fraction = all / box;
    q.interior_volume_fraction = inner_box > 0.0 ? inner / inner_box : 0.0;
}

void overlaps(const Domain& d, Quality& q)
{
    std::vector<double> overlap;
    const auto add = [&](std::int32_t i, std::int32_t j) {
        const double reach = d.elements.r[at(i)] + d.elements.r[at(j)];
        const double o = 1.0 - norm(d.elements.centre(j) - d.elements.centre(i)) / reach;
        if (o > 0.0) overlap.push_back(o);
    };
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) add(d.bonds.i[b], d.bonds.j[b]);
    for (std::size_t p = 0; p < d.near.i.size(); ++p) add(d.near.i[p], d.near.j[p]);
    q.touching = static_cast<std::int64_t>(overlap.size());
    if (d.elements.size() > 0) q.contact_number = 2.0 * static_cast<double>(overlap.size()) / d.elements.size();
    q.overlap = five_numbers(std::move(overlap));
}

void bonds(const Domain& d, Quality& q)
{
    const auto inside = interior(d.elements, d.box, 0.05 * d.mean_radius);
    std::vector<std::int32_t> bonded(inside.size(), 0);
    std::vector<double> lengths;
    q.bond_length_counts.assign(60, 0);
    std::int64_t beams = 0;
    for (std::int32_t b = 0; b < d.bonds.size(); ++b) {
        const std::int32_t i = d.bonds.i[at(b)], j = d.bonds.j[at(b)];
        ++bonded[at(i)];
        ++bonded[at(j)];
        const Vec3 between = d.elements.centre(j) - d.elements.centre(i);
        const double L_0 = norm(between), scaled = L_0 / (2.0 * d.mean_radius);
        lengths.push_back(scaled);
        if (const double bin = std::floor((scaled - 0.7) / 0.01); bin >= 0.0 && bin < 60.0)
            ++q.bond_length_counts[static_cast<std::size_t>(bin)];
        if (d.bonds.kind[at(b)] != BondKind::beam) continue;
        const Vec3 n = between / L_0;
        const std::array<double, 6> dyad{n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.y * n.z, n.z * n.x};
        for (std::size_t k = 0; k < 6; ++k) q.fabric[k] += dyad[k];
        ++beams;
    }
    if (beams > 0)
        for (double& f : q.fabric) f /= static_cast<double>(beams);
    q.bond_length = five_numbers(std::move(lengths));
    q.rattlers = std::ranges::count(bonded, 0);
    std::int64_t ends = 0, elements = 0;
    for (std::size_t e = 0; e < inside.size(); ++e) ends += inside[e] * bonded[e], elements += inside[e];
    if (d.elements.size() > 0) q.cardinality = 2.0 * d.bonds.size() / d.elements.size();
    if (elements > 0) q.interior_cardinality = static_cast<double>(ends) / static_cast<double>(elements);
}

void components(const Domain& d, Quality& q)
{
    std::vector<std::int32_t> parent(d.elements.r.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](std::int32_t e) {
        while (parent[at(e)] != e) e = parent[at(e)] = parent[at(parent[at(e)])];
        return e;
    };
    std::vector<std::uint8_t> has_bond(parent.size(), 0);
    for (std::int32_t b = 0; b < d.bonds.size(); ++b) {
        has_bond[at(d.bonds.i[at(b)])] = has_bond[at(d.bonds.j[at(b)])] = 1;
        if (d.bonds.kind[at(b)] == BondKind::beam) parent[at(root(d.bonds.i[at(b)]))] = root(d.bonds.j[at(b)]);
    }
    std::vector<std::int32_t> size(parent.size(), 0);
    for (std::int32_t e = 0; e < d.elements.size(); ++e) ++size[at(root(e))];
    for (std::int32_t e = 0; e < d.elements.size(); ++e)
        if (root(e) == e && (size[at(e)] > 1 || has_bond[at(e)] != 0)) ++q.components;
    if (!size.empty())
        q.largest_component = static_cast<double>(*std::ranges::max_element(size)) / static_cast<double>(size.size());
}

}  // namespace

std::array<double, 5> five_numbers(std::vector<double> values)
{
    if (values.empty()) return {};
    std::ranges::sort(values);
    const auto at_share = [&](double share) {
        return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
    };
    return {values.front(), at_share(0.25), at_share(0.5), at_share(0.75), values.back()};
}

Quality quality(const Domain& domain)
{
    Quality q;
    density(domain, q);
    overlaps(domain, q);
    bonds(domain, q);
    components(domain, q);
    return q;
}

Json as_json(const Quality& q)
{
    const auto five = [](const std::array<double, 5>& v) {
        return Json{{"least", v[0]}, {"quartile", v[1]}, {"median", v[2]}, {"upper_quartile", v[3]}, {"most", v[4]}};
    };
    return {{"volume_fraction", q.volume_fraction},
            {"interior_volume_fraction", q.interior_volume_fraction},
            {"overlap", five(q.overlap)},
            {"touching_pairs", q.touching},
            {"contact_number", q.contact_number},
            {"cardinality", q.cardinality},
            {"interior_cardinality", q.interior_cardinality},
            {"rattlers", q.rattlers},
            {"components", q.components},
            {"largest_component", q.largest_component},
            {"fabric",
             {{"xx", q.fabric[0]},
              {"yy", q.fabric[1]},
              {"zz", q.fabric[2]},
              {"xy", q.fabric[3]},
              {"yz", q.fabric[4]},
              {"zx", q.fabric[5]}}},
            {"bond_length_in_diameters", five(q.bond_length)},
            {"bond_length_histogram", {{"from", 0.7}, {"to", 1.3}, {"counts", q.bond_length_counts}}}};
}

}  // namespace craze::domain
