#include "craze/mesh/medial_surface.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/mesh/neighbours.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace craze::mesh {

namespace {

using Word = Mask::Word;
using Row = std::span<const Word>;

constexpr Word even_bits = 0x5555555555555555U;
constexpr int sides = 6;

// Voxels x - 1, x, x + 1 of a row.
Cube three(Row row, std::int64_t x)
{
    if (row.empty()) return 0;
    const auto w = static_cast<std::size_t>(x >> 6);
    const auto b = static_cast<unsigned>(x & 63);
    if (b == 0) return static_cast<Cube>((row[w] << 1U | (w > 0 ? row[w - 1] >> 63U : 0)) & 7U);
    if (b == 63) return static_cast<Cube>(row[w] >> 62U | (w + 1 < row.size() ? (row[w + 1] & 1U) << 2U : 0));
    return static_cast<Cube>(row[w] >> (b - 1) & 7U);
}

class Thinning {
public:
    explicit Thinning(Mask set)
        : set_(std::move(set)),
          kept_(set_.shape()),
          tried_(set_.shape()),
          changed_(static_cast<std::size_t>(set_.shape().ny * set_.shape().nz), 0)
    {
    }

    Mask run()
    {
        Progress progress("medial surface", static_cast<std::int64_t>(sides) * 8);
        for (std::int64_t pass = 1, last = 0; pass <= last + sides; ++pass) {
            check_interrupt();
            find_border(static_cast<std::size_t>((pass - 1) % sides), pass);
            for (int field = 0; field < 8; ++field)
                if (peel(field, pass)) last = pass;
            progress.advance();
        }
        return std::move(set_);
    }

private:
    // Waking threads nine times a pass costs more than a small volume does.
    template <class Body>
    void each(std::int64_t tasks, Body&& body) const
    {
        if (set_.shape().voxels() >= 1'000'000) {
            parallel_tasks(tasks, body);
            return;
        }
        for (std::int64_t task = 0; task < tasks; ++task) body(task);
    }

    Row row(std::int64_t y, std::int64_t z) const
    {
        const Shape& s = set_.shape();
        if (y < 0 || y >= s.ny || z < 0 || z >= s.nz) return {};
        return std::as_const(set_).row(y, z);
    }
    std::array<Row, 9> rows_around(std::int64_t y, std::int64_t z) const
    {
        std::array<Row, 9> rows;
        for (int k = 0; k < 9; ++k) rows[static_cast<std::size_t>(k)] = row(y + k % 3 - 1, z + k / 3 - 1);
        return rows;
    }
    static Cube neighbours(const std::array<Row, 9>& rows, std::int64_t x)
    {
        Cube cube = 0;
        for (unsigned k = 0; k < 9; ++k) cube |= three(rows[k], x) << (3 * k);
        return cube;
    }
    std::int64_t& changed(std::int64_t y, std::int64_t z)
    {
        return changed_[static_cast<std::size_t>(y + set_.shape().ny * z)];
    }

    // Has anything near the row changed since this side was last tried?
    bool stale(std::int64_t y, std::int64_t z, std::int64_t pass)
    {
        const Shape& s = set_.shape();
        for (std::int64_t dz = -1; dz <= 1; ++dz)
            for (std::int64_t dy = -1; dy <= 1; ++dy) {
                const std::int64_t yy = y + dy, zz = z + dz;
                if (yy >= 0 && yy < s.ny && zz >= 0 && zz < s.nz && changed(yy, zz) >= pass - sides) return false;
            }
        return true;
    }

    // What lies next to 64 voxels of the row in the middle: z-, z+, y-, y+, x-, x+.
    static std::array<Word, sides> beside(const std::array<Row, 9>& rows, std::size_t w)
    {
        const Row here = rows[4];
        const auto word = [&](Row row) { return row.empty() ? Word{0} : row[w]; };
        return {word(rows[1]),
                word(rows[7]),
                word(rows[3]),
                word(rows[5]),
                here[w] << 1U | (w > 0 ? here[w - 1] >> 63U : 0),
                here[w] >> 1U | (w + 1 < here.size() ? here[w + 1] << 63U : 0)};
    }

    // Keeps the voxels that are in a sheet by now, and marks the others with nothing on the given side.
    void find_border(std::size_t side, std::int64_t pass)
    {
        const Shape& s = set_.shape();
        each(s.nz, [&](std::int64_t z) {
            for (std::int64_t y = 0; y < s.ny; ++y) {
                const auto tried = tried_.row(y, z), kept = kept_.row(y, z);
                std::ranges::fill(tried, Word{0});
                if (stale(y, z, pass)) continue;
                const auto rows = rows_around(y, z);
                for (std::size_t w = 0; w < tried.size(); ++w) {
                    const Word open = rows[4][w] & ~kept[w];
                    if (open == 0) continue;
                    const auto next = beside(rows, w);
                    Word one = 0, two = 0;  // a voxel of a sheet has at least two free sides
                    for (const Word n : next) two |= one & ~n, one |= ~n;
                    for (Word rest = open & two; rest != 0; rest &= rest - 1) {
                        const auto x = static_cast<std::int64_t>(w) * 64 + std::countr_zero(rest);
                        if (cube::parts_the_rest(neighbours(rows, x))) kept[w] |= lowest_bit(rest);
                    }
                    tried[w] = open & ~kept[w] & ~next[side];
                }
            }
        });
    }

    static Word lowest_bit(Word bits) { return bits & (~bits + 1); }

    // Deletes what may go among the marked voxels of one parity; true if any went.
    bool peel(int field, std::int64_t pass)
    {
        const Shape& s = set_.shape();
        const std::int64_t z0 = field >> 2, y0 = field >> 1 & 1;
        const Word parity = (field & 1) != 0 ? ~even_bits : even_bits;
        std::vector<char> any(static_cast<std::size_t>(s.nz), 0);
        each((s.nz - z0 + 1) / 2, [&](std::int64_t task) {
            const std::int64_t z = z0 + 2 * task;
            for (std::int64_t y = y0; y < s.ny; y += 2) {
                const auto tried = tried_.row(y, z);
                std::array<Row, 9> rows;
                bool known = false;
                for (std::size_t w = 0; w < tried.size(); ++w) {
                    const Word now = tried[w] & parity;
                    if (now == 0) continue;
                    if (!known) rows = rows_around(y, z), known = true;
                    Word gone = 0;  // no two of them are neighbours: none sees another go
                    for (Word rest = now; rest != 0; rest &= rest - 1) {
                        const auto x = static_cast<std::int64_t>(w) * 64 + std::countr_zero(rest);
                        if (cube::simple(neighbours(rows, x))) gone |= lowest_bit(rest);
                    }
                    if (gone == 0) continue;
                    set_.row(y, z)[w] &= ~gone;
                    changed(y, z) = pass;
                    any[static_cast<std::size_t>(z)] = 1;
                }
            }
        });
        return std::ranges::any_of(any, [](char c) { return c != 0; });
    }

    Mask set_, kept_, tried_;
    std::vector<std::int64_t> changed_;  // pass in which each row last changed
};

}  // namespace

Mask medial_surface(const Mask& set) { return Thinning(set.copy()).run(); }

}  // namespace craze::mesh
