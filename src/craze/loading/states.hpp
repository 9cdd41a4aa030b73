// A loaded specimen as ParaView sees it: elements as points, bonds as lines, with what they bear.

#pragma once

#include "craze/loading/rig.hpp"

#include <filesystem>

namespace craze::loading {

/// What bonds bear and elements feel in one state, rotations of any size.
struct BornLoads {
    enum Contact : std::uint8_t { beam = 0, open = 1, closed = 2 };

    std::vector<float> N;               ///< normal force of each bond, N, positive in tension
    std::vector<float> bending;         ///< larger end moment, N m
    std::vector<float> torque;          ///< N m
    std::vector<float> rankine;         ///< Pa [Eq. 24]; 0 for contact beams
    std::vector<std::uint8_t> contact;  ///< of each bond: beam, contact beam open or closed
    std::vector<std::uint8_t> broken;   ///< 1: a beam at rest, a contact beam now
    std::vector<float> stress;  ///< of each element, Pa, shape (n, 6): xx yy zz xy yz xz; mean over its cell, from the
                                ///< forces of its bonds (Love and Weber)
    std::vector<float> damage;  ///< of each element: share of its beams at rest that have broken
};
/// @param fill  volume of spheres over that of their cells in the dense packing
BornLoads born_loads(const mechanics::Lattice& lattice, const mechanics::State& state, double fill,
                     double bending_share = 1.0);

/// Points: radius, displacement, rotation, velocity (in motion), stress, damage. Lines: thickness, contact, broken,
/// normal_force, bending_moment, torque, rankine_stress, breaking_strain (of the program, 0 where nothing has broken).
/// Points are centres at rest: warp by displacement.
void write_state(const std::filesystem::path& file, const Rig& rig, const Moment& moment);

}  // namespace craze::loading
