// The loops of patch_weights.cpp spelled out: left to itself the compiler widens half of them to 32 bits.

#include "craze/images/patch_weights.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))
#define AVX2_INLINE __attribute__((target("avx2"), always_inline)) inline
#define AVX2_LAMBDA __attribute__((target("avx2"), always_inline))

namespace craze::images {

namespace {

using i16 = std::int16_t;
using u16 = std::uint16_t;

AVX2_INLINE __m256i all(int value) { return _mm256_set1_epi16(static_cast<short>(value)); }
AVX2_INLINE __m256i at(const void* from) { return _mm256_loadu_si256(static_cast<const __m256i*>(from)); }
AVX2_INLINE void put(void* to, __m256i v) { _mm256_storeu_si256(static_cast<__m256i*>(to), v); }

enum class Squares { exact, scaled, narrow };

template <Squares how>
AVX2_INLINE __m256i square(const i16* a, const i16* b, __m256i cap)
{
    const __m256i d = _mm256_sub_epi16(at(a), at(b));
    if constexpr (how == Squares::narrow) return _mm256_mulhrs_epi16(d, d);
    return _mm256_min_epu16(how == Squares::exact ? _mm256_mullo_epi16(d, d) : _mm256_mulhrs_epi16(d, d), cap);
}

// From a sum to its weight in four steps.
template <bool handy>
AVX2_INLINE __m256i distance_of(__m256i sum, const PatchScale::Weights& w)
{
    const __m256i z = _mm256_subs_epu16(all(w.reach), _mm256_subs_epu16(sum, all(w.free)));
    return handy ? z : _mm256_mullo_epi16(z, all(w.stretch));
}
template <bool handy>
AVX2_INLINE __m256i parabola_of(__m256i z, const PatchScale::Weights& w)
{
    __m256i e = _mm256_mulhrs_epi16(z, z);
    if constexpr (!handy) e = _mm256_mulhrs_epi16(e, all(w.factor));
    return _mm256_add_epi16(e, all(w.base));
}
AVX2_INLINE __m256i squared(__m256i e) { return _mm256_mulhrs_epi16(e, e); }

// One shift of a row: columns and bands slide on; if needed, weights are made. The chain from levels to a weight is
// much longer than what the processor looks ahead: each turn of the loop works on five vectors, one step of it each.
template <Squares how, bool slide, bool handy, bool needed>
AVX2_INLINE void weigh_shift(const PatchRow& r, std::int64_t k, __m256i cap, const PatchScale::Weights& w)
{
    const i16 *a = r.p_new, *b = r.ps_new + k * lanes, *old_a = r.p_old, *old_b = r.ps_old + k * lanes;
    u16 *column = r.column + k * r.column_stride, *band = r.band + k * r.column_stride;
    const u16* old = r.column_old + k * r.column_stride;
    const std::int64_t back = r.neighbourhood - 1, length = r.length + back;
    u16* weight = r.weight + k * r.weight_stride - back * lanes;
    __m256i patch = _mm256_setzero_si256();
    const auto change = [&](std::int64_t i) AVX2_LAMBDA {
        i *= lanes;
        if constexpr (!slide) return _mm256_setzero_si256();
        return _mm256_sub_epi16(square<how>(a + i, b + i, cap), square<how>(old_a + i, old_b + i, cap));
    };
    const auto add = [&](std::int64_t i, __m256i by) AVX2_LAMBDA {
        i *= lanes;
        __m256i sum = at(column + i);
        if constexpr (slide) {
            sum = _mm256_add_epi16(sum, by);
            put(column + i, sum);
        }
        const __m256i next = _mm256_add_epi16(
            at(band + i), _mm256_sub_epi16(_mm256_min_epu16(sum, cap), _mm256_min_epu16(at(old + i), cap)));
        put(band + i, next);
        if constexpr (needed) patch = _mm256_add_epi16(patch, _mm256_min_epu16(next, cap));
    };
    __m256i d = change(0);
    std::int64_t i = 0;
    for (; i < (needed ? back : length - 1); ++i) {
        add(i, d);
        d = change(i + 1);
    }
    if constexpr (!needed) return add(i, d);
    const auto distance = [&](std::int64_t j) AVX2_LAMBDA {
        add(j, d);
        const __m256i z = distance_of<handy>(patch, w);
        patch = _mm256_sub_epi16(patch, _mm256_min_epu16(at(band + (j - back) * lanes), cap));
        return z;
    };
    if (r.length < 4) {
        for (; i < length; ++i) {
            __m256i e = parabola_of<handy>(distance(i), w);
            for (int j = 0; j < 5; ++j) e = squared(e);
            put(weight + i * lanes, e);
            if (i + 1 < length) d = change(i + 1);
        }
        return;
    }
    __m256i z = distance(i), e1, e2;
    d = change(i + 1);
    e1 = squared(parabola_of<handy>(z, w)), z = distance(i + 1), d = change(i + 2);
    e2 = squared(squared(e1)), e1 = squared(parabola_of<handy>(z, w)), z = distance(i + 2), d = change(i + 3);
    for (i += 3; i < length - 1; ++i) {
        put(weight + (i - 3) * lanes, squared(squared(e2)));
        e2 = squared(squared(e1));
        e1 = squared(parabola_of<handy>(z, w));
        z = distance(i);
        d = change(i + 1);
    }
    put(weight + (i - 3) * lanes, squared(squared(e2)));
    put(weight + (i - 2) * lanes, squared(squared(squared(squared(e1)))));
    put(weight + (i - 1) * lanes, squared(squared(squared(squared(squared(parabola_of<handy>(z, w)))))));
    e1 = parabola_of<handy>(distance(i), w);
    put(weight + i * lanes, squared(squared(squared(squared(squared(e1))))));
}

template <Squares how, bool slide, bool handy, bool needed>
AVX2 void weigh_rows(const PatchRow& r, const PatchScale& scale)
{
    const __m256i cap = all(scale.cap);
    const PatchScale::Weights w = scale.weights;
    for (std::int64_t k = 0; k < r.count; ++k) weigh_shift<how, slide, handy, needed>(r, k, cap, w);
}

template <Squares how, bool handy>
void weigh_rows(const PatchRow& r, const PatchScale& scale, bool columns_done, bool needed)
{
    if (columns_done)
        return needed ? weigh_rows<how, false, handy, true>(r, scale) : weigh_rows<how, false, handy, false>(r, scale);
    return needed ? weigh_rows<how, true, handy, true>(r, scale) : weigh_rows<how, true, handy, false>(r, scale);
}

// `count` terms to one vector of voxels; with each the weight lies `ws` values further and the level `vs`.
AVX2_INLINE void add_terms(const u16* weight, const i16* level, std::int64_t ws, std::int64_t vs, std::int64_t count,
                           std::int32_t* to)
{
    __m256i weighted_even = at(to), weighted_odd = at(to + 8), even = at(to + 16), odd = at(to + 24);
    const __m256i low = _mm256_set1_epi32(0xffff);
    while (count > 0) {
        const std::int64_t n = count < chunk ? count : chunk;
        __m256i weighted = _mm256_setzero_si256(), weights = weighted;
        for (std::int64_t j = 0; j < n; ++j, weight += ws, level += vs) {
            const __m256i w = at(weight);
            weights = _mm256_add_epi16(weights, w);
            weighted = _mm256_add_epi16(weighted, _mm256_mulhrs_epi16(w, at(level)));
        }
        weighted_even = _mm256_add_epi32(weighted_even, _mm256_and_si256(weighted, low));
        weighted_odd = _mm256_add_epi32(weighted_odd, _mm256_srli_epi32(weighted, 16));
        even = _mm256_add_epi32(even, _mm256_and_si256(weights, low));
        odd = _mm256_add_epi32(odd, _mm256_srli_epi32(weights, 16));
        count -= n;
    }
    put(to, weighted_even);
    put(to + 8, weighted_odd);
    put(to + 16, even);
    put(to + 24, odd);
}

}  // namespace

bool spelled_out()
{
    static const bool has = __builtin_cpu_supports("avx2") != 0;
    return has;
}

namespace avx2 {

AVX2 void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step)
{
    const __m256i cap = all(scale.cap);
    const bool exact = scale.exact;
    for (std::int64_t k = 0; k < r.count; ++k)
        for (std::int64_t i = 0; i < r.columns(); i += lanes) {
            const i16 *a = r.p_new + i, *b = r.ps_new + i + k * lanes;
            __m256i sum = _mm256_setzero_si256();
            for (std::int64_t plane = 0; plane < planes; ++plane, a += step, b += step)
                sum = _mm256_add_epi16(sum,
                                       exact ? square<Squares::exact>(a, b, cap) : square<Squares::scaled>(a, b, cap));
            put(r.column + k * r.column_stride + i, sum);
        }
}

void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    if (scale.exact) return weigh_rows<Squares::exact, false>(r, scale, columns_done, weigh);
    if (!scale.weights.plain) return weigh_rows<Squares::scaled, false>(r, scale, columns_done, weigh);
    return scale.narrow ? weigh_rows<Squares::narrow, true>(r, scale, columns_done, weigh)
                        : weigh_rows<Squares::scaled, true>(r, scale, columns_done, weigh);
}

AVX2 void add_here(const WeightedRows& rows, std::int32_t* to)
{
    const i16* level = rows.level + rows.first * lanes;
    for (std::int64_t i = 0; i < rows.length; ++i, to += sums_of_vector)
        add_terms(rows.weight + i * lanes, level + i * lanes, rows.weight_stride, lanes, rows.count, to);
}

// Whoever is reached at vector i comes from vectors i - first - k.
AVX2 void add_there(const WeightedRows& rows, std::int32_t* to)
{
    for (std::int64_t i = rows.first; i < rows.length + rows.first + rows.count - 1; ++i) {
        const std::int64_t from = i - rows.first, begin = from < rows.length ? 0 : from - rows.length + 1,
                           end = from < rows.count ? from + 1 : rows.count;
        add_terms(rows.weight + begin * rows.weight_stride + (from - begin) * lanes,
                  rows.level + (from - begin) * lanes, rows.weight_stride - lanes, -lanes, end - begin,
                  to + i * sums_of_vector);
    }
}

}  // namespace avx2

}  // namespace craze::images

#else

namespace craze::images {

bool spelled_out() { return false; }

namespace avx2 {
void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step)
{
    plain::start_columns(r, scale, planes, step);
}
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    plain::weigh_row(r, scale, columns_done, weigh);
}
void add_here(const WeightedRows& rows, std::int32_t* to) { plain::add_here(rows, to); }
void add_there(const WeightedRows& rows, std::int32_t* to) { plain::add_there(rows, to); }
}  // namespace avx2

}  // namespace craze::images

#endif
