#include "craze/microstructure/threshold.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace craze::microstructure {
namespace {

// Two normal modes, as counts.
Histogram two_modes(double n0, double mean0, double sigma0, double n1, double mean1, double sigma1)
{
    Histogram h{};
    for (int i = 0; i < 256; ++i) {
        const double a = (i - mean0) / sigma0, b = (i - mean1) / sigma1;
        h[static_cast<std::size_t>(i)] =
            std::llround(n0 / sigma0 * std::exp(-a * a / 2) + n1 / sigma1 * std::exp(-b * b / 2));
    }
    return h;
}

// The definitions, term by term.
int otsu_twin(const Histogram& h)
{
    double best = -1;
    int S = 0;
    for (int t = 0; t < 255; ++t) {
        double n0 = 0, n1 = 0, m0 = 0, m1 = 0;
        for (int i = 0; i < 256; ++i) {
            const auto n = static_cast<double>(h[static_cast<std::size_t>(i)]);
            (i <= t ? n0 : n1) += n;
            (i <= t ? m0 : m1) += n * i;
        }
        if (n0 == 0 || n1 == 0) continue;
        const double between = n0 * n1 * std::pow(m0 / n0 - m1 / n1, 2);
        if (between >= best) best = between, S = t + 1;
    }
    return S;
}

int entropy_twin(const Histogram& h)
{
    double best = -1;
    int S = 0;
    for (int t = 0; t < 255; ++t) {
        double n0 = 0, n1 = 0, sum = 0;
        for (int i = 0; i < 256; ++i) (i <= t ? n0 : n1) += static_cast<double>(h[static_cast<std::size_t>(i)]);
        if (n0 == 0 || n1 == 0) continue;
        for (int i = 0; i < 256; ++i) {
            const double p = static_cast<double>(h[static_cast<std::size_t>(i)]) / (i <= t ? n0 : n1);
            if (p > 0) sum -= p * std::log(p);
        }
        if (sum > best * (1 + 1e-14)) best = sum, S = t + 1;
    }
    return S;
}

double moment(const Histogram& h, int k);

// Two levels are told by the skewness g of what they keep: p0 - p1 = g / sqrt(4 + g^2).
std::optional<int> moments_twin(const Histogram& h)
{
    const double m = moment(h, 1), variance = moment(h, 2) - m * m;
    double n = 0, third = 0, cumulative = 0;
    for (int i = 0; i < 256; ++i) {
        n += static_cast<double>(h[static_cast<std::size_t>(i)]);
        third += static_cast<double>(h[static_cast<std::size_t>(i)]) * std::pow(i - m, 3);
    }
    const double g = third / n / std::pow(variance, 1.5), p0 = 0.5 + 0.5 * g / std::sqrt(4 + g * g);
    for (int t = 0; t < 255; ++t) {
        cumulative += static_cast<double>(h[static_cast<std::size_t>(t)]) / n;
        if (std::abs(cumulative - p0) < 1e-9) return std::nullopt;  // rounding decides
        if (cumulative > p0) return t + 1;
    }
    return 255;
}

double moment(const Histogram& h, int k)
{
    double n = 0, m = 0;
    for (int i = 0; i < 256; ++i) {
        n += static_cast<double>(h[static_cast<std::size_t>(i)]);
        m += static_cast<double>(h[static_cast<std::size_t>(i)]) * std::pow(i, k);
    }
    return m / n;
}

TEST(Threshold, OfManyHistogramsIsTheDefinitionTermByTerm)
{
    Random random(5);
    for (int trial = 0; trial < 200; ++trial) {
        Histogram h{};
        const std::int64_t levels = 2 + random.below(trial % 2 == 0 ? 254 : 6);
        for (std::int64_t i = 0; i < levels; ++i)
            h[static_cast<std::size_t>(random.below(256))] += 1 + random.below(900);
        if (moment(h, 2) - std::pow(moment(h, 1), 2) < 1e-9) continue;
        EXPECT_EQ(otsu_threshold(h).value(), otsu_twin(h)) << trial;
        EXPECT_EQ(entropy_threshold(h).value(), entropy_twin(h)) << trial;
        const auto S = moments_twin(h);
        EXPECT_EQ(moments_threshold(h).value(), S.value_or(moments_threshold(h).value())) << trial;
    }
}

TEST(MomentPreserving, TwoLevelsHaveTheMomentsOfTheImage)
{
    const Histogram h = two_modes(1000, 60, 12, 9000, 165, 15);
    const auto two = preserving_moments(h).value();
    for (int k = 1; k <= 3; ++k)
        EXPECT_NEAR((two.p0 * std::pow(two.z0, k) + (1 - two.p0) * std::pow(two.z1, k)) / moment(h, k), 1, 1e-12) << k;
    EXPECT_EQ(moments_threshold(h).value(), moments_twin(h).value());
}

TEST(Threshold, OfTwoLevelsPartsThem)
{
    for (const auto& [low, high] : {std::pair{0, 255}, {45, 165}, {7, 8}}) {
        Histogram h{};
        h[static_cast<std::size_t>(low)] = 883;
        h[static_cast<std::size_t>(high)] = 9117;
        for (const auto S : {moments_threshold(h), otsu_threshold(h), entropy_threshold(h)}) {
            EXPECT_GT(S.value(), low);
            EXPECT_LE(S.value(), high);
        }
    }
}

TEST(Threshold, OfOneLevelIsNone)
{
    Histogram h{};
    EXPECT_FALSE(moments_threshold(h) || otsu_threshold(h) || entropy_threshold(h));
    h[99] = 1000;
    EXPECT_FALSE(moments_threshold(h) || otsu_threshold(h) || entropy_threshold(h));
}

TEST(Histogram, AndMatterCountEveryVoxelOnAnyThreads)
{
    Volume<std::uint8_t> gray({131, 17, 9});
    Random random(3);
    Histogram count{};
    for (auto& g : gray.values()) {
        g = static_cast<std::uint8_t>(random.below(256));
        ++count[g];
    }
    for (const int threads : {1, 2}) {
        set_threads(threads);
        EXPECT_EQ(histogram(gray), count);
        for (const int S : {1, 100, 255}) {
            const Mask matter = matter_of(gray, S);
            for (std::int64_t z = 0; z < 9; ++z)
                for (std::int64_t y = 0; y < 17; ++y)
                    for (std::int64_t x = 0; x < 131; ++x) ASSERT_EQ(matter(x, y, z), gray(x, y, z) >= S);
        }
    }
    set_threads(0);
}

}  // namespace
}  // namespace craze::microstructure
