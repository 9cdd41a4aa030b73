// An approximate inverse of the stiffness, which makes conjugate gradients converge in few iterations.

#pragma once

#include "craze/mechanics/coarse_space.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/single_stiffness.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// The sum over levels of P D^-1 P^T: elements, then groups of about 12, 72, ... elements that move rigidly, each with
/// the inverse of its own 6x6 block, and at the top a few hundred groups solved together. Units and rows are those of
/// SingleStiffness. Singular blocks (elements held by contacts alone, or by nothing) are regularised here, so that the
/// system itself need not be.
class Multilevel {
public:
    /// @param imposed  degrees of freedom that do not move, ascending
    void set_up(const Lattice& lattice, const Stiffness& stiffness, std::span<const std::int64_t> imposed);
    /// The same beams and groups, other springs: what these do not touch stays as it is.
    void update(const Lattice& lattice, const Stiffness& stiffness);

    /// z = D^-1 r of the elements of one block, and the loads of the groups of its first level. Gives r . (what both
    /// levels answer).
    double descend(std::int64_t block, const float* r, float* z);
    /// All coarser levels, once every block has descended. Gives r . (what they answer).
    double solve_coarse();
    /// d += step p, then p = z + (answers of all groups) + beta p, zero at imposed degrees of freedom, in one block.
    void ascend(std::int64_t block, const float* z, float step, float* d, float beta, float* p) const;

private:
    /// D^-1 of every node: entries, each times the scales of its row and its column.
    struct Inverses {
        std::vector<std::int16_t> entries;  ///< shape (nodes, 6, 6)
        std::vector<float> scale;           ///< shape (nodes, 8), the last two of each 0
        void resize(std::int64_t nodes);
    };
    struct Level {
        std::vector<std::int32_t> parent;         ///< of each node of the level below, -1 for none
        std::vector<float> arm;                   ///< from the parent's centre to the node, R, shape (nodes below, 4)
        std::vector<double> beams;                ///< what beams bring to D, shape (nodes, 6, 6); of the top level none
        Inverses inverse;                         ///< of the top level none
        mutable std::vector<float> load, answer;  ///< shape (nodes, 8)
        Aggregates groups;                        ///< of elements
        std::int64_t count = 0;
    };
    void find_groups(const Lattice& lattice, const Beams& beams);
    void find_first_groups();
    void make_inverses(const Lattice& lattice, const Stiffness& stiffness, const std::vector<std::uint8_t>& touched);
    void add_up_beams(Level& level, const Lattice& lattice, const Stiffness& stiffness);
    void invert(const Lattice& lattice, const Stiffness& stiffness, const std::vector<std::uint8_t>& touched,
                const Aggregates* groups, std::span<const double> beams, Inverses& inverses) const;

    std::int64_t elements_ = 0;
    std::vector<double> beams_;  ///< of elements: what beams bring to D, shape (n, 6, 6)
    Inverses own_;               ///< of elements
    Springs springs_;            ///< those that the inverses know
    std::vector<Level> levels_;
    std::vector<std::int32_t> first_group_;  ///< of the first level, per block
    std::vector<std::uint8_t> held_;         ///< bit c: number c of the element is imposed
    std::vector<std::int64_t> imposed_;
    std::vector<std::int64_t> imposed_first_;  ///< per block
    CoarseSpace coarse_;
};

}  // namespace craze::mechanics
