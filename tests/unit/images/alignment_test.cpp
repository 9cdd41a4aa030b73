#include "craze/images/alignment.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/random.hpp"
#include "craze/io/volume_file.hpp"
#include "support/data.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::images {
namespace {

using Slice = std::vector<std::uint8_t>;

Slice shifted(std::span<const std::uint8_t> slice, std::int64_t nx, std::int64_t ny, Shift by)
{
    std::vector<float> moved(slice.size());
    shift_slice(slice, nx, ny, by, {0, nx, 0, ny}, moved);
    Slice to;
    for (const float v : moved) to.push_back(static_cast<std::uint8_t>(std::clamp(v + 0.5F, 0.0F, 255.0F)));
    return to;
}

// Soft discs scattered over a slice, the same for all z; one bright inclined rod of `slope` px per slice.
Slice discs(std::int64_t n, double slope, std::int64_t z)
{
    Slice slice(static_cast<std::size_t>(n * n));
    for (std::int64_t y = 0; y < n; ++y)
        for (std::int64_t x = 0; x < n; ++x) {
            double level = 60.0;
            for (std::uint64_t d = 0; d < 12; ++d) {
                Random random(7, d);
                const double cx =
                    random.uniform(10, static_cast<double>(n) - 10) + (d == 0 ? slope * static_cast<double>(z) : 0.0);
                const double cy = random.uniform(10, static_cast<double>(n) - 10), r = random.uniform(3, 7);
                level +=
                    120.0 / (1.0 + std::exp(std::hypot(static_cast<double>(x) - cx, static_cast<double>(y) - cy) - r));
            }
            Random noise(9, static_cast<std::uint64_t>(x + n * (y + n * z)));
            slice[static_cast<std::size_t>(x + n * y)] =
                static_cast<std::uint8_t>(std::clamp(level + 6.0 * noise.normal(), 0.0, 255.0));
        }
    return slice;
}

TEST(ShiftSlice, ByWholePixelsCopies)
{
    const Slice slice = discs(48, 0, 0);
    const Slice moved = shifted(slice, 48, 48, {3.0, -2.0});
    for (std::int64_t y = 2; y < 48; ++y)
        for (std::int64_t x = 0; x < 45; ++x)
            ASSERT_EQ(moved[static_cast<std::size_t>(x + 48 * y)],
                      slice[static_cast<std::size_t>(x + 3 + 48 * (y - 2))]);
}

TEST(Positions, AreThoseThatAllPairsAgreeOnWhateverABadSliceSays)
{
    const std::int64_t n = 40;
    std::vector<Shift> truth;
    Random random(3);
    for (std::int64_t i = 0; i < n; ++i)
        truth.push_back({random.uniform(-4, 4) + 0.2 * static_cast<double>(i), random.uniform(-4, 4)});
    std::vector<PairShift> pairs;
    for (std::int64_t b = 0; b < n; ++b)
        for (std::int64_t a = std::max<std::int64_t>(0, b - 4); a < b; ++a) {
            const Shift &p = truth[static_cast<std::size_t>(a)], &q = truth[static_cast<std::size_t>(b)];
            PairShift pair{a, b, {q.x - p.x, q.y - p.y}, 1.0};
            if (a == 20 || b == 20) pair.by = {random.uniform(-20, 20), random.uniform(-20, 20)};
            pairs.push_back(pair);
        }
    const Positions found = solve_positions(n, pairs);
    EXPECT_GE(found.bad_pairs, 6);
    for (std::int64_t i = 0; i < n; ++i) {
        if (i == 20) continue;
        const Shift &t = truth[static_cast<std::size_t>(i)], &f = found.at[static_cast<std::size_t>(i)];
        EXPECT_NEAR(f.x, t.x - truth[0].x, 0.02) << i;
        EXPECT_NEAR(f.y, t.y - truth[0].y, 0.02) << i;
    }
}

TEST(Alignment, TakesOutJitterAndKeepsAnInclinedRodInclined)
{
    const std::int64_t n = 96, slices = 80;
    const double slope = std::tan(15.0 * 3.14159265358979 / 180.0);
    Alignment how;
    ShiftMeter meter(n, n, how);
    Random random(5);
    std::vector<Shift> imposed;
    std::vector<Slice> stack;
    for (std::int64_t z = 0; z < slices; ++z) {
        imposed.push_back({random.uniform(-3, 3), random.uniform(-3, 3)});
        stack.push_back(shifted(discs(n, slope, z), n, n, imposed.back()));
    }
    const auto corrections_found = corrections(solve_positions(slices, meter.add(stack)), how);
    // aligned(x) = raw(x + c) and raw(x) = true(x + s): what is left is c + s, up to a constant.
    double sx = 0, sy = 0, sxx = 0, syy = 0, sxz = 0;
    for (std::int64_t z = 0; z < slices; ++z) {
        const double x = corrections_found[static_cast<std::size_t>(z)].x + imposed[static_cast<std::size_t>(z)].x,
                     y = corrections_found[static_cast<std::size_t>(z)].y + imposed[static_cast<std::size_t>(z)].y;
        sx += x / slices, sy += y / slices, sxx += x * x / slices, syy += y * y / slices;
        sxz += x * (static_cast<double>(z) - (slices - 1) / 2.0);
    }
    const double tilt = 12.0 * sxz / (slices * (slices * slices - 1.0));  // px per slice that alignment adds
    double imposed_tilt = 0.0;  // jitter has a trend of its own, kept by design
    for (std::int64_t z = 0; z < slices; ++z)
        imposed_tilt += 12.0 * imposed[static_cast<std::size_t>(z)].x * (static_cast<double>(z) - (slices - 1) / 2.0) /
                        (slices * (slices * slices - 1.0));
    const double before = std::atan(slope - imposed_tilt), after = std::atan(slope - tilt);
    EXPECT_LT(std::abs(after - before) * 180.0 / 3.14159265358979, 0.2);
    EXPECT_LT(std::sqrt(syy - sy * sy), 0.4);
    EXPECT_LT(std::sqrt(sxx - sx * sx), 0.4);
}

TEST(Transforms, AreReadBackAndRefusedWhenTheyDoNotFit)
{
    const support::TemporaryFolder folder;
    const std::vector<Shift> shifts{{0.25, -1.5}, {3.0, 0.0}};
    save_transforms(folder / "t.csv", shifts);
    const auto back = load_transforms(folder / "t.csv", 2);
    EXPECT_EQ(back[0].x, 0.25);
    EXPECT_EQ(back[1].x, 3.0);
    EXPECT_THROW(load_transforms(folder / "t.csv", 3), InvalidInput);
}

// Imposed shifts between real neighbours: what is measured, less what was measured before they were imposed.
TEST(Alignment, FindsShiftsImposedOnRealSlices)
{
    const auto path = support::data_folder() / "fib_sem" / "slices";
    CRAZE_NEEDS_DATA(path);
    const auto stack = io::read_volume<std::uint8_t>(path);
    const auto [nx, ny, nz] = stack.shape();
    Alignment how;
    how.neighbours = 1;
    double sum_x = 0, sum_y = 0, most = 0;
    std::int64_t pairs = 0;
    for (std::int64_t z = 0; z + 1 < nz; ++z, ++pairs) {
        Random random(11, static_cast<std::uint64_t>(z));
        const Shift by{random.uniform(-5, 5), random.uniform(-5, 5)};
        const Slice a(stack.slice(z).begin(), stack.slice(z).end()),
            b(stack.slice(z + 1).begin(), stack.slice(z + 1).end());
        ShiftMeter meter(nx, ny, how);
        const Shift plain = meter.add({a, b}).front().by;
        ShiftMeter again(nx, ny, how);
        const Shift moved = again.add({a, shifted(b, nx, ny, by)}).front().by;
        const double ex = moved.x - plain.x + by.x, ey = moved.y - plain.y + by.y;
        sum_x += ex * ex, sum_y += ey * ey;
        most = std::max({most, std::abs(ex), std::abs(ey)});
    }
    const auto n = static_cast<double>(pairs);
    RecordProperty("rms_x", std::to_string(std::sqrt(sum_x / n)));
    std::printf("imposed shifts: rms %.3f %.3f px, most %.3f px\n", std::sqrt(sum_x / n), std::sqrt(sum_y / n), most);
    EXPECT_LE(std::sqrt(sum_x / n), 0.15);
    EXPECT_LE(std::sqrt(sum_y / n), 0.15);
    EXPECT_LE(most, 0.5);
}

}  // namespace
}  // namespace craze::images
