// A small specimen with defects of known place: what `domain` would give, made on the spot.

#pragma once

#include "craze/domain/discretisation.hpp"
#include "support/packings.hpp"

namespace craze::support {

/// A penny without thickness in its geometry, centre and normal; bonds it cuts get the aperture it is given.
struct Penny {
    Vec3 centre, normal;
    double radius = 0.0, aperture = 0.0;
};

inline bool cuts(const Penny& penny, const Vec3& a, const Vec3& b)
{
    const double da = dot(a - penny.centre, penny.normal), db = dot(b - penny.centre, penny.normal);
    if ((da < 0.0) == (db < 0.0)) return false;
    return norm(a + (b - a) * (da / (da - db)) - penny.centre) < penny.radius;
}

/// Marks the bonds and near pairs that pennies cut (T1 = T2 = the largest aperture), and elements inside balls as
/// pores.
inline domain::Discretisation with_pennies(domain::Domain dense, const std::vector<Penny>& pennies,
                                           const std::vector<std::pair<Vec3, double>>& balls = {})
{
    domain::Discretisation d;
    d.dense = std::move(dense);
    const auto& e = d.dense.elements;
    for (std::int32_t k = 0; k < e.size(); ++k) {
        bool inside = false;
        for (const auto& [centre, radius] : balls) inside = inside || norm(e.centre(k) - centre) < radius;
        d.in_pore.push_back(inside ? 1 : 0);
    }
    const auto mark = [&](const std::vector<std::int32_t>& i, const std::vector<std::int32_t>& j,
                          domain::PairCracks& c) {
        for (std::size_t b = 0; b < i.size(); ++b) {
            double thickness = 0.0;
            std::uint8_t cut = 0;
            for (const auto& penny : pennies)
                if (cuts(penny, e.centre(i[b]), e.centre(j[b]))) ++cut, thickness = std::max(thickness, penny.aperture);
            c.cut.push_back(cut), c.T1.push_back(thickness), c.T2.push_back(thickness);
        }
    };
    mark(d.dense.bonds.i, d.dense.bonds.j, d.bonds);
    mark(d.dense.near.i, d.dense.near.j, d.near);
    return d;
}

/// Pennies at random places and in random directions, of one radius, sum a^3 / V = density, within the box.
inline std::vector<Penny> random_pennies(const Vec3& box, double radius, double density, double aperture,
                                         std::uint64_t seed)
{
    std::vector<Penny> pennies;
    const double volume = box.x * box.y * box.z;
    const auto count = static_cast<std::int64_t>(density * volume / (radius * radius * radius) + 0.5);
    for (std::int64_t k = 0; k < count; ++k) {
        Random random(seed, static_cast<std::uint64_t>(k));
        Penny p;
        p.centre = {random.uniform(0.0, box.x), random.uniform(0.0, box.y), random.uniform(0.0, box.z)};
        p.normal = normalized(Vec3{random.normal(), random.normal(), random.normal()});
        p.radius = radius, p.aperture = aperture;
        pennies.push_back(p);
    }
    return pennies;
}

}  // namespace craze::support
