#include "craze/microstructure/thickness.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/morphology.hpp"
#include "craze/microstructure/threshold.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace craze::microstructure {

namespace {

// Least squared distance of each level, ascending; element 0 is no level.
std::vector<std::int32_t> levels_up_to(std::int32_t most, double step)
{
    std::vector<std::int32_t> least{0};
    if (most == 0) return least;
    step = std::max(step, std::sqrt(static_cast<double>(most)) / 250);
    for (double r = 1.0;; r += step) {
        const auto squared = static_cast<std::int32_t>(std::ceil(r * r - 1e-9));
        if (squared > most) break;
        if (squared > least.back()) least.push_back(squared);
    }
    return least;
}

Volume<std::uint8_t> quantised(const Volume<std::int32_t>& squared, const std::vector<std::int32_t>& least)
{
    std::vector<std::uint8_t> of(static_cast<std::size_t>(least.back()) + 1);
    for (std::size_t level = 0, d = 0; d < of.size(); ++d) {
        while (level + 1 < least.size() && static_cast<std::size_t>(least[level + 1]) <= d) ++level;
        of[d] = static_cast<std::uint8_t>(level);
    }
    Volume<std::uint8_t> out(squared.shape());
    const std::int32_t most = least.back();
    parallel_ranges(squared.shape().voxels(), [&](std::int64_t begin, std::int64_t end) {
        const std::int32_t* from = squared.data();
        for (std::int64_t i = begin; i < end; ++i)
            out.data()[i] = from[i] == 0 ? 0 : of[static_cast<std::size_t>(std::min(from[i], most))];
    });
    return out;
}

}  // namespace

Thickness local_thickness(const Volume<std::int32_t>& squared, double step)
{
    if (!(step >= 0.25))
        throw InvalidInput(fmt::format("local thickness: needs a step of 0.25 px or more, got {}", step));
    std::int32_t most = 0;
    for (const std::int32_t d : squared.values()) most = std::max(most, d);
    if (most >= no_distance)
        throw InvalidInput("local thickness: the set fills the volume, its thickness has no bound");
    const auto least = levels_up_to(most, step);
    const Volume<std::uint8_t> depth = quantised(squared, least);
    Thickness t;
    for (const std::int32_t d : least)
        t.diameter.push_back(d == 0 ? 0.0 : 2.0 * std::sqrt(static_cast<double>(d)) - 1.0);
    t.level = Volume<std::uint8_t>(squared.shape(), 0);
    const Shape& s = squared.shape();
    Mask left = matter_of(depth, 1);
    Progress progress("local thickness", static_cast<std::int64_t>(least.size()));
    for (std::size_t level = least.size() - 1; level > 0; --level, progress.advance()) {
        // Open balls: a voxel at squared distance d from the outside holds all offsets nearer than that.
        Ball ball;
        ball.squared = least[level] - 1;
        const Mask centres = matter_of(depth, static_cast<int>(level));
        const Mask covered = intersection(dilated(centres, ball), left);
        parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t r = begin; r < end; ++r) {
                const auto bits = covered.row(r % s.ny, r / s.ny);
                const auto to = t.level.row(r % s.ny, r / s.ny);
                for (std::size_t w = 0; w < bits.size(); ++w)
                    for (Mask::Word word = bits[w]; word != 0; word &= word - 1)
                        to[w * 64 + static_cast<std::size_t>(std::countr_zero(word))] =
                            static_cast<std::uint8_t>(level);
            }
        });
        left = difference(left, covered);
    }
    return t;
}

std::vector<std::int64_t> thickness_histogram(const Thickness& t, const Mask& part)
{
    const Shape& s = part.shape();
    std::vector<std::vector<std::int64_t>> slices(static_cast<std::size_t>(s.nz),
                                                  std::vector<std::int64_t>(t.diameter.size(), 0));
    parallel_tasks(s.nz, [&](std::int64_t z) {
        auto& count = slices[static_cast<std::size_t>(z)];
        for (std::int64_t y = 0; y < s.ny; ++y) {
            const auto bits = part.row(y, z);
            const auto level = t.level.row(y, z);
            for (std::size_t w = 0; w < bits.size(); ++w)
                for (Mask::Word word = bits[w]; word != 0; word &= word - 1)
                    ++count[level[w * 64 + static_cast<std::size_t>(std::countr_zero(word))]];
        }
    });
    std::vector<std::int64_t> total(t.diameter.size(), 0);
    for (const auto& slice : slices)
        std::transform(slice.begin(), slice.end(), total.begin(), total.begin(), std::plus<>());
    return total;
}

std::vector<double> mean_thickness(const Thickness& t, const Components& found)
{
    std::vector<double> sum(static_cast<std::size_t>(found.count), 0.0);
    std::vector<std::int64_t> voxels(sum.size(), 0);
    const Shape& s = found.shape;
    for (std::int64_t r = 0; r < s.ny * s.nz; ++r) {
        const auto level = t.level.row(r % s.ny, r / s.ny);
        for (auto i = found.row_begin[static_cast<std::size_t>(r)];
             i < found.row_begin[static_cast<std::size_t>(r) + 1]; ++i) {
            const Run& run = found.runs[static_cast<std::size_t>(i)];
            const auto label = static_cast<std::size_t>(run.label);
            voxels[label] += run.length();
            for (std::int32_t x = run.first; x <= run.last; ++x)
                sum[label] += t.diameter[level[static_cast<std::size_t>(x)]];
        }
    }
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] /= static_cast<double>(voxels[k]);
    return sum;
}

double thickness_quantile(const Thickness& t, const std::vector<std::int64_t>& histogram, double q)
{
    const std::int64_t all = std::accumulate(histogram.begin(), histogram.end(), std::int64_t{0});
    if (all == 0) return 0.0;
    std::int64_t below = 0;
    for (std::size_t level = 0; level < histogram.size(); ++level) {
        below += histogram[level];
        if (static_cast<double>(below) >= q * static_cast<double>(all)) return t.diameter[level];
    }
    return t.diameter.back();
}

}  // namespace craze::microstructure
