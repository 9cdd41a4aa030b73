// Several bonds at a time: packs of doubles in vector registers, and their way from and to rows of memory.

#pragma once

#include "craze/core/multiversion.hpp"

#include <cmath>
#include <cstring>

namespace craze::mechanics {

/// Four doubles, computed lane by lane.
using Lanes = double __attribute__((vector_size(32)));
using Pair = double __attribute__((vector_size(16)));
inline constexpr int lanes = 4;
/// Bonds ahead of the one at hand whose far ends are asked for: their rows lie anywhere, no hardware foresees them.
inline constexpr int ahead = 32;
/// What arrays of bonds are padded with, so that packs and foresight may read past the end.
inline constexpr int bond_padding = ahead + lanes;

/// Asks for a row of at most eight doubles, to read or to write.
template <bool write>
CRAZE_INLINE void prefetch_row(const double* p, int length)
{
    __builtin_prefetch(p, write);
    __builtin_prefetch(p + length - 1, write);
}

CRAZE_INLINE Lanes load(const double* p)
{
    Lanes v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
CRAZE_INLINE Pair load_pair(const double* p)
{
    Pair v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
CRAZE_INLINE void store(double* p, Lanes v) { std::memcpy(p, &v, sizeof v); }
CRAZE_INLINE void store(double* p, Pair v) { std::memcpy(p, &v, sizeof v); }
CRAZE_INLINE Lanes spread(double a) { return Lanes{a, a, a, a}; }
CRAZE_INLINE double root(double v) { return std::sqrt(v); }
CRAZE_INLINE Lanes root(Lanes v) { return Lanes{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])}; }

/// Rows become columns.
CRAZE_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d)
{
    const Lanes ab_0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const Lanes cd_0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    a = __builtin_shufflevector(ab_0, cd_0, 0, 1, 4, 5);
    b = __builtin_shufflevector(ab_1, cd_1, 0, 1, 4, 5);
    c = __builtin_shufflevector(ab_0, cd_0, 2, 3, 6, 7);
    d = __builtin_shufflevector(ab_1, cd_1, 2, 3, 6, 7);
}

/// Six numbers of four elements, lane by lane.
struct Six {
    Lanes a, b, c, d, e, f;
};
/// Reads rows of six: p_k points at the row of lane k.
CRAZE_INLINE Six gather_six(const double* p_0, const double* p_1, const double* p_2, const double* p_3)
{
    Six s{load(p_0), load(p_1), load(p_2), load(p_3), {}, {}};
    transpose(s.a, s.b, s.c, s.d);
    const Pair r_0 = load_pair(p_0 + 4), r_1 = load_pair(p_1 + 4), r_2 = load_pair(p_2 + 4), r_3 = load_pair(p_3 + 4);
    const Lanes low = __builtin_shufflevector(r_0, r_2, 0, 1, 2, 3),
                high = __builtin_shufflevector(r_1, r_3, 0, 1, 2, 3);
    s.e = __builtin_shufflevector(low, high, 0, 4, 2, 6);
    s.f = __builtin_shufflevector(low, high, 1, 5, 3, 7);
    return s;
}

/// Rows of eight: three numbers, one unused, four numbers.
struct Seven {
    Lanes a, b, c, e, f, g, h;
};
CRAZE_INLINE Seven gather_seven(const double* p_0, const double* p_1, const double* p_2, const double* p_3)
{
    Lanes a = load(p_0), b = load(p_1), c = load(p_2), d = load(p_3);
    Lanes e = load(p_0 + 4), f = load(p_1 + 4), g = load(p_2 + 4), h = load(p_3 + 4);
    transpose(a, b, c, d);
    transpose(e, f, g, h);
    return {a, b, c, e, f, g, h};
}

CRAZE_INLINE void store_seven(double* p, Seven s)
{
    Lanes unused{};
    transpose(s.a, s.b, s.c, unused);
    transpose(s.e, s.f, s.g, s.h);
    store(p, s.a), store(p + 8, s.b), store(p + 16, s.c), store(p + 24, unused);
    store(p + 4, s.e), store(p + 12, s.f), store(p + 20, s.g), store(p + 28, s.h);
}

/// The rows of a Six: four first numbers and two last ones of each lane.
struct Rows {
    Lanes head[lanes];
    Pair tail[lanes];
};
CRAZE_INLINE Rows rows_of(Six s)
{
    Rows r;
    const Lanes low = __builtin_shufflevector(s.e, s.f, 0, 4, 2, 6),
                high = __builtin_shufflevector(s.e, s.f, 1, 5, 3, 7);
    transpose(s.a, s.b, s.c, s.d);
    r.head[0] = s.a, r.head[1] = s.b, r.head[2] = s.c, r.head[3] = s.d;
    r.tail[0] = __builtin_shufflevector(low, low, 0, 1), r.tail[1] = __builtin_shufflevector(high, high, 0, 1);
    r.tail[2] = __builtin_shufflevector(low, low, 2, 3), r.tail[3] = __builtin_shufflevector(high, high, 2, 3);
    return r;
}
/// p += row k.
CRAZE_INLINE void add_row(double* p, const Rows& r, int k)
{
    store(p, load(p) + r.head[k]);
    store(p + 4, load_pair(p + 4) + r.tail[k]);
}

/// Eight single numbers: a row of an element, or one number of eight bonds.
using Floats = float __attribute__((vector_size(32)));
inline constexpr int floats = 8;

CRAZE_INLINE Floats load(const float* p)
{
    Floats v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
CRAZE_INLINE void store(float* p, Floats v) { std::memcpy(p, &v, sizeof v); }

/// Rows become columns.
CRAZE_INLINE void transpose(Floats (&a)[floats])
{
    Floats t[floats], s[floats];
    for (int k = 0; k < 4; ++k) {
        t[2 * k] = __builtin_shufflevector(a[2 * k], a[2 * k + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        t[2 * k + 1] = __builtin_shufflevector(a[2 * k], a[2 * k + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int half = 0; half < 8; half += 4)
        for (int k = 0; k < 2; ++k) {
            s[half + 2 * k] = __builtin_shufflevector(t[half + k], t[half + 2 + k], 0, 1, 8, 9, 4, 5, 12, 13);
            s[half + 2 * k + 1] = __builtin_shufflevector(t[half + k], t[half + 2 + k], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (int k = 0; k < 4; ++k) {
        a[k] = __builtin_shufflevector(s[k], s[4 + k], 0, 1, 2, 3, 8, 9, 10, 11);
        a[4 + k] = __builtin_shufflevector(s[k], s[4 + k], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

}  // namespace craze::mechanics
