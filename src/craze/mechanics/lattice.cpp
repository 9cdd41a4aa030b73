#include "craze/mechanics/lattice.hpp"

#include "craze/core/errors.hpp"
#include "craze/mechanics/state.hpp"

#include <fmt/format.h>

#include <cmath>

namespace craze::mechanics {

namespace {

void check_material(const BeamMaterial& m, double R_DE, double rho_D)
{
    const auto positive = [](double v) { return v > 0.0 && std::isfinite(v); };
    if (!(positive(m.E_B) && positive(m.r_tilde) && m.nu_B > -1.0 && m.nu_B <= 0.5 && positive(R_DE) &&
          positive(rho_D)))
        throw InvalidInput(
            fmt::format("beams: E_B, r_tilde, the mean radius and rho_D must be positive and nu_B within (-1, 0.5]; "
                        "got E_B = {:g} Pa, "
                        "nu_B = {:g}, r_tilde = {:g}, R_DE = {:g} m, rho_D = {:g} kg/m3",
                        m.E_B, m.nu_B, m.r_tilde, R_DE, rho_D));
}

void check_elements(const domain::Elements& elements)
{
    if (elements.size() == 0)
        throw InvalidInput(
            "the domain has no element: is the matter threshold right, are the pores smaller than the box?");
    for (std::int32_t e = 0; e < elements.size(); ++e) {
        const Vec3 c = elements.centre(e);
        const double r = elements.r[static_cast<std::size_t>(e)];
        if (!(std::isfinite(c.x + c.y + c.z) && r > 0.0 && std::isfinite(r)))
            throw InvalidInput(fmt::format(
                "element {}: needs a finite centre and a positive radius, got ({:g}, {:g}, {:g}) m, r = {:g} m", e, c.x,
                c.y, c.z, r));
    }
}

struct Pair {
    Vec3 t;
    double length;
};

/// Checks ends and order of pair b and gives its direction and length.
Pair measured(const domain::Elements& elements, const std::vector<std::int32_t>& i, const std::vector<std::int32_t>& j,
              std::size_t b, const char* what)
{
    const bool in_order = i[b] >= 0 && i[b] < j[b] && j[b] < elements.size() &&
                          (b == 0 || i[b - 1] < i[b] || (i[b - 1] == i[b] && j[b - 1] < j[b]));
    if (!in_order)
        throw InvalidInput(
            fmt::format("{} {} ({}, {}): pairs need 0 <= i < j < {} and to be sorted by (i, j), none twice", what, b,
                        i[b], j[b], elements.size()));
    const Vec3 d = elements.centre(j[b]) - elements.centre(i[b]);
    const double length = norm(d);
    if (!(length > 0.0))
        throw InvalidInput(fmt::format("{} {}: elements {} and {} have the same centre", what, b, i[b], j[b]));
    return {d / length, length};
}

}  // namespace

Lattice make_lattice(const domain::Domain& domain, const BeamMaterial& material, double rho_D)
{
    check_elements(domain.elements);
    check_material(material, domain.mean_radius, rho_D);
    if (domain.bonds.size() == 0)
        throw InvalidInput(
            "the domain has no bond: nothing is connected, so nothing can be loaded. Is the mean cardinality right?");

    Lattice lattice;
    lattice.box = domain.box;
    lattice.x = domain.elements.x, lattice.y = domain.elements.y, lattice.z = domain.elements.z;
    lattice.r = domain.elements.r;
    lattice.material = material;
    lattice.mean_radius = domain.mean_radius;
    lattice.section = beam_section(material, domain.mean_radius);
    lattice.contact_stiffness = contact_stiffness(material.E_B, domain.mean_radius, material.r_tilde);
    lattice.density = rho_D * domain.box.x * domain.box.y * domain.box.z / domain.dense_volume;
    if (!(lattice.density > 0.0 && std::isfinite(lattice.density)))
        throw InvalidInput(
            fmt::format("the domain needs a positive box and dense_volume, got {:g} x {:g} x {:g} m and {:g} m3",
                        domain.box.x, domain.box.y, domain.box.z, domain.dense_volume));

    const auto& bonds = domain.bonds;
    lattice.i = bonds.i, lattice.j = bonds.j, lattice.kind = bonds.kind, lattice.thickness = bonds.thickness;
    const auto m = static_cast<std::size_t>(bonds.size());
    for (auto* values : {&lattice.tx, &lattice.ty, &lattice.tz, &lattice.length, &lattice.inv_length})
        values->resize(m);
    lattice.first.assign(lattice.r.size() + 1, 0);
    for (std::size_t b = 0; b < m; ++b) {
        const auto [t, length] = measured(domain.elements, bonds.i, bonds.j, b, "bond");
        const double T = bonds.thickness[b];
        if (!(T >= 0.0 && T <= length))
            throw InvalidInput(
                fmt::format("bond {}: its crack thickness must lie in [0, L_0], got T = {:g} m, L_0 = {:g} m; is "
                            "R_DE smaller than the closing radius [Eq. 11]?",
                            b, T, length));
        lattice.tx[b] = t.x, lattice.ty[b] = t.y, lattice.tz[b] = t.z;
        lattice.length[b] = length, lattice.inv_length[b] = 1.0 / length;
        ++lattice.first[static_cast<std::size_t>(bonds.i[b]) + 1];
    }
    for (std::size_t e = 1; e < lattice.first.size(); ++e) lattice.first[e] += lattice.first[e - 1];

    for (std::size_t p = 0; p < domain.near.i.size(); ++p) {
        const auto [t, d_0] = measured(domain.elements, domain.near.i, domain.near.j, p, "near pair");
        const double T = domain.near.thickness[p];
        const double r_1 = lattice.r[static_cast<std::size_t>(domain.near.i[p])];
        const double r_2 = lattice.r[static_cast<std::size_t>(domain.near.j[p])];
        if (!(T >= 0.0 && std::isfinite(T)))
            throw InvalidInput(fmt::format("near pair {}: its crack thickness must not be negative, got {:g} m", p, T));
        FreeContacts& free = lattice.free;
        free.i.push_back(domain.near.i[p]), free.j.push_back(domain.near.j[p]);
        free.tx.push_back(t.x), free.ty.push_back(t.y), free.tz.push_back(t.z);
        free.distance.push_back(d_0);
        free.gap.push_back(d_0 - contact_distance(r_1, r_2, d_0, T));
        free.cut.push_back(T > 0.0);
    }
    return lattice;
}

State rest_state(const Lattice& lattice) { return {std::vector<double>(6 * lattice.r.size(), 0.0), lattice.kind}; }

State affine_state(const Lattice& lattice, const Vec3& strain, const Vec3& origin)
{
    State state = rest_state(lattice);
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const Vec3 from = lattice.centre(e) - origin;
        for (int c = 0; c < 3; ++c)
            state.u[6 * static_cast<std::size_t>(e) + static_cast<std::size_t>(c)] = strain[c] * from[c];
    }
    return state;
}

}  // namespace craze::mechanics
