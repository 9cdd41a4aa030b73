// The loops of patch_weights.cpp spelled out: left to itself the compiler widens half of them to 32 bits.

#include "craze/images/patch_weights.hpp"

#if defined(__x86_64__) && defined(__GNUC__)

#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))
#define AVX2_INLINE __attribute__((target("avx2"), always_inline)) inline

namespace craze::images {

namespace {

using i16 = std::int16_t;
using u16 = std::uint16_t;

AVX2_INLINE __m256i all(int value) { return _mm256_set1_epi16(static_cast<short>(value)); }
AVX2_INLINE __m256i at(const void* from) { return _mm256_loadu_si256(static_cast<const __m256i*>(from)); }
AVX2_INLINE void put(void* to, __m256i v) { _mm256_storeu_si256(static_cast<__m256i*>(to), v); }

template <bool exact>
AVX2_INLINE __m256i square(const i16* a, const i16* b, __m256i cap)
{
    const __m256i d = _mm256_sub_epi16(at(a), at(b));
    return _mm256_min_epu16(exact ? _mm256_mullo_epi16(d, d) : _mm256_mulhrs_epi16(d, d), cap);
}

template <bool exact, bool slide>
AVX2_INLINE void add_columns(const PatchRow& r, std::int64_t k, __m256i cap, u16* capped)
{
    const i16 *a = r.p_new, *b = r.ps_new + k, *old_a = r.p_old, *old_b = r.ps_old + k;
    u16 *column = r.column + k * r.column_stride, *band = r.band + k * r.column_stride;
    const u16* old = r.column_old + k * r.column_stride;
    const std::int64_t length = r.length + lanes;
    for (std::int64_t i = 0; i < length; i += lanes) {
        __m256i sum = at(column + i);
        if constexpr (slide) {
            sum = _mm256_add_epi16(
                sum, _mm256_sub_epi16(square<exact>(a + i, b + i, cap), square<exact>(old_a + i, old_b + i, cap)));
            put(column + i, sum);
        }
        const __m256i change = _mm256_sub_epi16(_mm256_min_epu16(sum, cap), _mm256_min_epu16(at(old + i), cap));
        const __m256i next = _mm256_add_epi16(at(band + i), change);
        put(band + i, next);
        put(capped + i, _mm256_min_epu16(next, cap));
    }
}

// Several at once: one chain of multiplications alone leaves the units waiting.
template <int n, int m>
AVX2_INLINE void weigh(const u16* capped, u16* weight, const PatchScale::Weights& w)
{
    const __m256i c0 = all(w.cubic[0]), c1 = all(w.cubic[1]), c2 = all(w.cubic[2]), c3 = all(w.cubic[3]);
    __m256i x[m], e[m];
#define EACH(...) \
    _Pragma("GCC unroll 8") for (int j = 0; j < m; ++j) { __VA_ARGS__; }
    EACH(x[j] = at(capped + j * lanes))
    _Pragma("GCC unroll 16") for (int i = 1; i < n; ++i) EACH(x[j] = _mm256_add_epi16(x[j], at(capped + j * lanes + i)))
        EACH(x[j] = _mm256_subs_epu16(x[j], all(w.free))) EACH(x[j] = _mm256_min_epu16(x[j], all(w.most)))
            EACH(x[j] = _mm256_mullo_epi16(x[j], all(w.stretch))) EACH(e[j] = _mm256_mulhrs_epi16(x[j], c3))
                EACH(e[j] = _mm256_add_epi16(e[j], c2)) EACH(e[j] = _mm256_mulhrs_epi16(x[j], e[j]))
                    EACH(e[j] = _mm256_add_epi16(e[j], c1)) EACH(e[j] = _mm256_mulhrs_epi16(x[j], e[j]))
                        EACH(e[j] = _mm256_add_epi16(e[j], c0)) EACH(e[j] = _mm256_slli_epi16(e[j], 2))
                            EACH(e[j] = _mm256_mulhrs_epi16(e[j], e[j])) EACH(e[j] = _mm256_mulhrs_epi16(e[j], e[j]))
                                EACH(x[j] = _mm256_srai_epi16(e[j], 2))
                                    EACH(put(weight + j * lanes, _mm256_mulhrs_epi16(e[j], x[j])))
#undef EACH
}

template <int n>
AVX2 void weigh_rows(const PatchRow& r, const PatchScale& scale, bool columns_done, bool needed)
{
    const __m256i cap = all(scale.cap);
    const PatchScale::Weights w = scale.weights;
    alignas(32) u16 capped[longest_column];
    for (std::int64_t k = 0; k < r.count; ++k) {
        if (columns_done)
            add_columns<false, false>(r, k, cap, capped);
        else if (scale.exact)
            add_columns<true, true>(r, k, cap, capped);
        else
            add_columns<false, true>(r, k, cap, capped);
        if (!needed) continue;
        u16* weight = r.weight + k * r.weight_stride;
        std::int64_t i = 0;
        for (; i + 4 * lanes <= r.length; i += 4 * lanes) weigh<n, 4>(capped + i, weight + i, w);
        for (; i < r.length; i += lanes) weigh<n, 1>(capped + i, weight + i, w);
    }
}

struct Sums {
    __m256i weighted, weights;
};

template <int n>
AVX2_INLINE void add_terms(Sums& s, const u16* weight, const i16* level, std::int64_t weight_stride,
                           std::int64_t level_stride)
{
    for (int j = 0; j < n; ++j) {
        const __m256i w = at(weight + j * weight_stride);
        s.weights = _mm256_add_epi16(s.weights, w);
        s.weighted = _mm256_add_epi16(s.weighted, _mm256_mulhrs_epi16(w, at(level + j * level_stride)));
    }
}

AVX2_INLINE void widen(__m256i v, __m256i& low, __m256i& high)
{
    low = _mm256_add_epi32(low, _mm256_cvtepu16_epi32(_mm256_castsi256_si128(v)));
    high = _mm256_add_epi32(high, _mm256_cvtepu16_epi32(_mm256_extracti128_si256(v, 1)));
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
        for (std::int64_t i = 0; i < r.length + lanes; i += lanes) {
            const i16 *a = r.p_new + i, *b = r.ps_new + k + i;
            put(column + i,
                _mm256_add_epi16(at(column + i), scale.exact ? square<true>(a, b, cap) : square<false>(a, b, cap)));
        }
    }
}

void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    switch (r.neighbourhood) {
        case 3: return weigh_rows<3>(r, scale, columns_done, weigh);
        case 5: return weigh_rows<5>(r, scale, columns_done, weigh);
        case 7: return weigh_rows<7>(r, scale, columns_done, weigh);
        case 9: return weigh_rows<9>(r, scale, columns_done, weigh);
        default: return weigh_rows<11>(r, scale, columns_done, weigh);
    }
}

AVX2 void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n)
{
    const std::int64_t ws = rows.weight_stride, vs = rows.level_stride;
    for (std::int64_t i = 0; i < n; i += lanes) {
        __m256i weighted0 = at(to.weighted + i), weighted1 = at(to.weighted + i + 8), weights0 = at(to.weights + i),
                weights1 = at(to.weights + i + 8);
        const u16* weight = rows.weight + i;
        const i16* level = rows.level + i;
        for (std::int64_t k = 0; k < rows.count; k += chunk, weight += chunk * ws, level += chunk * vs) {
            Sums s{_mm256_setzero_si256(), _mm256_setzero_si256()};
            if (rows.count - k >= chunk)
                add_terms<chunk>(s, weight, level, ws, vs);
            else
                for (std::int64_t j = 0; j < rows.count - k; ++j)
                    add_terms<1>(s, weight + j * ws, level + j * vs, ws, vs);
            widen(s.weighted, weighted0, weighted1);
            widen(s.weights, weights0, weights1);
        }
        put(to.weighted + i, weighted0);
        put(to.weighted + i + 8, weighted1);
        put(to.weights + i, weights0);
        put(to.weights + i + 8, weights1);
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
void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n) { plain::add_rows(rows, to, n); }
}  // namespace avx2

}  // namespace craze::images

#endif
