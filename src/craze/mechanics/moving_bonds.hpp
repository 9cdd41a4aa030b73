// The bond kernel of motion: what the bonds of a range of elements add to the forces, in either geometry.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/motion.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Bonds laid out for the kernel, structure of arrays, sorted by (i, j) and padded for the lanes.
struct MovingBonds {
    std::vector<std::int32_t> i, j;
    std::vector<double> dx, dy, dz;  ///< from centre i to centre j at rest, m
    std::vector<double> inv_length;  ///< 1 / L_0, 1/m
    std::vector<double> slack;       ///< T / L_0 of a contact beam; -1 for a beam
    std::int64_t count = 0;
};
MovingBonds moving_bonds(const Lattice& lattice, std::span<const domain::BondKind> kind);
/// Some of them, in the order of the list.
MovingBonds selected(const MovingBonds& bonds, std::span<const std::int32_t> list);

/// Which rows a pass fills, what it looks for and what it finds.
struct BondPass {
    Geometry geometry = Geometry::corotational;
    std::int64_t low = 0, limit = 0;   ///< rows are filled of elements in [low, limit)
    double strength = 0.0;             ///< Pa; infinite: nothing breaks
    bool measure = false;              ///< add up the elastic energy
    double energy = 0.0;               ///< out: J
    std::vector<std::int32_t> broken;  ///< out: beams that reached the strength
    double bending_share = 1.0;        ///< MotionOptions::bending_share
};

/// What bonds [begin, end) add to the rows of `force` (n, 8: force, moment, two unused), from rows of `pose` (n, 8);
/// both lie best on whole cache lines. One function for all bonds: two would round differently where the compiler fuses
/// products and sums.
void add_bonds(const BeamSection& section, const MovingBonds& bonds, std::int64_t begin, std::int64_t end,
               const double* pose, double* force, BondPass& pass);

/// Elastic energy of bond b as a beam and as a contact beam, J, and the power of its forces on its ends, W.
struct BondEnergy {
    double beam = 0.0, contact = 0.0, beam_power = 0.0, contact_power = 0.0;
};
/// @param velocity  of both ends, six numbers each, m/s and rad/s
BondEnergy bond_energy(const BeamSection& section, const MovingBonds& bonds, std::int64_t b, Geometry geometry,
                       const double* pose, const double* const (&velocity)[2]);

}  // namespace craze::mechanics
