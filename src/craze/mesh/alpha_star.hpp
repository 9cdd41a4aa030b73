// Which Delaunay triangles start at a lattice point, from the occupied lattice points around it.

#pragma once

#include "craze/core/mask.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace craze::mesh {

struct Offset {
    int x = 0, y = 0, z = 0;
};

/// The lattice points within 2 alpha of the origin, in the order z, y, x; the origin in the middle. Two points of one
/// ball of radius alpha are never further apart, so nothing beyond matters.
class Neighbourhood {
public:
    explicit Neighbourhood(double alpha);

    std::size_t size() const { return offsets_.size(); }
    std::size_t words() const { return (offsets_.size() + 63) / 64; }
    std::size_t middle() const { return offsets_.size() / 2; }
    const Offset& operator[](std::size_t i) const { return offsets_[i]; }
    /// Bit i of `occupied` (words() long): is the point at offset i from (x, y, z) in the mask? Outside is empty.
    void gather(const Mask& mask, std::int64_t x, std::int64_t y, std::int64_t z, std::span<Mask::Word> occupied) const;

private:
    struct Row {
        int dy, dz, reach;
        std::size_t first;
    };
    std::vector<Offset> offsets_;
    std::vector<Row> rows_;
};

/// Finds the triangles of the alpha shape whose first corner (in the order z, y, x) is a given point. Keeps what it
/// worked out about each triple of offsets, so that most points cost a few looks at bits. One per thread.
class AlphaStar {
public:
    AlphaStar(const Neighbourhood& around, double alpha);

    struct Triangle {
        std::size_t q, r;    ///< offsets of the other corners, as indices into the neighbourhood
        std::uint8_t sides;  ///< see LatticeSurface
    };
    /// The triangles at a point with these neighbours, in a fixed order; valid until the next call.
    std::span<const Triangle> of(std::span<const Mask::Word> occupied);

private:
    using Word = Mask::Word;
    struct Bits {
        std::uint32_t word;
        Word mask;
    };
    // What points around do to the triangle (0, q, r), as consecutive ranges of bits_: forbid it; make a ball that
    // touches it stop above it; or below it.
    struct Triple {
        std::uint32_t forbid, above, below, end;
    };

    std::int32_t triple(std::size_t q, std::size_t r);
    std::int32_t work_out(std::size_t q, std::size_t r);
    std::uint32_t append(const std::vector<std::size_t>& offsets);
    bool any(std::span<const Word> occupied, std::uint32_t begin, std::uint32_t end) const
    {
        for (std::uint32_t i = begin; i < end; ++i)
            if ((occupied[bits_[i].word] & bits_[i].mask) != 0) return true;
        return false;
    }

    const Neighbourhood& around_;
    double alpha2_;
    std::vector<std::vector<Bits>> cuts_edge_;  // per offset after the middle: points that no ball can leave out
    std::vector<std::int32_t> index_;           // of each pair of offsets after the middle; see unknown, never
    std::vector<Triple> triples_;
    std::vector<Bits> bits_;
    std::vector<std::size_t> ends_;
    std::vector<Triangle> found_;
};

}  // namespace craze::mesh
