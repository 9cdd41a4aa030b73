#include "craze/microstructure/distance.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"

#include <bit>
#include <cstring>
#include <vector>

namespace craze::microstructure {

namespace {

using Eight [[gnu::vector_size(32), gnu::may_alias, gnu::aligned(4)]] = std::int32_t;
using Halves [[gnu::vector_size(32)]] = std::int64_t;

constexpr std::int64_t group = 16;    // columns side by side: two vectors
constexpr std::int64_t groups = 2;    // groups fetched together: two cache lines of each row
constexpr std::int64_t margin = 104;  // rows of no_distance around a column
constexpr std::int64_t reach = 96;    // rows searched one by one before the envelope takes over

CRAZE_INLINE bool any(Eight condition)
{
    const auto h = reinterpret_cast<Halves>(condition);
    return ((h[0] | h[1]) | (h[2] | h[3])) != 0;
}

// Distances along x, squared. Gaps between members are few in what is mostly matter.
CRAZE_INLINE void fill_gap(std::int32_t* row, std::int64_t first, std::int64_t last, std::int64_t nx)
{
    const bool left = first > 0, right = last + 1 < nx;
    if (!left && !right) {
        for (std::int64_t x = first; x <= last; ++x) row[x] = no_distance;
        return;
    }
    const std::int64_t middle = !left ? first - 1 : !right ? last : (first + last) / 2;
    for (std::int64_t x = first; x <= middle; ++x)
        row[x] = static_cast<std::int32_t>((x - first + 1) * (x - first + 1));
    for (std::int64_t x = middle + 1; x <= last; ++x)
        row[x] = static_cast<std::int32_t>((last - x + 1) * (last - x + 1));
}

CRAZE_MULTIVERSION void along_x(std::span<const Mask::Word> bits, std::int32_t* row, std::int64_t nx)
{
    for (std::int64_t x = 0; x < nx; ++x) row[x] = 0;
    bool open = false;
    std::int64_t first = 0;
    for (std::size_t w = 0; w < bits.size(); ++w) {
        const Mask::Word gaps = ~bits[w];
        Mask::Word edges = gaps ^ ((gaps << 1U) | (open ? 1U : 0U));
        while (edges != 0) {
            const std::int64_t x = static_cast<std::int64_t>(w) * 64 + std::countr_zero(edges);
            edges &= edges - 1;
            if (open)
                fill_gap(row, first, x - 1, nx);
            else
                first = x;
            open = !open;
        }
    }
    // The bits behind the row count as a gap.
    if (open && first < nx) fill_gap(row, first, nx - 1, nx);
}

// Where the parabola from q comes to lie under the one from p, p < q: the last x at which p is lower or equal.
CRAZE_INLINE std::int64_t last_of(std::int64_t p, std::int64_t q, std::int64_t fp, std::int64_t fq)
{
    const std::int64_t numerator = q * q - p * p + fq - fp, denominator = 2 * (q - p);
    return numerator >= 0 ? numerator / denominator : -((-numerator + denominator - 1) / denominator);
}

// One column by the lower envelope of its parabolas (Meijster, Roerdink, Hesselink 2000), values `group` apart.
void envelope(const std::int32_t* f, std::int32_t* out, std::int64_t n, std::vector<std::int64_t>& scratch)
{
    scratch.resize(static_cast<std::size_t>(2 * n + 2));
    std::int64_t* apex = scratch.data();
    std::int64_t* from = apex + n;
    std::int64_t top = -1;
    for (std::int64_t q = 0; q < n; ++q) {
        if (f[q * group] >= no_distance) continue;
        std::int64_t begin = 0;
        while (top >= 0) {
            begin = last_of(apex[top], q, f[apex[top] * group], f[q * group]) + 1;
            if (begin > from[top]) break;
            --top;
        }
        if (top < 0) begin = 0;
        if (begin >= n) continue;
        ++top;
        apex[top] = q;
        from[top] = std::max<std::int64_t>(begin, 0);
    }
    for (std::int64_t x = n - 1; x >= 0; --x) {
        if (top < 0) {
            out[x * group] = no_distance;
            continue;
        }
        const std::int64_t p = apex[top];
        out[x * group] = static_cast<std::int32_t>((x - p) * (x - p) + f[p * group]);
        if (x == from[top]) --top;
    }
}

CRAZE_INLINE Eight least_of(Eight a, Eight b) { return a < b ? a : b; }

// Sixteen columns: out[y] = min over d of f[y + d] + d^2, near rows first. `f` has `margin` rows of no_distance on
// either side. False where a voxel looks farther than `reach`.
CRAZE_INLINE bool search(const Eight* f, Eight* out, std::int64_t n)
{
    for (std::int64_t y = 0; y < n; ++y) {
        const Eight* at = f + 2 * y;
        Eight left = at[0], right = at[1];
        Eight square = Eight{} + 1, odd = Eight{} + 3;
        for (std::int64_t d = 1; any((left > square) | (right > square));) {
            if (d > reach) return false;
            // The farther, the more steps to a test.
            for (const std::int64_t end = d + (d < 3 ? 1 : 4); d < end; ++d) {
                left = least_of(left, least_of(at[-2 * d], at[2 * d]) + square);
                right = least_of(right, least_of(at[-2 * d + 1], at[2 * d + 1]) + square);
                square += odd;
                odd += 2;
            }
        }
        out[2 * y] = left;
        out[2 * y + 1] = right;
    }
    return true;
}

// Room for `groups` vectors of columns with margins.
struct Columns {
    std::int64_t padded;
    std::vector<std::int32_t> f, out;
    std::vector<std::int64_t> scratch;

    explicit Columns(std::int64_t n)
        : padded(n + 2 * margin),
          f(static_cast<std::size_t>(groups * group * padded), no_distance),
          out(static_cast<std::size_t>(groups * group * n))
    {
    }
    std::int32_t* input(std::int64_t g) { return f.data() + (g * padded + margin) * group; }
};

// `width` neighbouring columns of n values, `stride` apart.
CRAZE_MULTIVERSION void along_columns(std::int32_t* at, std::int64_t n, std::int64_t stride, std::int64_t width,
                                      Columns& c)
{
    const std::int64_t used = (width + group - 1) / group;
    constexpr std::size_t whole = group * sizeof(std::int32_t);
    for (std::int64_t g = 0; g < used; ++g) {
        std::int32_t* f = c.input(g);
        const std::int64_t lanes = std::min(group, width - g * group);
        const std::int32_t* from = at + g * group;
        for (std::int64_t y = 0; y < n; ++y, f += group, from += stride)
            if (lanes == group)
                std::memcpy(f, from, whole);
            else  // the last value again: lanes without a column are never the farthest
                for (std::int64_t i = 0; i < group; ++i) f[i] = from[std::min(i, lanes - 1)];
    }
    for (std::int64_t g = 0; g < used; ++g) {
        const std::int32_t* f = c.input(g);
        std::int32_t* out = c.out.data() + g * group * n;
        const std::int64_t lanes = std::min(group, width - g * group);
        if (!search(reinterpret_cast<const Eight*>(f), reinterpret_cast<Eight*>(out), n))
            for (std::int64_t i = 0; i < lanes; ++i) envelope(f + i, out + i, n, c.scratch);
        std::int32_t* to = at + g * group;
        for (std::int64_t y = 0; y < n; ++y, out += group, to += stride)
            if (lanes == group)
                std::memcpy(to, out, whole);
            else
                for (std::int64_t i = 0; i < lanes; ++i) to[i] = out[i];
    }
}

}  // namespace

Volume<std::int32_t> squared_distance(const Mask& set)
{
    const Shape s = set.shape();
    if (s.nx * s.nx + s.ny * s.ny + s.nz * s.nz >= no_distance)
        throw InvalidInput("distance transform: the diagonal of the volume needs to be shorter than 32768 px");
    Volume<std::int32_t> out(s);
    if (out.empty()) return out;
    constexpr std::int64_t block = group * groups;
    const std::int64_t blocks = (s.nx + block - 1) / block;
    parallel_ranges(s.nz, [&](std::int64_t begin, std::int64_t end) {
        Columns columns(s.ny);
        for (std::int64_t z = begin; z < end; ++z) {
            for (std::int64_t y = 0; y < s.ny; ++y) along_x(set.row(y, z), out.row(y, z).data(), s.nx);
            if (s.ny == 1) continue;
            for (std::int64_t b = 0; b < blocks; ++b)
                along_columns(out.slice(z).data() + b * block, s.ny, s.nx, std::min(block, s.nx - b * block), columns);
        }
    });
    if (s.nz == 1) return out;
    parallel_ranges(s.ny, [&](std::int64_t begin, std::int64_t end) {
        Columns columns(s.nz);
        for (std::int64_t y = begin; y < end; ++y)
            for (std::int64_t b = 0; b < blocks; ++b)
                along_columns(out.data() + y * s.nx + b * block, s.nz, s.nx * s.ny, std::min(block, s.nx - b * block),
                              columns);
    });
    return out;
}

}  // namespace craze::microstructure
