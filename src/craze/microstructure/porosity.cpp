#include "craze/microstructure/porosity.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace craze::microstructure {

namespace {

using Word = Mask::Word;

std::int64_t count_in(std::span<const Word> row, std::int64_t begin, std::int64_t end)
{
    std::int64_t n = 0;
    for (std::int64_t x = begin; x < end;) {
        const std::int64_t stop = std::min(end, (x | 63) + 1);
        Word word = row[static_cast<std::size_t>(x >> 6)] >> (x & 63);
        if (stop - x < 64) word &= (Word{1} << (stop - x)) - 1;
        n += std::popcount(word);
        x = stop;
    }
    return n;
}

// Voxels of the mask in each plane across x, y, z.
std::array<std::vector<std::int64_t>, 3> plane_counts(const Mask& mask)
{
    const Shape& s = mask.shape();
    std::vector<std::int64_t> rows(static_cast<std::size_t>(s.ny * s.nz));
    parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r)
            rows[static_cast<std::size_t>(r)] = count_in(mask.row(r % s.ny, r / s.ny), 0, s.nx);
    });
    std::array<std::vector<std::int64_t>, 3> counts;
    for (std::size_t axis = 0; axis < 3; ++axis)
        counts[axis].assign(static_cast<std::size_t>(s[static_cast<int>(axis)]), 0);
    for (std::int64_t r = 0; r < s.ny * s.nz; ++r) {
        counts[1][static_cast<std::size_t>(r % s.ny)] += rows[static_cast<std::size_t>(r)];
        counts[2][static_cast<std::size_t>(r / s.ny)] += rows[static_cast<std::size_t>(r)];
    }
    // Along x each thread takes words of its own.
    parallel_ranges(mask.words_per_row(), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = 0; r < s.ny * s.nz; ++r) {
            const auto row = mask.row(r % s.ny, r / s.ny);
            for (std::int64_t w = begin; w < end; ++w)
                for (Word word = row[static_cast<std::size_t>(w)]; word != 0; word &= word - 1)
                    ++counts[0][static_cast<std::size_t>(w * 64 + std::countr_zero(word))];
        }
    });
    return counts;
}

struct Spread {
    double sum = 0.0, squares = 0.0;
    void add(double value) { sum += value, squares += value * value; }
    double mean(double n) const { return sum / n; }
    double deviation(double n) const
    {
        return n < 2 ? 0.0 : std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1)));
    }
};

}  // namespace

double apparent_porosity(double rho, double rho_D)
{
    if (!(rho > 0.0 && rho <= rho_D))
        throw InvalidInput(fmt::format(
            "porosity: needs 0 < density <= density of the dense material, got {} and {} kg/m3", rho, rho_D));
    return 1.0 - rho / rho_D;
}

double porosity(const Mask& void_mask)
{
    return void_mask.empty() ? 0.0
                             : static_cast<double>(void_mask.count()) / static_cast<double>(void_mask.shape().voxels());
}

Porosity porosity(const Microstructure& micro) { return {porosity(micro.pore), porosity(micro.crack)}; }

PorosityProfiles porosity_profiles(const Microstructure& micro)
{
    const Shape& s = micro.matter.shape();
    const auto pores = plane_counts(micro.pore), cracks = plane_counts(micro.crack);
    PorosityProfiles profiles;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t n = s[static_cast<int>(axis)];
        const double plane = static_cast<double>(s.voxels()) / static_cast<double>(std::max<std::int64_t>(n, 1));
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
            profiles.along[axis].push_back(
                {static_cast<double>(pores[axis][i]) / plane, static_cast<double>(cracks[axis][i]) / plane});
    }
    return profiles;
}

std::vector<Scatter> porosity_scatter(const Microstructure& micro)
{
    const Shape& s = micro.matter.shape();
    std::vector<Scatter> all;
    for (std::int64_t edge = 16;; edge *= 2) {
        const std::int64_t mx = s.nx / edge, my = s.ny / edge, mz = s.nz / edge, cubes = mx * my * mz;
        if (cubes < 2) break;
        const std::int64_t x0 = (s.nx - mx * edge) / 2, y0 = (s.ny - my * edge) / 2, z0 = (s.nz - mz * edge) / 2;
        std::vector<Porosity> each(static_cast<std::size_t>(cubes));
        parallel_tasks(my * mz, [&](std::int64_t task) {
            const std::int64_t cy = task % my, cz = task / my;
            for (std::int64_t cx = 0; cx < mx; ++cx) {
                std::int64_t pores = 0, cracks = 0;
                for (std::int64_t z = z0 + cz * edge; z < z0 + (cz + 1) * edge; ++z)
                    for (std::int64_t y = y0 + cy * edge; y < y0 + (cy + 1) * edge; ++y) {
                        pores += count_in(micro.pore.row(y, z), x0 + cx * edge, x0 + (cx + 1) * edge);
                        cracks += count_in(micro.crack.row(y, z), x0 + cx * edge, x0 + (cx + 1) * edge);
                    }
                const auto volume = static_cast<double>(edge * edge * edge);
                each[static_cast<std::size_t>(cx + mx * task)] = {static_cast<double>(pores) / volume,
                                                                  static_cast<double>(cracks) / volume};
            }
        });
        Spread pores, cracks, total;
        for (const Porosity& p : each) pores.add(p.pores), cracks.add(p.cracks), total.add(p.total());
        const auto n = static_cast<double>(cubes);
        all.push_back({edge,
                       cubes,
                       {pores.mean(n), cracks.mean(n)},
                       pores.deviation(n),
                       cracks.deviation(n),
                       total.deviation(n)});
    }
    return all;
}

double representative_edge(const std::vector<Scatter>& scatter, double share)
{
    // Least squares of ln(deviation / mean) against ln(edge).
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Scatter& s : scatter) {
        if (s.cubes < 8 || !(s.total_deviation > 0.0)) continue;
        const double x = std::log(static_cast<double>(s.edge)), y = std::log(s.total_deviation / s.mean.total());
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    if (n < 2) return 0.0;
    const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    if (!(slope < 0.0)) return 0.0;
    return std::exp((std::log(share) - (sy - slope * sx) / n) / slope);
}

}  // namespace craze::microstructure
