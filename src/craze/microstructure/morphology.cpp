#include "craze/microstructure/morphology.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace craze::microstructure {

namespace {

using Word = Mask::Word;

// Four words at once, at any address a word may have.
using Lanes [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = Word;
constexpr std::int64_t lanes = 4;

std::int64_t floor_root(std::int64_t n)
{
    auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(n)));
    while (root * root > n) --root;
    while ((root + 1) * (root + 1) <= n) ++root;
    return root;
}

// The ball along z, then y, then x. With k(j, w) = floor(sqrt(squared - j^2 - w^2)), a dilated row is
//     union over |w| <= R of  shift along x by w of  D_w,   D_w = union over j of column(y + j, k(j, |w|)),
// where column(y, k) is row y with its neighbours along z up to +-k. Only the last step moves bits inside words.
struct Plan {
    std::int64_t R;                                // reach
    std::int64_t width;                            // words of a padded row
    std::vector<std::vector<std::int64_t>> terms;  // for each w: where, from columns(y, 0), the rows of D_w lie

    Plan(Ball ball, std::int64_t words_per_row)
        : R(floor_root(ball.squared)), width((words_per_row + lanes - 1) / lanes * lanes)
    {
        for (std::int64_t w = 0; w <= R; ++w) {
            auto& list = terms.emplace_back();
            for (std::int64_t j = -R; j <= R; ++j) {
                const std::int64_t left = ball.squared - j * j - w * w;
                if (left >= 0) list.push_back((j * (R + 1) + floor_root(left)) * width);
            }
        }
    }
};

CRAZE_INLINE void merge(Word* __restrict to, const Word* __restrict a, const Word* __restrict b, std::int64_t n)
{
    for (std::int64_t i = 0; i < n; ++i) to[i] |= a[i] | b[i];
}

// column(y, k) of slice z for k = 0 ... R, `width` words each.
CRAZE_INLINE void grow_along_z(const Word* source, std::int64_t words, std::int64_t slice, std::int64_t nz,
                               std::int64_t z, const Plan& plan, Word* column)
{
    std::copy_n(source, words, column);
    for (std::int64_t k = 1; k <= plan.R; ++k) {
        const Word* nearer = column;
        column += plan.width;
        std::copy_n(nearer, words, column);
        const Word* below = z - k >= 0 ? source - k * slice : nullptr;
        const Word* above = z + k < nz ? source + k * slice : nullptr;
        if (below == nullptr) below = above;
        if (above == nullptr) above = below;
        if (below != nullptr) merge(column, below, above, words);
    }
}

CRAZE_INLINE void join(const Word* columns, const Plan& plan, Word* D)
{
    for (const auto& list : plan.terms) {
        for (std::int64_t i = 0; i < plan.width; i += lanes) {
            Lanes sum{};
            for (const std::int64_t at : list) sum |= *reinterpret_cast<const Lanes*>(columns + at + i);
            *reinterpret_cast<Lanes*>(D + i) = sum;
        }
        D += plan.width;
    }
}

// Shifts by w add up as in Horner's rule: ((D_R << 1 | D_R-1) << 1 | ...) | D_0. Buffers have a word of zero on
// either side.
CRAZE_INLINE void spread_along_x(const Word* D, const Plan& plan, Word* up, Word* down, Word* spare, Word* to,
                                 std::int64_t words, Word tail)
{
    const std::int64_t n = plan.width;
    const Word* outer = D + plan.R * n;
    std::copy_n(outer, n, up);
    std::copy_n(outer, n, down);
    for (std::int64_t w = plan.R - 1; w >= 0; --w) {
        const Word* __restrict add = D + w * n;
        const Word* __restrict a = up;
        Word* __restrict b = spare;
        for (std::int64_t i = 0; i < n; ++i) b[i] = add[i] | (a[i] << 1U) | (a[i - 1] >> 63U);
        std::swap(up, spare);
        const Word* __restrict c = down;
        Word* __restrict d = spare;
        for (std::int64_t i = 0; i < n; ++i) d[i] = add[i] | (c[i] >> 1U) | (c[i + 1] << 63U);
        std::swap(down, spare);
    }
    for (std::int64_t i = 0; i < words; ++i) to[i] = up[i] | down[i];
    to[words - 1] &= tail;
}

// Rows [y0, y1) of slice z.
CRAZE_MULTIVERSION void dilate_tile(const Mask& from, Mask& to, const Plan& plan, std::int64_t z, std::int64_t y0,
                                    std::int64_t y1, Word* scratch)
{
    const Shape& s = from.shape();
    const std::int64_t words = from.words_per_row(), R = plan.R, block = (R + 1) * plan.width;
    Word* D = scratch;
    Word* up = D + block + lanes;
    Word* down = up + plan.width + 2 * lanes;
    Word* spare = down + plan.width + 2 * lanes;
    Word* columns = spare + plan.width + lanes;
    for (std::int64_t y = y0 - R; y < y1 + R; ++y) {
        Word* column = columns + (y - y0 + R) * block;
        if (y < 0 || y >= s.ny)
            std::fill_n(column, block, Word{0});
        else
            grow_along_z(from.row(y, z).data(), words, words * s.ny, s.nz, z, plan, column);
    }
    for (std::int64_t y = y0; y < y1; ++y) {
        join(columns + (y - y0 + R) * block, plan, D);
        spread_along_x(D, plan, up, down, spare, to.row(y, z).data(), words, from.tail());
    }
}

}  // namespace

Ball::Ball(double radius)
{
    if (!(radius >= 0.0 && radius <= 500.0))
        throw InvalidInput(fmt::format("ball: needs a radius of 0 to 500 px, got {}", radius));
    squared = static_cast<std::int64_t>(std::floor(radius * radius));
}

Mask dilated(const Mask& a, Ball ball)
{
    const Shape& s = a.shape();
    Mask out(s);
    if (a.empty()) return out;
    const Plan plan(ball, a.words_per_row());
    const std::int64_t tile = std::max<std::int64_t>(32, 2 * plan.R);
    const std::int64_t tiles = (s.ny + tile - 1) / tile;
    const std::int64_t block = (plan.R + 1) * plan.width;
    const auto scratch_words =
        static_cast<std::size_t>((tile + 2 * plan.R + 1) * block + 3 * (plan.width + 2 * lanes) + 2 * lanes);
    parallel_ranges(tiles * s.nz, [&](std::int64_t begin, std::int64_t end) {
        std::vector<Word> scratch(scratch_words, Word{0});
        for (std::int64_t t = begin; t < end; ++t) {
            const std::int64_t y0 = (t % tiles) * tile;
            dilate_tile(a, out, plan, t / tiles, y0, std::min(s.ny, y0 + tile), scratch.data());
        }
    });
    return out;
}

Mask eroded(const Mask& a, Ball ball) { return complement(dilated(complement(a), ball)); }

Mask closed(const Mask& a, Ball ball) { return eroded(dilated(a, ball), ball); }

}  // namespace craze::microstructure
