#include "craze/core/random.hpp"
#include "craze/images/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::images {
namespace {

// Pairs of up to four slices apart that know the positions to `error`.
std::vector<PairShift> pairs_of(const std::vector<Shift>& at, double error, std::uint64_t seed)
{
    Random random(seed);
    std::vector<PairShift> pairs;
    for (std::int64_t b = 1; b < std::ssize(at); ++b)
        for (std::int64_t a = std::max<std::int64_t>(0, b - 4); a < b; ++a) {
            const Shift &p = at[static_cast<std::size_t>(a)], &q = at[static_cast<std::size_t>(b)];
            pairs.push_back({a, b, {q.x - p.x + error * random.normal(), q.y - p.y + error * random.normal()}, 1.0});
        }
    return pairs;
}

double rms(const std::vector<Shift>& a)
{
    double sum = 0.0;
    for (const Shift& s : a) sum += s.x * s.x + s.y * s.y;
    return std::sqrt(sum / (2.0 * static_cast<double>(a.size())));
}

TEST(Positions, SlicesThatJumpAreFoundThoughSomePairsLie)
{
    Random random(3);
    std::vector<Shift> at(60);
    for (Shift& s : at) s = {random.normal(), random.normal()};
    auto pairs = pairs_of(at, 0.05, 4);
    for (std::size_t p = 7; p < pairs.size(); p += 11) pairs[p].by = {9.0, -7.0};
    const Positions found = solve_positions(60, pairs);
    EXPECT_GT(found.bad_pairs, 15);
    for (std::size_t i = 0; i < at.size(); ++i) {
        EXPECT_NEAR(found.at[i].x, at[i].x - at[0].x, 0.25);
        EXPECT_NEAR(found.at[i].y, at[i].y - at[0].y, 0.25);
    }
}

TEST(Corrections, UndoJitterAndLeaveASlopeAndASlowBend)
{
    Random random(5);
    std::vector<Shift> jitter(200), at(200);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double k = static_cast<double>(i);
        jitter[i] = {random.normal(), random.normal()};
        at[i] = {jitter[i].x + 0.4 * k, jitter[i].y + 6.0 * std::sin(k / 60.0)};
    }
    const auto corrected = corrections(solve_positions(200, pairs_of(at, 0.02, 6)), {});
    std::vector<Shift> left(200);
    for (std::size_t i = 0; i < at.size(); ++i) left[i] = {jitter[i].x - corrected[i].x, jitter[i].y - corrected[i].y};
    EXPECT_LT(rms(left), 0.35 * rms(jitter));
    EXPECT_NEAR(rms(corrected), rms(jitter), 0.2);
}

TEST(Corrections, UndoAJumpWhole)
{
    std::vector<Shift> at(100);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = {0.1 * static_cast<double>(i) + (i >= 40 ? 8.0 : 0.0), 0.0};
    const auto corrected = corrections(solve_positions(100, pairs_of(at, 0.02, 8)), {});
    EXPECT_NEAR(corrected[80].x - corrected[20].x, 8.0, 0.2);
    EXPECT_NEAR(corrected[80].y - corrected[20].y, 0.0, 0.2);
}

TEST(Corrections, OfAWalkOfTheSpecimenAreNone)
{
    // Steps that are alike from slice to slice, as where cracks lean one way for a while.
    Random random(9);
    std::vector<Shift> at(200);
    Shift pace;
    for (std::size_t i = 1; i < at.size(); ++i) {
        pace = {0.9 * pace.x + 0.1 * random.normal(), 0.9 * pace.y + 0.1 * random.normal()};
        at[i] = {at[i - 1].x + pace.x, at[i - 1].y + pace.y};
    }
    EXPECT_GT(rms(at), 1.0);
    EXPECT_LT(rms(corrections(solve_positions(200, pairs_of(at, 0.02, 10)), {})), 0.1);
}

TEST(Corrections, OfSlicesThatLeanSmoothlyAreNone)
{
    std::vector<Shift> at(150);
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = {0.5 * static_cast<double>(i), -0.2 * static_cast<double>(i)};
    for (const Shift& s : corrections(solve_positions(150, pairs_of(at, 0.0, 1)), {})) {
        EXPECT_EQ(s.x, 0.0);
        EXPECT_EQ(s.y, 0.0);
    }
    Alignment all;
    all.remove_drift = true;
    EXPECT_NEAR(corrections(solve_positions(150, pairs_of(at, 0.0, 1)), all)[149].x, 0.5 * 74.5, 1e-6);
}

}  // namespace
}  // namespace craze::images
