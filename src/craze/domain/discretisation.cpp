#include "craze/domain/discretisation.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/index.hpp"
#include "craze/core/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace craze::domain {

namespace {

void check(const Discretisation& d, const Defects& defects)
{
    const auto fits = [](const PairCracks& cracks, std::int32_t pairs) {
        return cracks.cut.size() == at(pairs) && cracks.T1.size() == at(pairs) && cracks.T2.size() == at(pairs);
    };
    if (d.in_pore.size() != at(d.dense.elements.size()))
        throw InvalidInput(fmt::format("discretisation: needs one pore flag per element ({}), got {}",
                                       d.dense.elements.size(), d.in_pore.size()));
    if (!fits(d.bonds, d.dense.bonds.size()) || !fits(d.near, d.dense.near.size()))
        throw InvalidInput(fmt::format("discretisation: needs cut, T1 and T2 for each of {} bonds and {} near pairs",
                                       d.dense.bonds.size(), d.dense.near.size()));
    if (defects.thickness == Defects::Thickness::constant &&
        !(defects.constant >= 0.0 && std::isfinite(defects.constant)))
        throw InvalidInput(
            fmt::format("crack thickness: needs a finite length of at least 0, got {} m", defects.constant));
}

double thickness(const PairCracks& cracks, std::size_t pair, const Defects& defects)
{
    switch (defects.thickness) {
        case Defects::Thickness::T1: return cracks.T1[pair];
        case Defects::Thickness::T2: return cracks.T2[pair];
        case Defects::Thickness::constant: return defects.constant;
        case Defects::Thickness::closed: break;
    }
    return 0.0;
}

}  // namespace

Domain with_defects(const Discretisation& d, const Defects& defects)
{
    check(d, defects);
    Domain out;
    out.box = d.dense.box;
    out.mean_radius = d.dense.mean_radius;
    out.dense_volume = d.dense.dense_volume;

    std::vector<std::int32_t> renumbered(d.in_pore.size(), -1);
    const Elements& from = d.dense.elements;
    for (std::int32_t e = 0; e < from.size(); ++e) {
        if (defects.pores && d.in_pore[at(e)] != 0) continue;
        renumbered[at(e)] = out.elements.size();
        out.elements.x.push_back(from.x[at(e)]);
        out.elements.y.push_back(from.y[at(e)]);
        out.elements.z.push_back(from.z[at(e)]);
        out.elements.r.push_back(from.r[at(e)]);
    }

    std::int64_t bounded = 0;
    const Bonds& bonds = d.dense.bonds;
    for (std::int32_t b = 0; b < bonds.size(); ++b) {
        const std::int32_t i = renumbered[at(bonds.i[at(b)])], j = renumbered[at(bonds.j[at(b)])];
        if (i < 0 || j < 0) continue;
        const bool cut = defects.cracks && d.bonds.cut[at(b)] != 0;
        double T = cut ? thickness(d.bonds, at(b), defects) : 0.0;
        if (const double L_0 = rest_length(d.dense, b); T > L_0) {
            T = L_0;
            ++bounded;
        }
        out.bonds.i.push_back(i);
        out.bonds.j.push_back(j);
        out.bonds.kind.push_back(cut ? BondKind::contact_beam : BondKind::beam);
        out.bonds.thickness.push_back(T);
    }
    if (bounded > 0)
        notice(fmt::format("domain: {} of {} cracks are thicker than their bond is long; T is bounded to L_0 [Eq. 9]",
                           bounded, std::ranges::count(out.bonds.kind, BondKind::contact_beam)));

    const NearPairs& near = d.dense.near;
    for (std::int32_t p = 0; p < near.size(); ++p) {
        const std::int32_t i = renumbered[at(near.i[at(p)])], j = renumbered[at(near.j[at(p)])];
        if (i < 0 || j < 0) continue;
        const bool cut = defects.cracks && d.near.cut[at(p)] != 0;
        out.near.i.push_back(i);
        out.near.j.push_back(j);
        out.near.thickness.push_back(cut ? thickness(d.near, at(p), defects) : 0.0);
    }
    return out;
}

double discrete_porosity(const Discretisation& d)
{
    double dense = 0.0, in_pores = 0.0;
    for (std::int32_t e = 0; e < d.dense.elements.size(); ++e) {
        const double r = d.dense.elements.r[at(e)];
        dense += r * r * r;
        if (d.in_pore[at(e)] != 0) in_pores += r * r * r;
    }
    return dense > 0.0 ? in_pores / dense : 0.0;
}

}  // namespace craze::domain
