#include "craze/images/patch_weights.hpp"

#include "craze/core/multiversion.hpp"

#include <algorithm>
#include <cmath>

namespace craze::images {

namespace {

using i16 = std::int16_t;
using u16 = std::uint16_t;

// a b 2^-15, rounded: one instruction where there is one.
CRAZE_INLINE i16 times(i16 a, i16 b) { return static_cast<i16>(((static_cast<int>(a) * b >> 14) + 1) >> 1); }

CRAZE_INLINE u16 square(i16 a, i16 b, bool exact, u16 cap)
{
    const i16 d = static_cast<i16>(a - b);
    return std::min(exact ? static_cast<u16>(static_cast<u16>(d) * static_cast<unsigned>(static_cast<u16>(d)))
                          : static_cast<u16>(times(d, d)),
                    cap);
}

// exp(-10 t / most) as the eighth power of a cubic.
CRAZE_INLINE u16 weight_of(u16 sum, const PatchScale::Weights& w)
{
    const u16 t = std::min(static_cast<u16>(std::max(sum, w.free) - w.free), w.most);
    const i16 x = static_cast<i16>(static_cast<u16>(t * w.stretch));
    i16 e = static_cast<i16>(times(x, w.cubic[3]) + w.cubic[2]);
    e = static_cast<i16>(times(x, e) + w.cubic[1]);
    e = static_cast<i16>(static_cast<i16>(times(x, e) + w.cubic[0]) * 4);
    e = times(e, e);
    e = times(e, e);
    return static_cast<u16>(times(e, static_cast<i16>(e >> 2)));
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
    // exp(-u) on [0, 1.25] within 8e-4, as a cubic in u, then in x.
    const double u_of_x = 1.25 * 32768.0 / (weights.most * weights.stretch);
    const std::array cubic{0.99927, -0.98389, 0.44015, -0.08749};
    double power = 8192.0;
    for (std::size_t i = 0; i < 4; ++i, power *= u_of_x)
        weights.cubic[i] = static_cast<i16>(std::lround(cubic[i] * power));
}

namespace plain {

void start_columns(const PatchRow& r, const PatchScale& scale)
{
    for (std::int64_t k = 0; k < r.count; ++k)
        for (std::int64_t i = 0; i < r.length + lanes; ++i)
            r.column[k * r.column_stride + i] = static_cast<u16>(
                r.column[k * r.column_stride + i] + square(r.p_new[i], r.ps_new[i + k], scale.exact, scale.cap));
}

void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    const u16 cap = scale.cap;
    const std::int64_t n = r.neighbourhood;
    u16 capped[longest_column];
    for (std::int64_t k = 0; k < r.count; ++k) {
        u16* __restrict column = r.column + k * r.column_stride;
        u16* __restrict band = r.band + k * r.column_stride;
        const u16* __restrict old = r.column_old + k * r.column_stride;
        u16* __restrict weight = r.weight + k * r.weight_stride;
        if (!columns_done)
            for (std::int64_t i = 0; i < r.length + lanes; ++i)
                column[i] = static_cast<u16>(column[i] + square(r.p_new[i], r.ps_new[i + k], scale.exact, cap) -
                                             square(r.p_old[i], r.ps_old[i + k], scale.exact, cap));
        for (std::int64_t i = 0; i < r.length + lanes; ++i) {
            band[i] = static_cast<u16>(band[i] + std::min(column[i], cap) - std::min(old[i], cap));
            capped[i] = std::min(band[i], cap);
        }
        if (!weigh) continue;
        for (std::int64_t i = 0; i < r.length; ++i) {
            u16 patch = 0;
            for (std::int64_t j = 0; j < n; ++j) patch = static_cast<u16>(patch + capped[i + j]);
            weight[i] = weight_of(patch, scale.weights);
        }
    }
}

void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n)
{
    for (std::int64_t k = 0; k < rows.count; ++k) {
        const u16* __restrict w = rows.weight + k * rows.weight_stride;
        const i16* __restrict v = rows.level + k * rows.level_stride;
        for (std::int64_t i = 0; i < n; ++i) {
            to.weighted[i] += times(static_cast<i16>(w[i]), v[i]);
            to.weights[i] += w[i];
        }
    }
}

}  // namespace plain

void start_columns(const PatchRow& r, const PatchScale& scale)
{
    return spelled_out() ? avx2::start_columns(r, scale) : plain::start_columns(r, scale);
}
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    return spelled_out() ? avx2::weigh_row(r, scale, columns_done, weigh)
                         : plain::weigh_row(r, scale, columns_done, weigh);
}
void add_rows(const WeightedRows& rows, Accumulators to, std::int64_t n)
{
    return spelled_out() ? avx2::add_rows(rows, to, n) : plain::add_rows(rows, to, n);
}

}  // namespace craze::images
