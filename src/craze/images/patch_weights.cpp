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

CRAZE_INLINE u16 weight_of(u16 sum, const PatchScale::Weights& w)
{
    const u16 t = static_cast<u16>(std::max(sum, w.free) - w.free);
    const i16 z = static_cast<i16>(static_cast<u16>((std::max(w.reach, t) - t) * w.stretch));
    i16 e = times(z, z);
    if (!w.plain) e = times(e, w.factor);
    e = static_cast<i16>(e + w.base);
    for (int i = 0; i < 5; ++i) e = times(e, e);
    return static_cast<u16>(e);
}

}  // namespace

PatchScale::PatchScale(const NonLocalMeans& filter)
{
    // exp(-u) = (b + c (r - u)^2)^32 within 0.4 % of exp(-3 u / 4) on [0, 10].
    constexpr double b = 0.462941, c = 4.560224e-4, r = 34.321422;
    constexpr double end = 9.5;  // weights beyond this u round to zero
    const auto n = static_cast<double>(filter.neighbourhood), count = filter.in_volume ? n * n * n : n * n;
    const double h2 = filter.h * filter.h, noise = 2.0 * filter.sigma * filter.sigma;
    cap = static_cast<u16>(65535.0 / n);
    constexpr double most = 65535.0 / static_cast<double>(chunk) / 1.005, g_power = most / 32768.0;
    const double g = std::pow(g_power, 1.0 / 32.0);
    // Of u, in sums: such that z needs no factor, or less, if room or whole squares ask for it.
    const double handy = 32768.0 * std::sqrt(g * c);
    double unit = std::min(handy, cap / (end + noise / h2));
    double of_square = unit / (count * h2);  // of one squared gray level
    weights.plain = unit == handy && of_square <= 0.5;
    exact = of_square >= 1.0;
    of_square = exact ? 1.0 : std::min(of_square, 0.5);
    unit = of_square * count * h2;
    const double of_level = exact ? 1.0 : std::sqrt(32768.0 * of_square);
    for (int v = 0; v < 256; ++v) scaled[static_cast<std::size_t>(v)] = static_cast<i16>(std::lround(of_level * v));
    narrow = (exact ? 1.0 : 1.0 / 32768.0) * scaled[255] * scaled[255] < cap;
    weights.free = static_cast<u16>(std::lround(count * of_square * noise));
    weights.reach = static_cast<u16>(std::lround(r * unit));
    weights.stretch = weights.plain ? u16{1} : static_cast<u16>(32767 / weights.reach);
    const double z = weights.reach * weights.stretch, top = z * z / 32768.0, wanted = 32768.0 * g * c * r * r;
    weights.factor = static_cast<i16>(std::min(32767L, std::lround(32768.0 * wanted / top)));
    weights.base = static_cast<i16>(std::lround(32768.0 * g * b));
    one = weight_of(0, weights);
}

namespace plain {

void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step)
{
    for (std::int64_t k = 0; k < r.count; ++k) {
        u16* column = r.column + k * r.column_stride;
        std::fill_n(column, r.columns(), u16{0});
        for (std::int64_t plane = 0; plane < planes; ++plane) {
            const i16 *a = r.p_new + plane * step, *b = r.ps_new + plane * step + k * lanes;
            for (std::int64_t i = 0; i < r.columns(); ++i)
                column[i] = static_cast<u16>(column[i] + square(a[i], b[i], scale.exact, scale.cap));
        }
    }
}

void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    const u16 cap = scale.cap;
    const std::int64_t back = (r.neighbourhood - 1) * lanes;
    for (std::int64_t k = 0; k < r.count; ++k) {
        u16* __restrict column = r.column + k * r.column_stride;
        u16* __restrict band = r.band + k * r.column_stride;
        const u16* __restrict old = r.column_old + k * r.column_stride;
        u16* __restrict weight = r.weight + k * r.weight_stride;
        const i16 *b = r.ps_new + k * lanes, *old_b = r.ps_old + k * lanes;
        if (!columns_done)
            for (std::int64_t i = 0; i < r.columns(); ++i)
                column[i] = static_cast<u16>(column[i] + square(r.p_new[i], b[i], scale.exact, cap) -
                                             square(r.p_old[i], old_b[i], scale.exact, cap));
        for (std::int64_t i = 0; i < r.columns(); ++i)
            band[i] = static_cast<u16>(band[i] + std::min(column[i], cap) - std::min(old[i], cap));
        if (!weigh) continue;
        u16 patch[lanes] = {};
        for (std::int64_t i = 0; i < r.columns(); ++i) {
            u16& sum = patch[i % lanes];
            sum = static_cast<u16>(sum + std::min(band[i], cap));
            if (i < back) continue;
            weight[i - back] = weight_of(sum, scale.weights);
            sum = static_cast<u16>(sum - std::min(band[i - back], cap));
        }
    }
}

void add_here(const WeightedRows& rows, std::int32_t* to)
{
    for (std::int64_t k = 0; k < rows.count; ++k)
        for (std::int64_t i = 0; i < rows.length * lanes; ++i) {
            const u16 w = rows.weight[k * rows.weight_stride + i];
            std::int32_t* at = to + i / lanes * sums_of_vector + i % 2 * (lanes / 2) + i % lanes / 2;
            at[0] += times(static_cast<i16>(w), rows.level[i + (rows.first + k) * lanes]);
            at[lanes] += w;
        }
}

void add_there(const WeightedRows& rows, std::int32_t* to)
{
    for (std::int64_t k = 0; k < rows.count; ++k)
        for (std::int64_t i = 0; i < rows.length * lanes; ++i) {
            const u16 w = rows.weight[k * rows.weight_stride + i];
            std::int32_t* at = to + (i / lanes + rows.first + k) * sums_of_vector + i % 2 * (lanes / 2) + i % lanes / 2;
            at[0] += times(static_cast<i16>(w), rows.level[i]);
            at[lanes] += w;
        }
}

}  // namespace plain

void start_columns(const PatchRow& r, const PatchScale& scale, std::int64_t planes, std::int64_t step)
{
    return spelled_out() ? avx2::start_columns(r, scale, planes, step) : plain::start_columns(r, scale, planes, step);
}
void weigh_row(const PatchRow& r, const PatchScale& scale, bool columns_done, bool weigh)
{
    return spelled_out() ? avx2::weigh_row(r, scale, columns_done, weigh)
                         : plain::weigh_row(r, scale, columns_done, weigh);
}
void add_here(const WeightedRows& rows, std::int32_t* to)
{
    return spelled_out() ? avx2::add_here(rows, to) : plain::add_here(rows, to);
}
void add_there(const WeightedRows& rows, std::int32_t* to)
{
    return spelled_out() ? avx2::add_there(rows, to) : plain::add_there(rows, to);
}

}  // namespace craze::images
