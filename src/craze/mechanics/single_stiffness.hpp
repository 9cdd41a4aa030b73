// The stiffness in single precision, for the inner iterations of equilibria: half the memory, twice the lanes.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <vector>

namespace craze::mechanics {

/// Elements are handled in blocks of this many rows, whatever the number of threads; arrays are padded to whole blocks.
inline constexpr std::int64_t block_rows = 256;

/// Beams or springs, structure of arrays, sorted by (i, j); padded for the lanes.
struct SingleBonds {
    std::vector<std::int32_t> i, j;
    std::vector<float> tx, ty, tz, k;  ///< k: 1 / L_0 of a beam, stiffness of a spring
    std::int64_t count = 0;
    void resize(std::size_t n);
    void pick(const SingleBonds& from, const std::vector<std::size_t>& list);
};
struct SingleSection {
    float EA = 1.0F, EI = 0.0F, GJ = 0.0F;
};

/// q = K p in units that make all numbers of order one: lengths in mean radii R, forces in EA, moments in EA R. Rows of
/// eight: displacement or force, rotation or moment, two zeros.
class SingleStiffness {
public:
    void set_beams(const Stiffness& stiffness, double mean_radius);
    void set_springs(const Springs& springs);

    /// One thread's part of q += K p: to the rows of blocks [begin_block(part), begin_block(part + 1)) add first what
    /// beams from before bring, then block by block, ascending, what begins there; the rows of a block are then final.
    void add_border(std::int64_t part, const float* p, float* q) const;
    void add_block(std::int64_t block, const float* p, float* q) const;
    std::int64_t parts() const { return static_cast<std::int64_t>(shares_.size()); }
    std::int64_t begin_block(std::int64_t part) const
    {
        return part < parts() ? shares_[static_cast<std::size_t>(part)].begin : blocks();
    }
    std::int64_t blocks() const { return (elements_ + block_rows - 1) / block_rows; }

private:
    struct Share {
        std::int64_t begin = 0, end = 0;  ///< blocks
        SingleBonds border_beams;
    };

    std::int64_t elements_ = 0;
    double unit_ = 1.0, EA_ = 1.0;
    SingleSection section_;
    SingleBonds beams_, springs_;
    std::vector<Share> shares_;
    std::vector<std::int32_t> share_of_;                   ///< per block
    std::vector<std::int64_t> first_beam_, first_spring_;  ///< per block
};

}  // namespace craze::mechanics
