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

template <bool handy>
AVX2_INLINE __m256i weight_of(__m256i sum, const PatchScale::Weights& w)
{
    __m256i e = _mm256_subs_epu16(all(w.reach), _mm256_subs_epu16(sum, all(w.free)));
    if constexpr (!handy) e = _mm256_mullo_epi16(e, all(w.stretch));
    e = _mm256_mulhrs_epi16(e, e);
    if constexpr (!handy) e = _mm256_mulhrs_epi16(e, all(w.factor));
    e = _mm256_add_epi16(e, all(w.base));
    _Pragma("GCC unroll 5") for (int i = 0; i < 5; ++i) e = _mm256_mulhrs_epi16(e, e);
    return e;
}

// All shifts of a row: columns and bands slide on; if needed, weights are made.
template <Squares how, bool slide, bool handy, bool needed>
AVX2 void weigh_rows(const PatchRow& r, const PatchScale& scale)
{
    const __m256i cap = all(scale.cap);
    const PatchScale::Weights w = scale.weights;
    const std::int64_t back = (r.neighbourhood - 1) * lanes, length = r.columns();
    for (std::int64_t k = 0; k < r.count; ++k) {
        const i16 *a = r.p_new, *b = r.ps_new + k * lanes, *old_a = r.p_old, *old_b = r.ps_old + k * lanes;
        u16 *column = r.column + k * r.column_stride, *band = r.band + k * r.column_stride;
        u16* weight = r.weight + k * r.weight_stride - back;
        const u16* old = r.column_old + k * r.column_stride;
        __m256i patch = _mm256_setzero_si256();
        const auto next = [&](std::int64_t i) AVX2_LAMBDA {
            __m256i sum = at(column + i);
            if constexpr (slide) {
                sum = _mm256_add_epi16(
                    sum, _mm256_sub_epi16(square<how>(a + i, b + i, cap), square<how>(old_a + i, old_b + i, cap)));
                put(column + i, sum);
            }
            const __m256i change = _mm256_sub_epi16(_mm256_min_epu16(sum, cap), _mm256_min_epu16(at(old + i), cap));
            const __m256i value = _mm256_add_epi16(at(band + i), change);
            put(band + i, value);
            if constexpr (needed) patch = _mm256_add_epi16(patch, _mm256_min_epu16(value, cap));
        };
        std::int64_t i = 0;
        for (; i < back; i += lanes) next(i);
        for (; i < length; i += lanes) {
            next(i);
            if constexpr (needed) {
                put(weight + i, weight_of<handy>(patch, w));
                patch = _mm256_sub_epi16(patch, _mm256_min_epu16(at(band + i - back), cap));
            }
        }
    }
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

AVX2 void start_columns(const PatchRow& r, const PatchScale& scale)
{
    const __m256i cap = all(scale.cap);
    for (std::int64_t k = 0; k < r.count; ++k) {
        u16* column = r.column + k * r.column_stride;
        for (std::int64_t i = 0; i < r.columns(); i += lanes) {
            const i16 *a = r.p_new + i, *b = r.ps_new + k * lanes + i;
            put(column + i, _mm256_add_epi16(at(column + i), scale.exact ? square<Squares::exact>(a, b, cap)
                                                                         : square<Squares::scaled>(a, b, cap)));
        }
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
void start_columns(const PatchRow& r, const PatchScale& scale) { plain::start_columns(r, scale); }
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    plain::weigh_row(r, scale, columns_done, weigh);
}
void add_here(const WeightedRows& rows, std::int32_t* to) { plain::add_here(rows, to); }
void add_there(const WeightedRows& rows, std::int32_t* to) { plain::add_there(rows, to); }
}  // namespace avx2

}  // namespace craze::images

#endif
