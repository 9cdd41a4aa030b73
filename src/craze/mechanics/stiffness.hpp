// The small-displacement stiffness of a lattice with a given set of closed contacts, matrix-free.

#pragma once

#include "craze/mechanics/lattice.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Axial springs, structure of arrays, sorted by (i, j).
struct Springs {
    std::vector<std::int32_t> i, j;
    std::vector<double> tx, ty, tz;  ///< unit vector i -> j
    std::vector<double> k;           ///< N/m

    std::int32_t size() const { return static_cast<std::int32_t>(i.size()); }
    void reserve(std::size_t n);
    void add(std::int32_t from, std::int32_t to, const Vec3& t, double stiffness);
};

/// Beams only, structure of arrays, sorted by (i, j); padded for the lanes.
struct Beams {
    std::vector<std::int32_t> i, j;
    std::vector<double> tx, ty, tz, inv_length;
    std::int64_t count = 0;
    void resize(std::size_t n);  ///< and pad
};

/// f = K u for the beams of a state and a list of springs.
///
/// Each thread owns a range of elements and computes the bonds on its border itself: what an element receives is added
/// in the order of its bonds, so the bits do not depend on the number of threads.
class Stiffness {
public:
    Stiffness(const Lattice& lattice, std::span<const domain::BondKind> kind);
    /// Replaces the springs that act beside the beams.
    void set_springs(Springs springs);

    /// f = K u, of beams and springs or of beams alone; shapes (n, 6).
    void apply(std::span<const double> u, std::span<double> f, bool with_springs = true) const;

    /// Diagonal 6x6 block of each element, shape (n, 6, 6), added to `blocks`.
    void diagonal(std::span<double> blocks) const;
    /// The same of beams alone.
    /// @param group  if not empty, of each element: beams within a group are left out
    void beam_diagonal(std::span<double> blocks, std::span<const std::int32_t> group = {}) const;

    std::int64_t elements() const { return elements_; }
    const Beams& beams() const { return beams_; }
    const Springs& springs() const { return springs_; }
    const BeamSection& section() const { return section_; }

private:
    /// What one thread adds up: bonds with i in its range, and copies of those that only end there.
    struct Share {
        std::int64_t begin = 0, end = 0;  ///< elements
        std::int64_t beam_begin = 0, beam_end = 0;
        std::int64_t spring_begin = 0, spring_end = 0;
        Beams border_beams;
        Springs border_springs;
    };
    void share_out();
    void share_springs();

    std::int64_t elements_ = 0;
    BeamSection section_;
    Beams beams_;
    Springs springs_;
    std::vector<Share> shares_;
};

}  // namespace craze::mechanics
