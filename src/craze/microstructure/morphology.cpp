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

// The same word of four neighbouring rows. Rows lie side by side in vectors: shifts along x then carry from one vector
// into the next, not across lanes.
using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = Word;
constexpr std::int64_t four = 4;
constexpr std::int64_t tile = 32;  // rows worked on together

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
// D_w holds D_(w+1), so that only the columns that have grown are added.
struct Plan {
    struct Term {
        std::int64_t j, k;
    };
    std::int64_t R;                        // reach
    std::vector<std::vector<Term>> terms;  // for each w: what D_w has that D_(w+1) has not

    explicit Plan(Ball ball) : R(floor_root(ball.squared)), terms(static_cast<std::size_t>(R) + 1)
    {
        for (std::int64_t w = 0; w <= R; ++w)
            for (std::int64_t j = -R; j <= R; ++j) {
                const std::int64_t left = ball.squared - j * j - w * w, next = left - 2 * w - 1;
                if (left < 0) continue;
                const std::int64_t k = floor_root(left);
                if (next < 0 || floor_root(next) != k) terms[static_cast<std::size_t>(w)].push_back({j, k});
            }
    }
};

// A mask with y fastest: word i of row (y, z) at y + ny (i + words z).
struct Upright {
    std::int64_t ny, words, nz;
    std::vector<Word> data;

    explicit Upright(const Mask& mask)
        : ny(mask.shape().ny),
          words(mask.words_per_row()),
          nz(mask.shape().nz),
          data(static_cast<std::size_t>(ny * words * nz))
    {
    }
    Word* at(std::int64_t i, std::int64_t z) { return data.data() + ny * (i + words * z); }
    const Word* at(std::int64_t i, std::int64_t z) const { return data.data() + ny * (i + words * z); }
};

Upright upright(const Mask& mask)
{
    Upright out(mask);
    parallel_ranges(out.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t z = begin; z < end; ++z)
            for (std::int64_t y = 0; y < out.ny; ++y) {
                const auto row = mask.row(y, z);
                for (std::int64_t i = 0; i < out.words; ++i) out.at(i, z)[y] = row[static_cast<std::size_t>(i)];
            }
    });
    return out;
}

void lay_down(const Upright& from, Mask& mask)
{
    const auto last = static_cast<std::size_t>(from.words - 1);
    parallel_ranges(from.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t z = begin; z < end; ++z)
            for (std::int64_t y = 0; y < from.ny; ++y) {
                const auto row = mask.row(y, z);
                for (std::int64_t i = 0; i < from.words; ++i) row[static_cast<std::size_t>(i)] = from.at(i, z)[y];
                row[last] &= mask.tail();
            }
    });
}

// Room for one tile.
struct Desk {
    std::int64_t pitch;          // rows of a column array: the tile and R on either side, a multiple of four
    std::vector<Word> columns;   // [k][row]
    std::vector<Word> D;         // [group of four rows][w][word][4]
    std::vector<Word> up, down;  // [word][4]

    Desk(const Plan& plan, std::int64_t words)
        : pitch((tile + 2 * plan.R + 2 * four - 1) / four * four),
          columns(static_cast<std::size_t>((plan.R + 1) * pitch)),
          D(static_cast<std::size_t>((tile / four) * (plan.R + 1) * words * four)),
          up(static_cast<std::size_t>(words * four)),
          down(up.size())
    {
    }
};

// column(y, k) of word i for y in [y0 - R, y1 + R). False where all are empty.
CRAZE_INLINE bool grow_along_z(const Upright& from, const Plan& plan, std::int64_t i, std::int64_t z, std::int64_t y0,
                               std::int64_t y1, Desk& desk)
{
    const std::int64_t first = std::max<std::int64_t>(0, y0 - plan.R), last = std::min(from.ny, y1 + plan.R);
    const std::int64_t n = last - first;
    Word* column = desk.columns.data();
    std::fill_n(column, (plan.R + 1) * desk.pitch, Word{0});
    column += first - (y0 - plan.R);
    std::copy_n(from.at(i, z) + first, n, column);
    for (std::int64_t k = 1; k <= plan.R; ++k) {
        const Word* __restrict nearer = column;
        column += desk.pitch;
        const Word* __restrict below = from.at(i, std::max<std::int64_t>(z - k, 0)) + first;
        const Word* __restrict above = from.at(i, std::min(z + k, from.nz - 1)) + first;
        Word* __restrict to = column;
        // Beyond the volume the end slice is nearer than k: it is in the column already.
        for (std::int64_t y = 0; y < n; ++y) to[y] = nearer[y] | below[y] | above[y];
    }
    Word any = 0;
    for (std::int64_t y = 0; y < n; ++y) any |= column[y];
    return any != 0;
}

CRAZE_INLINE void join_along_y(const Plan& plan, std::int64_t i, std::int64_t words, std::int64_t rows, Desk& desk)
{
    for (std::int64_t g = 0; g * four < rows; ++g) {
        const Word* columns = desk.columns.data() + plan.R + g * four;
        Word* D = desk.D.data() + (g * (plan.R + 1) * words + i) * four;
        Four sum{};
        for (std::int64_t w = plan.R; w >= 0; --w) {
            for (const Plan::Term& term : plan.terms[static_cast<std::size_t>(w)])
                sum |= *reinterpret_cast<const Four*>(columns + term.k * desk.pitch + term.j);
            *reinterpret_cast<Four*>(D + w * words * four) = sum;
        }
    }
}

// Shifts by w add up as in Horner's rule: ((D_R << 1 | D_(R-1)) << 1 | ...) | D_0.
CRAZE_INLINE void spread_along_x(const Plan& plan, std::int64_t g, std::int64_t words, Desk& desk)
{
    const Four* D = reinterpret_cast<const Four*>(desk.D.data()) + g * (plan.R + 1) * words;
    Four* up = reinterpret_cast<Four*>(desk.up.data());
    Four* down = reinterpret_cast<Four*>(desk.down.data());
    for (std::int64_t i = 0; i < words; ++i) up[i] = down[i] = D[plan.R * words + i];
    for (std::int64_t w = plan.R - 1; w >= 0; --w) {
        const Four* add = D + w * words;
        Four before{};
        for (std::int64_t i = 0; i < words; ++i) {
            const Four here = up[i];
            up[i] = add[i] | (here << 1) | (before >> 63);
            before = here;
        }
        before = Four{};
        for (std::int64_t i = words - 1; i >= 0; --i) {
            const Four here = down[i];
            down[i] = add[i] | (here >> 1) | (before << 63);
            before = here;
        }
    }
    for (std::int64_t i = 0; i < words; ++i) up[i] |= down[i];
}

// Rows [y0, y1) of slice z.
CRAZE_MULTIVERSION void dilate_tile(const Upright& from, Upright& to, const Plan& plan, std::int64_t z, std::int64_t y0,
                                    std::int64_t y1, Desk& desk)
{
    const std::int64_t words = from.words, rows = y1 - y0;
    bool any = false;
    for (std::int64_t i = 0; i < words; ++i) {
        if (grow_along_z(from, plan, i, z, y0, y1, desk)) {
            any = true;
            join_along_y(plan, i, words, rows, desk);
        } else {
            for (std::int64_t g = 0; g * four < rows; ++g)
                for (std::int64_t w = 0; w <= plan.R; ++w)
                    std::fill_n(desk.D.data() + ((g * (plan.R + 1) + w) * words + i) * four, four, Word{0});
        }
    }
    for (std::int64_t g = 0; g * four < rows; ++g) {
        const std::int64_t n = std::min(four, rows - g * four);
        if (any) spread_along_x(plan, g, words, desk);
        for (std::int64_t i = 0; i < words; ++i) {
            Word* out = to.at(i, z) + y0 + g * four;
            if (any)
                std::copy_n(desk.up.data() + i * four, n, out);
            else
                std::fill_n(out, n, Word{0});
        }
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
    const Plan plan(ball);
    const Upright from = upright(a);
    Upright to(a);
    const std::int64_t tiles = (s.ny + tile - 1) / tile;
    parallel_ranges(tiles * s.nz, [&](std::int64_t begin, std::int64_t end) {
        Desk desk(plan, from.words);
        for (std::int64_t t = begin; t < end; ++t) {
            const std::int64_t y0 = (t % tiles) * tile;
            dilate_tile(from, to, plan, t / tiles, y0, std::min(s.ny, y0 + tile), desk);
        }
    });
    lay_down(to, out);
    return out;
}

Mask eroded(const Mask& a, Ball ball) { return complement(dilated(complement(a), ball)); }

Mask closed(const Mask& a, Ball ball) { return eroded(dilated(a, ball), ball); }

}  // namespace craze::microstructure
