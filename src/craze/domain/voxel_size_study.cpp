#include "craze/domain/voxel_size_study.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::domain {

microstructure::Microstructure coarsened(const microstructure::Microstructure& micro, std::int64_t factor)
{
    const Shape& fine = micro.crack.shape();
    if (factor < 1 || factor > std::min({fine.nx, fine.ny, fine.nz}))
        throw InvalidInput(fmt::format("voxel size study: needs factors from 1 to {}, got {}",
                                       std::min({fine.nx, fine.ny, fine.nz}), factor));
    const Shape shape{fine.nx / factor, fine.ny / factor, fine.nz / factor};
    microstructure::Microstructure out;
    out.gray.level = Volume<std::uint8_t>(shape);
    out.gray.voxel_size = micro.gray.voxel_size * static_cast<double>(factor);
    out.threshold = micro.threshold;
    out.matter = Mask(shape), out.pore = Mask(shape), out.crack = Mask(shape);
    const std::int64_t block = factor * factor * factor;
    parallel_tasks(shape.nz, [&](std::int64_t z) {
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x) {
                std::int64_t sum = 0, pores = 0;
                for (std::int64_t c = z * factor; c < (z + 1) * factor; ++c)
                    for (std::int64_t b = y * factor; b < (y + 1) * factor; ++b)
                        for (std::int64_t a = x * factor; a < (x + 1) * factor; ++a) {
                            sum += micro.gray.level(a, b, c);
                            pores += micro.pore(a, b, c);
                        }
                const auto gray = static_cast<std::uint8_t>((sum + block / 2) / block);
                out.gray.level(x, y, z) = gray;
                const bool pore = 2 * pores >= block, crack = !pore && gray < out.threshold;
                out.pore.set(x, y, z, pore);
                out.crack.set(x, y, z, crack);
                out.matter.set(x, y, z, !pore && !crack);
            }
    });
    return out;
}

std::vector<VoxelSizeResult> voxel_size_study(const Discretisation& d, const microstructure::Microstructure& micro,
                                              std::span<const std::int64_t> factors, double r_tilde,
                                              CountedVoid counted)
{
    const Domain& dense = d.dense;
    std::vector<VoxelSizeResult> study;
    for (const std::int64_t factor : factors) {
        PairCracks cracks;
        cracks.cut = d.bonds.cut;
        const double R_B = r_tilde * dense.mean_radius;
        const auto measure = [&](const microstructure::Microstructure& at) {
            measure_thickness(cracks, dense.elements, dense.bonds.i, dense.bonds.j, R_B, at, counted);
        };
        if (factor == 1)
            measure(micro);
        else
            measure(coarsened(micro, factor));
        VoxelSizeResult result{micro.gray.voxel_size * static_cast<double>(factor), {}, {}};
        for (std::size_t b = 0; b < cracks.cut.size(); ++b) {
            if (cracks.cut[b] == 0) continue;
            result.T1.push_back(cracks.T1[b]);
            result.T2.push_back(cracks.T2[b]);
        }
        study.push_back(std::move(result));
    }
    return study;
}

Json as_json(const std::vector<VoxelSizeResult>& study)
{
    constexpr double bar = 4e-9;
    constexpr std::size_t bars = 100;
    const auto one = [&](const std::vector<double>& T) {
        std::vector<std::int64_t> counts(bars, 0);
        std::int64_t zero = 0;
        for (const double t : T) {
            zero += t == 0.0;
            if (t > 0.0) ++counts[std::min(bars - 1, static_cast<std::size_t>(t / bar))];
        }
        return Json{{"median_m", five_numbers(T)[2]}, {"zero", zero}, {"counts", counts}};
    };
    Json json = Json::array();
    for (const VoxelSizeResult& r : study)
        json.push_back({{"voxel_size_m", r.voxel_size}, {"bar_m", bar}, {"T1", one(r.T1)}, {"T2", one(r.T2)}});
    return json;
}

double expected_T2_of_slab(double T, double voxel_size, double matter, double empty, double threshold)
{
    const double share = T / voxel_size;
    if (!(share >= 0.0 && share <= 1.0))
        throw InvalidInput(fmt::format("slab: needs a thickness of at most one voxel, got {} voxels", share));
    // One voxel of which the share f is void adds g(f), nothing while it is brighter than S.
    const double slope = (matter - empty) / threshold, start = (matter - threshold) / (matter - empty);
    const auto g = [&](double f) { return std::max(0.0, slope * (f - start)); };
    // Within one voxel with probability 1 - share, else split between two with every share equally likely.
    const double above = std::max(0.0, share - std::max(start, 0.0));
    const double split = start > 0.0 ? 0.5 * slope * above * above : slope * share * (0.5 * share - start);
    return voxel_size * ((1.0 - share) * g(share) + 2.0 * split);
}

}  // namespace craze::domain
