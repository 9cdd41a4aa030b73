#include "craze/mesh/skeleton.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <vector>

namespace craze::mesh {

namespace {

using Word = Mask::Word;

// A slice with an empty row above and below and an empty word left and right, so that no neighbour is ever missing.
struct Slice {
    std::int64_t rows = 0, words = 0;
    std::vector<Word> bits;

    Slice(std::int64_t rows_, std::int64_t words_)
        : rows(rows_), words(words_), bits(static_cast<std::size_t>((rows_ + 2) * (words_ + 2)), Word{0})
    {
    }
    Word* row(std::int64_t y) { return bits.data() + (y + 1) * (words + 2) + 1; }
};

// The eight neighbours of 64 pixels, clockwise from north: N NE E SE S SW W NW.
struct Ring {
    Word p[8];
};

CRAZE_INLINE Word from_west(const Word* row, std::int64_t w) { return row[w] << 1U | row[w - 1] >> 63U; }
CRAZE_INLINE Word from_east(const Word* row, std::int64_t w) { return row[w] >> 1U | row[w + 1] << 63U; }

CRAZE_INLINE Ring ring_of(const Word* north, const Word* here, const Word* south, std::int64_t w)
{
    return {{north[w], from_east(north, w), from_east(here, w), from_east(south, w), south[w], from_west(south, w),
             from_west(here, w), from_west(north, w)}};
}

// Bits set in at least one and in at least two of the words added.
struct AtLeast {
    Word one = 0, two = 0;
    CRAZE_INLINE void add(Word bits)
    {
        two |= one & bits;
        one |= bits;
    }
};

// Removing the pixel neither cuts nor joins nor opens anything: its 8-connected neighbours form one group.
CRAZE_INLINE Word simple(const Ring& r)
{
    AtLeast groups;
    for (int k = 0; k < 8; k += 2) groups.add(~r.p[k] & (r.p[k + 1] | r.p[(k + 2) % 8]));
    return groups.one & ~groups.two;
}

// What Zhang and Suen delete in the first (second) half of an iteration.
CRAZE_INLINE Word deletable(const Ring& r, bool second)
{
    AtLeast starts, neighbours, gaps;
    for (int k = 0; k < 8; ++k) {
        starts.add(~r.p[k] & r.p[(k + 1) % 8]);
        neighbours.add(r.p[k]);
        gaps.add(~r.p[k]);
    }
    const Word north = r.p[0], east = r.p[2], south = r.p[4], west = r.p[6];
    const Word kept =
        second ? (north & east & west) | (north & south & west) : (north & east & south) | (east & south & west);
    return starts.one & ~starts.two & neighbours.two & gaps.two & ~kept;
}

// Corner pixels of staircases, whose two neighbours touch without them; `turn` is where the corner points: 0 NE, 1 SE,
// 2 SW, 3 NW. Two of them are never 4-neighbours, so all of one turn may go at once.
CRAZE_INLINE Word corner(const Ring& r, int turn)
{
    const auto p = [&](int k) { return r.p[(2 * turn + k) % 8]; };
    return p(0) & ~p(1) & p(2) & ~p(4) & ~p(5) & ~p(6);
}

// One iteration: staircases are trimmed first, for Zhang and Suen's rule eats bands two pixels wide from their ends
// when they run diagonally; then the two halves of their rule.
constexpr int phases = 6;

template <int Phase>
CRAZE_INLINE bool mark_row_in(const Word* north, const Word* here, const Word* south, Word* out, std::int64_t words)
{
    Word any = 0;
    for (std::int64_t w = 0; w < words; ++w) {
        const Ring ring = ring_of(north, here, south, w);
        if constexpr (Phase < 4)
            out[w] = here[w] & corner(ring, Phase);
        else
            out[w] = here[w] & deletable(ring, Phase == 5);
        any |= out[w];
    }
    return any != 0;
}

// Marks in `out` what may go from one row; true if there is any.
CRAZE_MULTIVERSION bool mark_row(const Word* north, const Word* here, const Word* south, Word* out, std::int64_t words,
                                 std::int64_t phase)
{
    switch (phase) {
        case 0: return mark_row_in<0>(north, here, south, out, words);
        case 1: return mark_row_in<1>(north, here, south, out, words);
        case 2: return mark_row_in<2>(north, here, south, out, words);
        case 3: return mark_row_in<3>(north, here, south, out, words);
        case 4: return mark_row_in<4>(north, here, south, out, words);
        default: return mark_row_in<5>(north, here, south, out, words);
    }
}

// Deleting at once two neighbours that are each simple can still cut, and four can take a whole square. Such marks
// are lifted from the eastern or southern one (Ronse, Discrete Appl. Math. 21, 1988, 67: no larger set need be looked
// at). `marks_north` are those of the row above as first made.
void lift_unsafe_marks(const Word* north, const Word* here, const Word* south, const Word* marks_north,
                       const Word* marks, Word* out, std::int64_t words)
{
    for (std::int64_t w = 0; w < words; ++w) {
        Word safe = marks[w];
        if (safe != 0) {
            const Word west = from_west(marks, w);
            const Word pair_west = safe & west, pair_north = safe & marks_north[w];
            if ((pair_west | pair_north) != 0) {
                const Ring ring = ring_of(north, here, south, w);
                Ring without = ring;
                without.p[6] = 0;
                safe &= ~(pair_west & ~simple(without));
                without = ring;
                without.p[0] = 0;
                safe &= ~(pair_north & ~simple(without));
                safe &= ~(pair_west & pair_north & from_west(marks_north, w));
            }
        }
        out[w] = safe;
    }
}

void thin(Slice& slice)
{
    Slice marks(slice.rows, slice.words), safe(slice.rows, slice.words);
    constexpr std::int64_t never = std::numeric_limits<std::int64_t>::min() / 2;
    // When each row last changed, counted in phases; two more entries for the empty rows outside.
    std::vector<std::int64_t> changed(static_cast<std::size_t>(slice.rows + 2), never);
    std::vector<std::int64_t> marked;
    for (std::int64_t y = 0; y < slice.rows; ++y)
        if (std::any_of(slice.row(y), slice.row(y) + slice.words, [](Word w) { return w != 0; }))
            changed[static_cast<std::size_t>(y + 1)] = -1;
    for (std::int64_t step = 0, last = 0; step <= last + phases; ++step) {
        // A row whose surroundings are what they were when this phase was last tried has nothing to give.
        marked.clear();
        for (std::int64_t y = 0; y < slice.rows; ++y) {
            const auto c = changed.begin() + y;
            if (std::max({c[0], c[1], c[2]}) < step - phases) continue;
            if (mark_row(slice.row(y - 1), slice.row(y), slice.row(y + 1), marks.row(y), slice.words, step % phases))
                marked.push_back(y);
        }
        for (const std::int64_t y : marked)
            lift_unsafe_marks(slice.row(y - 1), slice.row(y), slice.row(y + 1), marks.row(y - 1), marks.row(y),
                              safe.row(y), slice.words);
        for (const std::int64_t y : marked) {
            Word any = 0;
            for (std::int64_t w = 0; w < slice.words; ++w) {
                slice.row(y)[w] &= ~safe.row(y)[w];
                any |= safe.row(y)[w];
                marks.row(y)[w] = 0;
            }
            if (any != 0) changed[static_cast<std::size_t>(y + 1)] = last = step;
        }
    }
}

// The mask with x and y exchanged.
Mask transposed(const Mask& from)
{
    const Shape s = from.shape();
    Mask to(Shape{s.ny, s.nx, s.nz});
    parallel_tasks(s.nz, [&](std::int64_t z) {
        for (std::int64_t y = 0; y < s.ny; ++y) {
            const auto row = from.row(y, z);
            for (std::size_t w = 0; w < row.size(); ++w)
                for (Word rest = row[w]; rest != 0; rest &= rest - 1)
                    to.set(y, static_cast<std::int64_t>(w) * 64 + std::countr_zero(rest), z, true);
        }
    });
    return to;
}

}  // namespace

Mask skeleton_of_slices(const Mask& set, int axis)
{
    assert(axis >= 0 && axis < 3);
    if (axis == 0) return transposed(skeleton_of_slices(transposed(set), 1));
    const Shape s = set.shape();
    Mask out(s);
    const std::int64_t slices = s[axis], rows = axis == 2 ? s.ny : s.nz;
    Progress progress("skeleton of the slices", slices);
    parallel_tasks(slices, [&](std::int64_t k) {
        const auto y_of = [&](std::int64_t row) { return axis == 2 ? row : k; };
        const auto z_of = [&](std::int64_t row) { return axis == 2 ? k : row; };
        Slice slice(rows, set.words_per_row());
        for (std::int64_t r = 0; r < rows; ++r) std::ranges::copy(set.row(y_of(r), z_of(r)), slice.row(r));
        thin(slice);
        for (std::int64_t r = 0; r < rows; ++r)
            std::copy_n(slice.row(r), slice.words, out.row(y_of(r), z_of(r)).data());
        progress.advance();
    });
    return out;
}

}  // namespace craze::mesh
