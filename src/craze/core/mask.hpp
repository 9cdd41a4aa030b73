// One bit per voxel: which voxels belong to a set.

#pragma once

#include "craze/core/volume.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze {

/// A set of voxels, 64 to a word. Row (y, z) starts at a word of its own; bit x & 63 of word x >> 6 is voxel x.
/// The bits after nx in a row's last word are always zero. Move-only, like Volume.
class Mask {
public:
    using Word = std::uint64_t;

    Mask() = default;
    /// All voxels out of the set.
    explicit Mask(Shape shape)
        : shape_(shape),
          words_per_row_((shape.nx + 63) / 64),
          words_(static_cast<std::size_t>(words_per_row_ * shape.ny * shape.nz), Word{0})
    {
    }
    Mask(Mask&&) noexcept = default;
    Mask& operator=(Mask&&) noexcept = default;
    Mask copy() const { return Mask(*this); }

    const Shape& shape() const { return shape_; }
    bool empty() const { return shape_.voxels() == 0; }
    std::int64_t words_per_row() const { return words_per_row_; }

    bool operator()(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return (row(y, z)[static_cast<std::size_t>(x >> 6)] >> (x & 63)) & 1U;
    }
    /// Not safe from two threads on the same row.
    void set(std::int64_t x, std::int64_t y, std::int64_t z, bool in)
    {
        Word& word = row(y, z)[static_cast<std::size_t>(x >> 6)];
        const Word bit = Word{1} << (x & 63);
        word = in ? word | bit : word & ~bit;
    }
    std::span<Word> row(std::int64_t y, std::int64_t z) { return {words_.data() + offset(y, z), stride()}; }
    std::span<const Word> row(std::int64_t y, std::int64_t z) const { return {words_.data() + offset(y, z), stride()}; }
    std::span<Word> words() { return words_; }
    std::span<const Word> words() const { return words_; }
    /// Valid bits of the last word of each row.
    Word tail() const { return shape_.nx % 64 == 0 ? ~Word{0} : (Word{1} << (shape_.nx % 64)) - 1; }

    /// Voxels in the set.
    std::int64_t count() const;
    friend bool operator==(const Mask&, const Mask&) = default;

private:
    Mask(const Mask&) = default;
    std::size_t stride() const { return static_cast<std::size_t>(words_per_row_); }
    std::size_t offset(std::int64_t y, std::int64_t z) const
    {
        assert(y >= 0 && y < shape_.ny && z >= 0 && z < shape_.nz);
        return static_cast<std::size_t>(words_per_row_ * (y + shape_.ny * z));
    }

    Shape shape_;
    std::int64_t words_per_row_ = 0;
    std::vector<Word> words_;
};

/// Voxels out of `a`.
Mask complement(const Mask& a);
/// Voxels in both. Shapes must agree.
Mask intersection(const Mask& a, const Mask& b);
/// Voxels in `a` and not in `b`. Shapes must agree.
Mask difference(const Mask& a, const Mask& b);

}  // namespace craze
