#include "craze/images/patch_weights.hpp"

#include "craze/core/multiversion.hpp"

#include <algorithm>
#include <cmath>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace craze::images {

namespace {

using i16 = std::int16_t;
using u16 = std::uint16_t;

// a b 2^-15, rounded: one instruction where there is one.
CRAZE_INLINE i16 times(i16 a, i16 b) { return static_cast<i16>(((static_cast<int>(a) * b >> 14) + 1) >> 1); }

template <bool exact>
CRAZE_INLINE u16 square(i16 a, i16 b, u16 cap)
{
    const i16 d = static_cast<i16>(a - b);
    return std::min(exact ? static_cast<u16>(static_cast<u16>(d) * static_cast<unsigned>(static_cast<u16>(d)))
                          : static_cast<u16>(times(d, d)),
                    cap);
}

template <bool exact>
CRAZE_INLINE void add(const i16* __restrict a, const i16* __restrict b, u16* __restrict column, u16 cap)
{
    for (std::int64_t i = 0; i < padded_row; ++i)
        column[i] = static_cast<u16>(column[i] + square<exact>(a[i], b[i], cap));
}

template <bool exact>
CRAZE_INLINE void slide(const i16* __restrict a, const i16* __restrict b, const i16* __restrict old_a,
                        const i16* __restrict old_b, u16* __restrict column, u16 cap)
{
    for (std::int64_t i = 0; i < padded_row; ++i)
        column[i] =
            static_cast<u16>(column[i] + square<exact>(a[i], b[i], cap) - square<exact>(old_a[i], old_b[i], cap));
}

// exp(-10 t / most) as (exp(-u))^8 with u = 1.25 t / most: a cubic within 8e-4, then three squarings. The constants
// come from memory: what the compiler knows of them leads it away from 16 bits.
CRAZE_INLINE u16 weight_of(u16 sum, const PatchScale::Weights& w)
{
    const u16 t = std::min(static_cast<u16>(std::max(sum, w.free) - w.free), w.most);
    const i16 u = times(static_cast<i16>(static_cast<u16>(t * w.stretch)), w.slope);
    i16 e = static_cast<i16>(times(u, w.cubic[3]) + w.cubic[2]);
    e = static_cast<i16>(static_cast<i16>(times(u, e) + w.cubic[1]) * w.four);
    e = static_cast<i16>(static_cast<i16>(times(u, e) + w.cubic[0]) * w.four);
    e = times(e, e);
    e = times(e, e);
    return static_cast<u16>(times(e, times(e, w.quarter)));
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(CRAZE_SANITIZED)
#define CRAZE_AVX2_SUMS

// The same as below, spelled out: left to itself the compiler widens half of it to 32 bits, four times slower.
template <int n, bool weigh>
__attribute__((target("avx2"))) void sum_avx2(const u16* column, u16* row, u16* patch, u16* weight,
                                              const PatchScale& scale)
{
    const auto all = [](auto value) __attribute__((target("avx2"), always_inline))
    {
        return _mm256_set1_epi16(static_cast<short>(value));
    };
    const auto at = [](const u16* from) __attribute__((target("avx2"), always_inline))
    {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
    };
    const auto put = [](u16 * to, __m256i v) __attribute__((target("avx2"), always_inline))
    {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), v);
    };
    const PatchScale::Weights& w = scale.weights;
    const __m256i cap = all(scale.cap), free = all(w.free), most = all(w.most), stretch = all(w.stretch),
                  slope = all(w.slope), c0 = all(w.cubic[0]), c1 = all(w.cubic[1]), c2 = all(w.cubic[2]),
                  c3 = all(w.cubic[3]), quarter = all(w.quarter);
    for (std::int64_t i = 0; i < row_length; i += 16) {
        __m256i along = _mm256_min_epu16(at(column + i), cap);
        for (int j = 1; j < n; ++j) along = _mm256_add_epi16(along, _mm256_min_epu16(at(column + i + j), cap));
        along = _mm256_min_epu16(along, cap);
        const __m256i total = _mm256_add_epi16(at(patch + i), _mm256_sub_epi16(along, at(row + i)));
        put(row + i, along);
        put(patch + i, total);
        if constexpr (!weigh) continue;
        const __m256i t = _mm256_min_epu16(_mm256_subs_epu16(total, free), most);
        const __m256i u = _mm256_mulhrs_epi16(_mm256_mullo_epi16(t, stretch), slope);
        __m256i e = _mm256_add_epi16(_mm256_mulhrs_epi16(u, c3), c2);
        e = _mm256_slli_epi16(_mm256_add_epi16(_mm256_mulhrs_epi16(u, e), c1), 2);
        e = _mm256_slli_epi16(_mm256_add_epi16(_mm256_mulhrs_epi16(u, e), c0), 2);
        e = _mm256_mulhrs_epi16(e, e);
        e = _mm256_mulhrs_epi16(e, e);
        put(weight + i, _mm256_mulhrs_epi16(e, _mm256_mulhrs_epi16(e, quarter)));
    }
}

bool has_avx2()
{
    static const bool has = __builtin_cpu_supports("avx2") != 0;
    return has;
}
#endif

template <int n, bool weigh>
void sum(const u16* __restrict column, u16* __restrict row, u16* __restrict patch, u16* __restrict weight,
         const PatchScale& scale)
{
    const u16 cap = scale.cap;
    const PatchScale::Weights weights = scale.weights;
    u16 capped[padded_row];
    for (std::int64_t i = 0; i < padded_row; ++i) capped[i] = std::min(column[i], cap);
    for (std::int64_t i = 0; i < row_length; ++i) {
        u16 along = 0;
        for (int j = 0; j < n; ++j) along = static_cast<u16>(along + capped[i + j]);
        along = std::min(along, cap);
        const u16 total = static_cast<u16>(patch[i] + along - row[i]);
        row[i] = along;
        patch[i] = total;
        if constexpr (weigh) weight[i] = weight_of(total, weights);
    }
}

template <int n>
CRAZE_INLINE void sum(const u16* column, u16* row, u16* patch, u16* weight, const PatchScale& scale)
{
#ifdef CRAZE_AVX2_SUMS
    if (has_avx2())
        return weight != nullptr ? sum_avx2<n, true>(column, row, patch, weight, scale)
                                 : sum_avx2<n, false>(column, row, patch, weight, scale);
#endif
    if (weight != nullptr)
        sum<n, true>(column, row, patch, weight, scale);
    else
        sum<n, false>(column, row, patch, weight, scale);
}

}  // namespace

PatchScale::PatchScale(const NonLocalMeans& filter)
{
    const auto n = static_cast<double>(filter.neighbourhood), count = filter.in_volume ? n * n * n : n * n;
    const double noise = 2.0 * filter.sigma * filter.sigma, cutoff = noise + 10.0 * filter.h * filter.h;
    cap = static_cast<u16>(65535.0 / n);
    double unit = cap / (count * cutoff);  // of one squared gray level
    exact = unit >= 1.0;
    unit = exact ? 1.0 : std::min(unit, 0.5);
    const double factor = exact ? 1.0 : std::sqrt(32768.0 * unit);
    for (int v = 0; v < 256; ++v) scaled[static_cast<std::size_t>(v)] = static_cast<i16>(std::lround(factor * v));
    weights.free = static_cast<u16>(std::lround(unit * count * noise));
    weights.most = static_cast<u16>(std::max(1L, std::lround(unit * count * (cutoff - noise))));
    weights.stretch = 1;
    while (weights.most * weights.stretch * 2 <= 32767) weights.stretch = static_cast<u16>(weights.stretch * 2);
    weights.slope = static_cast<i16>(std::lround(10240.0 * 32768.0 / (weights.most * weights.stretch)));
}

CRAZE_MULTIVERSION void add_squares(const i16* a, const i16* b, u16* column, const PatchScale& scale)
{
    if (scale.exact)
        add<true>(a, b, column, scale.cap);
    else
        add<false>(a, b, column, scale.cap);
}

CRAZE_MULTIVERSION void slide_squares(const i16* a, const i16* b, const i16* old_a, const i16* old_b, u16* column,
                                      const PatchScale& scale)
{
    if (scale.exact)
        slide<true>(a, b, old_a, old_b, column, scale.cap);
    else
        slide<false>(a, b, old_a, old_b, column, scale.cap);
}

void sum_patch(const u16* column, u16* row, u16* patch, u16* weight, std::int64_t n, const PatchScale& scale)
{
    switch (n) {
        case 3: return sum<3>(column, row, patch, weight, scale);
        case 5: return sum<5>(column, row, patch, weight, scale);
        case 7: return sum<7>(column, row, patch, weight, scale);
        case 9: return sum<9>(column, row, patch, weight, scale);
        default: return sum<11>(column, row, patch, weight, scale);
    }
}

CRAZE_MULTIVERSION void add_chunk(const WeightedRow* terms, Accumulators to, std::int64_t n)
{
    static_assert(chunk == 7);
    const u16 *__restrict w0 = terms[0].weight, *__restrict w1 = terms[1].weight, *__restrict w2 = terms[2].weight,
                         *__restrict w3 = terms[3].weight, *__restrict w4 = terms[4].weight,
                         *__restrict w5 = terms[5].weight, *__restrict w6 = terms[6].weight;
    const i16 *__restrict v0 = terms[0].level, *__restrict v1 = terms[1].level, *__restrict v2 = terms[2].level,
                         *__restrict v3 = terms[3].level, *__restrict v4 = terms[4].level,
                         *__restrict v5 = terms[5].level, *__restrict v6 = terms[6].level;
    std::int32_t* __restrict weighted = to.weighted, * __restrict weights = to.weights;
    const auto term = [](u16 w, i16 v) __attribute__((always_inline)) { return times(static_cast<i16>(w), v); };
    for (std::int64_t i = 0; i < n; ++i) {
        const u16 sum =
            static_cast<u16>(term(w0[i], v0[i]) + term(w1[i], v1[i]) + term(w2[i], v2[i]) + term(w3[i], v3[i]) +
                             term(w4[i], v4[i]) + term(w5[i], v5[i]) + term(w6[i], v6[i]));
        const u16 count = static_cast<u16>(w0[i] + w1[i] + w2[i] + w3[i] + w4[i] + w5[i] + w6[i]);
        weighted[i] += sum;
        weights[i] += count;
    }
}

void start_row(const i16* level, Accumulators to, std::int64_t n)
{
    for (std::int64_t i = 0; i < n; ++i) {
        to.weighted[i] = times(static_cast<i16>(weight_of_one), level[i]);
        to.weights[i] = weight_of_one;
    }
}

}  // namespace craze::images
