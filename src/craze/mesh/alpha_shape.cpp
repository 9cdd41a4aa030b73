#include "craze/mesh/alpha_shape.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/mesh/alpha_star.hpp"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <limits>
#include <memory>
#include <numeric>

namespace craze::mesh {

namespace {

using Word = Mask::Word;

// The place of each set voxel among all, in the order z, y, x.
class Ranks {
public:
    explicit Ranks(const Mask& mask) : mask_(mask)
    {
        const auto words = mask.words();
        before_.resize(words.size());
        std::int64_t sum = 0;
        for (std::size_t w = 0; w < words.size(); ++w) {
            before_[w] = static_cast<std::int32_t>(sum);
            sum += std::popcount(words[w]);
            if (sum > std::numeric_limits<std::int32_t>::max())
                throw InvalidInput(
                    "alpha shape: needs fewer than 2^31 points; cut the volume into blocks, or is the mask inverted?");
        }
        count_ = sum;
    }
    std::int64_t count() const { return count_; }
    std::int32_t of(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        const auto row = mask_.row(y, z);
        const Word below = (Word{1} << (x & 63)) - 1;
        const auto w = static_cast<std::size_t>(x >> 6);
        return before_[static_cast<std::size_t>(row.data() - mask_.words().data()) + w] +
               static_cast<std::int32_t>(std::popcount(row[w] & below));
    }

private:
    const Mask& mask_;
    std::vector<std::int32_t> before_;  // set voxels before each word
    std::int64_t count_ = 0;
};

template <class Visit>
void each_set(const Mask& mask, std::int64_t z, Visit&& visit)
{
    for (std::int64_t y = 0; y < mask.shape().ny; ++y) {
        const auto row = mask.row(y, z);
        for (std::size_t w = 0; w < row.size(); ++w)
            for (Word rest = row[w]; rest != 0; rest &= rest - 1)
                visit(static_cast<std::int64_t>(w) * 64 + std::countr_zero(rest), y);
    }
}

struct Layer {
    std::vector<std::array<std::int32_t, 3>> triangles;
    std::vector<std::uint8_t> sides;
};

void shape_of_layer(const Mask& points, const Ranks& ranks, const Neighbourhood& around, AlphaStar& star,
                    std::int64_t z, Layer& layer)
{
    std::vector<Word> occupied(around.words());
    each_set(points, z, [&](std::int64_t x, std::int64_t y) {
        around.gather(points, x, y, z, occupied);
        const std::int32_t p = ranks.of(x, y, z);
        const auto rank = [&](std::size_t corner) {
            const Offset& d = around[corner];
            return ranks.of(x + d.x, y + d.y, z + d.z);
        };
        for (const AlphaStar::Triangle& t : star.of(occupied)) {
            layer.triangles.push_back({p, rank(t.q), rank(t.r)});
            layer.sides.push_back(t.sides);
        }
    });
}

// Numbers the points that have a triangle, in order, and renumbers the triangles.
void number_vertices(const Mask& points, std::int64_t count, LatticeSurface& surface)
{
    std::vector<std::int32_t> number(static_cast<std::size_t>(count), 0);
    for (const auto& t : surface.triangles)
        for (const std::int32_t v : t) number[static_cast<std::size_t>(v)] = 1;
    surface.vertices.reserve(static_cast<std::size_t>(std::accumulate(number.begin(), number.end(), std::int64_t{0})));
    std::size_t rank = 0;
    for (std::int64_t z = 0; z < points.shape().nz; ++z)
        each_set(points, z, [&](std::int64_t x, std::int64_t y) {
            if (number[rank] != 0) {
                number[rank] = static_cast<std::int32_t>(surface.vertices.size());
                surface.vertices.push_back(
                    {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)});
            }
            ++rank;
        });
    parallel_ranges(static_cast<std::int64_t>(surface.triangles.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t t = begin; t < end; ++t)
            for (std::int32_t& v : surface.triangles[static_cast<std::size_t>(t)])
                v = number[static_cast<std::size_t>(v)];
    });
}

}  // namespace

LatticeSurface alpha_shape(const Mask& points, double alpha)
{
    assert(alpha >= 0.5 && alpha <= largest_alpha);
    const Neighbourhood around(alpha);
    const Ranks ranks(points);
    const std::int64_t nz = points.shape().nz;
    std::vector<Layer> layers(static_cast<std::size_t>(nz));
    std::vector<std::unique_ptr<AlphaStar>> stars(static_cast<std::size_t>(threads()));
    Progress progress("alpha shape", nz);
    parallel_tasks(nz, [&](std::int64_t z) {
        auto& star = stars[static_cast<std::size_t>(omp_get_thread_num())];
        if (!star) star = std::make_unique<AlphaStar>(around, alpha);
        shape_of_layer(points, ranks, around, *star, z, layers[static_cast<std::size_t>(z)]);
        progress.advance();
    });

    LatticeSurface surface;
    std::size_t total = 0;
    for (const Layer& layer : layers) total += layer.sides.size();
    surface.triangles.reserve(total);
    surface.sides.reserve(total);
    for (Layer& layer : layers) {
        surface.triangles.insert(surface.triangles.end(), layer.triangles.begin(), layer.triangles.end());
        surface.sides.insert(surface.sides.end(), layer.sides.begin(), layer.sides.end());
        layer = {};
    }
    number_vertices(points, ranks.count(), surface);
    return surface;
}

}  // namespace craze::mesh
