#include "craze/images/non_local_means.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"
#include "craze/images/patch_weights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

namespace craze::images {
namespace {

// The definition, word for word.
Volume<std::uint8_t> twin(const Volume<std::uint8_t>& v, const NonLocalMeans& f)
{
    const auto [nx, ny, nz] = v.shape();
    const auto at = [&, nx = nx, ny = ny, nz = nz](std::int64_t x, std::int64_t y, std::int64_t z) {
        return static_cast<double>(v(mirrored(x, nx), mirrored(y, ny), mirrored(z, nz)));
    };
    const std::int64_t R = f.search / 2, P = f.neighbourhood / 2, Rz = f.in_volume ? R : 0, Pz = f.in_volume ? P : 0;
    Volume<std::uint8_t> out(v.shape());
    for (std::int64_t z = 0; z < nz; ++z)
        for (std::int64_t y = 0; y < ny; ++y)
            for (std::int64_t x = 0; x < nx; ++x) {
                double sum = 0.0, weights = 0.0;
                for (std::int64_t sz = -Rz; sz <= Rz; ++sz)
                    for (std::int64_t sy = -R; sy <= R; ++sy)
                        for (std::int64_t sx = -R; sx <= R; ++sx) {
                            double d2 = 0.0, count = 0.0;
                            for (std::int64_t dz = -Pz; dz <= Pz; ++dz)
                                for (std::int64_t dy = -P; dy <= P; ++dy)
                                    for (std::int64_t dx = -P; dx <= P; ++dx, ++count) {
                                        const double d =
                                            at(x + dx, y + dy, z + dz) - at(x + sx + dx, y + sy + dy, z + sz + dz);
                                        d2 += d * d;
                                    }
                            const double w = std::exp(-std::max(0.0, d2 / count - 2 * f.sigma * f.sigma) / (f.h * f.h));
                            sum += w * at(x + sx, y + sy, z + sz);
                            weights += w;
                        }
                out(x, y, z) = static_cast<std::uint8_t>(std::lround(sum / weights));
            }
    return out;
}

// Noise over a bright and a dark half with a thin dark sheet.
Volume<std::uint8_t> noisy(Shape shape, double sigma, std::uint64_t seed)
{
    Volume<std::uint8_t> v(shape);
    for (std::int64_t z = 0; z < shape.nz; ++z)
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x) {
                Random random(seed, static_cast<std::uint64_t>(x + shape.nx * (y + shape.ny * z)));
                const bool dark = x > 2 * shape.nx / 3 || (y + z) % 17 == 3;
                const double level = (dark ? 45.0 : 165.0) + sigma * random.normal();
                v(x, y, z) = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
            }
    return v;
}

int largest_difference(const Volume<std::uint8_t>& a, const Volume<std::uint8_t>& b)
{
    int most = 0;
    for (std::size_t i = 0; i < a.values().size(); ++i)
        most = std::max(most, std::abs(static_cast<int>(a.values()[i]) - static_cast<int>(b.values()[i])));
    return most;
}

TEST(NonLocalMeans, EqualsItsDefinitionToOneLevel)
{
    struct Case {
        std::int64_t search, neighbourhood;
        bool in_volume;
        double noise, sigma, h;
    };
    for (const Case& c : {Case{7, 3, true, 12, 12, 7.2}, Case{9, 5, true, 12, 12, 7.2}, Case{5, 5, true, 3, 3, 1.8},
                          Case{11, 5, false, 12, 12, 7.2}, Case{5, 7, false, 20, 20, 30}, Case{7, 3, true, 12, 0, 20},
                          Case{7, 3, true, 40, 40, 24}, Case{5, 3, true, 1, 1, 0.6}, Case{5, 11, false, 6, 6, 4}}) {
        const auto v = noisy({23, 18, 9}, c.noise, 11);
        const NonLocalMeans filter{c.search, c.neighbourhood, c.in_volume, c.sigma, c.h};
        EXPECT_LE(largest_difference(non_local_means(v, filter), twin(v, filter)), 1)
            << c.search << "/" << c.neighbourhood << " sigma " << c.sigma << " h " << c.h;
    }
}

TEST(NonLocalMeans, EqualsItsDefinitionOnPureNoise)
{
    Volume<std::uint8_t> v({17, 15, 8});
    Random random(3);
    for (auto& value : v.values()) value = static_cast<std::uint8_t>(random.bits() & 255U);
    for (const NonLocalMeans& filter : {NonLocalMeans{7, 3, true, 74, 44}, NonLocalMeans{7, 3, true, 0, 60},
                                        NonLocalMeans{9, 5, false, 0, 45}, NonLocalMeans{7, 3, true, 60, 10}})
        EXPECT_LE(largest_difference(non_local_means(v, filter), twin(v, filter)), 1);
}

TEST(NonLocalMeans, LeavesAConstantVolumeAlone)
{
    const Volume<std::uint8_t> v({40, 21, 13}, 137);
    const auto out = non_local_means(v, {});
    EXPECT_TRUE(std::ranges::all_of(out.values(), [](std::uint8_t value) { return value == 137; }));
}

TEST(NonLocalMeans, GivesTheSameBitsForAnySlabAndThreads)
{
    const auto v = noisy({130, 37, 30}, 12, 5);
    const NonLocalMeans filter{9, 5, true, 12, 7.2};
    set_threads(1);
    const auto whole = non_local_means(v, filter);
    for (const std::int64_t slab : {1, 7, 30}) {
        set_threads(2);
        Volume<std::uint8_t> parts(v.shape());
        for (std::int64_t z = 0; z < 30; z += slab)
            filter_slab(
                filter, v.shape(), z, std::min<std::int64_t>(30, z + slab),
                [&](std::int64_t k, std::span<std::uint8_t> to) { std::ranges::copy(v.slice(k), to.begin()); },
                [&](std::int64_t k, std::span<const std::uint8_t> from) {
                    std::ranges::copy(from, parts.slice(k).begin());
                });
        EXPECT_EQ(largest_difference(whole, parts), 0) << slab;
    }
    set_threads(0);
}

TEST(NonLocalMeans, KeepsTheContrastOfAThinSheetAndRemovesTheNoise)
{
    const Shape shape{60, 60, 40};
    const auto v = noisy(shape, 12, 9);
    const auto out = non_local_means(v, {21, 5, true, 12, 7.2});
    double matter = 0, matter2 = 0, sheet = 0, n = 0, m = 0;
    for (std::int64_t z = 12; z < 28; ++z)
        for (std::int64_t y = 12; y < 48; ++y)
            for (std::int64_t x = 12; x < 28; ++x) {
                const double value = out(x, y, z);
                if ((y + z) % 17 == 3)
                    sheet += value, ++m;
                else if ((y + z) % 17 > 6)
                    matter += value, matter2 += value * value, ++n;
            }
    matter /= n, sheet /= m;
    EXPECT_LT(std::sqrt(matter2 / n - matter * matter), 12.0 / 10);
    EXPECT_GT((matter - sheet) / 120, 0.95);
}

// The loops spelled out and the plain ones, on sums that wrap and levels at random.
TEST(PatchWeights, AreTheSameBitsSpelledOutOrPlain)
{
    if (!spelled_out()) GTEST_SKIP() << "this machine has no AVX2";
    for (const NonLocalMeans& filter : {NonLocalMeans{21, 5, true, 12, 7.2}, NonLocalMeans{21, 3, false, 1, 0.6},
                                        NonLocalMeans{11, 11, true, 40, 60}, NonLocalMeans{9, 7, false, 0, 3}}) {
        const PatchScale scale(filter);
        Random random(7);
        PatchRow r{};
        r.length = 7, r.count = filter.search, r.neighbourhood = filter.neighbourhood;
        r.column_stride = r.columns() + lanes, r.weight_stride = r.length * lanes;
        const std::int64_t row = (r.length + r.neighbourhood + r.count) * lanes;
        std::vector<std::int16_t> levels(static_cast<std::size_t>(4 * row)), sums(static_cast<std::size_t>(2 * row));
        for (auto& v : levels) v = scale.scaled[random.bits() & 255U];
        for (auto& v : sums) v = static_cast<std::int16_t>((random.bits() & 255U) << 7);
        r.p_new = &levels[0], r.p_old = r.p_new + row, r.ps_new = r.p_new + 2 * row, r.ps_old = r.p_new + 3 * row;
        struct State {
            std::vector<std::uint16_t> column, old, band, weight;
            std::vector<std::int32_t> sums;
        } a;
        for (auto* v : {&a.column, &a.old, &a.band})
            for (std::int64_t i = 0; i < r.count * r.column_stride; ++i)
                v->push_back(static_cast<std::uint16_t>(random.bits()));
        a.weight.resize(static_cast<std::size_t>(r.count * r.weight_stride));
        const std::int64_t R = filter.search / 2;
        a.sums.assign(static_cast<std::size_t>((r.length + 2 * R) * sums_of_vector), 3);
        State b = a;
        const auto point = [&](State& s) {
            r.column = s.column.data(), r.column_old = s.old.data(), r.band = s.band.data(), r.weight = s.weight.data();
        };
        const auto rows = [&](State& s) {
            return WeightedRows{s.weight.data(), r.weight_stride, r.count, r.length, -R, sums.data() + R * lanes};
        };
        const auto to = [&](State& s) { return s.sums.data() + R * sums_of_vector; };
        for (const bool columns_done : {true, false}) {
            point(a);
            avx2::start_columns(r, scale, 2, row);
            avx2::weigh_row(r, scale, columns_done, true);
            avx2::add_here(rows(a), to(a));
            avx2::add_there(rows(a), to(a));
            point(b);
            plain::start_columns(r, scale, 2, row);
            plain::weigh_row(r, scale, columns_done, true);
            plain::add_here(rows(b), to(b));
            plain::add_there(rows(b), to(b));
            EXPECT_EQ(a.column, b.column);
            EXPECT_EQ(a.band, b.band);
            EXPECT_EQ(a.weight, b.weight);
            EXPECT_EQ(a.sums, b.sums);
        }
    }
}

}  // namespace
}  // namespace craze::images
