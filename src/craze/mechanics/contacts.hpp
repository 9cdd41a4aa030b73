// Everything that can push and never pull: contact beams and free contacts together.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Structure of arrays, sorted by (i, j). Shape (n,).
struct UnilateralContacts {
    std::vector<std::int32_t> i, j;
    std::vector<double> tx, ty, tz;     ///< unit vector i -> j at rest
    std::vector<double> k;              ///< K_B or K_C, N/m
    std::vector<double> gap_0;          ///< what is left to close at rest, m
    std::vector<std::uint8_t> is_bond;  ///< contact beam rather than free contact

    std::int64_t size() const { return std::ssize(i); }
};
/// Contact beams, and if `free_contacts` the near pairs that have parted (Holding).
UnilateralContacts unilateral_contacts(const Lattice& lattice, std::span<const domain::BondKind> kind,
                                       bool free_contacts);

/// Gap of each contact under displacements u, m: gap_0 + t . (u_j - u_i).
void gaps(const UnilateralContacts& contacts, std::span<const double> u, std::span<double> gap);
/// t . (u_j - u_i) of each contact.
void openings(const UnilateralContacts& contacts, std::span<const double> u, std::span<double> opening);
/// The contacts whose gap is negative, as springs.
Springs closed_springs(const UnilateralContacts& contacts, std::span<const double> gap);
/// Adds the forces of the closed contacts on the elements, shape (n, 6).
void add_contact_forces(const UnilateralContacts& contacts, std::span<const double> gap, std::span<double> force);

}  // namespace craze::mechanics
