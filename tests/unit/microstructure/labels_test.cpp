#include "craze/microstructure/labels.hpp"

#include "craze/core/parallel.hpp"
#include "support/random_masks.hpp"

#include <gtest/gtest.h>

#include <array>

namespace craze::microstructure {
namespace {

// Flood fill in the order of memory.
Volume<std::int32_t> twin(const Mask& mask, int most_axes, std::int32_t& count)
{
    const Shape& s = mask.shape();
    Volume<std::int32_t> label(s, 0);
    count = 0;
    std::vector<std::array<std::int64_t, 3>> stack;
    for (std::int64_t z = 0; z < s.nz; ++z)
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x) {
                if (!mask(x, y, z) || label(x, y, z) != 0) continue;
                label(x, y, z) = ++count;
                stack.push_back({x, y, z});
                while (!stack.empty()) {
                    const auto [a, b, c] = stack.back();
                    stack.pop_back();
                    for (std::int64_t k = -1; k <= 1; ++k)
                        for (std::int64_t j = -1; j <= 1; ++j)
                            for (std::int64_t i = -1; i <= 1; ++i) {
                                if (i * i + j * j + k * k > most_axes) continue;
                                const std::int64_t u = a + i, v = b + j, w = c + k;
                                if (u < 0 || v < 0 || w < 0 || u >= s.nx || v >= s.ny || w >= s.nz) continue;
                                if (!mask(u, v, w) || label(u, v, w) != 0) continue;
                                label(u, v, w) = count;
                                stack.push_back({u, v, w});
                            }
                }
            }
    return label;
}

TEST(Components, AreThoseOfAFloodFillOnAnyThreads)
{
    const std::pair<Connectivity, int> kinds[] = {
        {Connectivity::corners, 3}, {Connectivity::edges, 2}, {Connectivity::faces, 1}};
    std::uint64_t seed = 7;
    for (const Shape shape :
         {Shape{130, 9, 8}, Shape{64, 12, 10}, Shape{1, 30, 30}, Shape{200, 1, 1}, Shape{17, 15, 40}})
        for (const double share : {0.05, 0.12, 0.2, 0.35, 0.7}) {
            const Mask mask = support::random_mask(shape, share, ++seed);
            for (const auto& [connectivity, axes] : kinds) {
                std::int32_t count = 0;
                const auto expected = twin(mask, axes, count);
                for (const int threads : {1, 3}) {
                    set_threads(threads);
                    const Components c = components(mask, connectivity);
                    EXPECT_EQ(c.count, count);
                    const auto labels = painted(c);
                    EXPECT_TRUE(std::equal(labels.values().begin(), labels.values().end(), expected.values().begin()));
                    EXPECT_EQ(selected(c, std::vector<std::uint8_t>(static_cast<std::size_t>(count), 1)), mask);
                }
            }
        }
    set_threads(0);
}

TEST(Components, OfNothingAndOfAllAreNoneAndOne)
{
    EXPECT_EQ(components(Mask({70, 5, 4})).count, 0);
    EXPECT_EQ(components(Mask()).count, 0);
    const Components all = components(complement(Mask({128, 5, 4})));
    EXPECT_EQ(all.count, 1);
    EXPECT_EQ(volumes(all), std::vector<std::int64_t>{128 * 5 * 4});
}

}  // namespace
}  // namespace craze::microstructure
