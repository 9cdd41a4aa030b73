#include "craze/domain/voxel_size_study.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/quality.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::domain {

namespace {

/// T1 and T2 of the bonds that are cut.
void collect(const PairCracks& cracks, std::vector<double>& T1, std::vector<double>& T2)
{
    for (std::size_t b = 0; b < cracks.cut.size(); ++b) {
        if (cracks.cut[b] == 0) continue;
        T1.push_back(cracks.T1[b]);
        T2.push_back(cracks.T2[b]);
    }
}

}  // namespace

images::Gray coarsened(const images::Gray& gray, std::int64_t factor)
{
    const Shape& fine = gray.level.shape();
    const std::int64_t most = std::min({fine.nx, fine.ny, fine.nz});
    if (factor < 1 || factor > most)
        throw InvalidInput(fmt::format("voxel sizes: needs factors from 1 to {}, got {}", most, factor));
    const Shape shape{fine.nx / factor, fine.ny / factor, fine.nz / factor};
    images::Gray out{Volume<std::uint8_t>(shape), gray.voxel_size * static_cast<double>(factor)};
    const std::int64_t block = factor * factor * factor;
    parallel_tasks(shape.nz, [&](std::int64_t z) {
        std::vector<std::int64_t> sum(static_cast<std::size_t>(shape.nx));
        for (std::int64_t y = 0; y < shape.ny; ++y) {
            std::ranges::fill(sum, 0);
            for (std::int64_t c = z * factor; c < (z + 1) * factor; ++c)
                for (std::int64_t b = y * factor; b < (y + 1) * factor; ++b) {
                    const auto row = gray.level.row(b, c);
                    for (std::size_t a = 0, x = 0; x < sum.size(); ++x)
                        for (std::int64_t k = 0; k < factor; ++k, ++a) sum[x] += row[a];
                }
            const auto to = out.level.row(y, z);
            for (std::size_t x = 0; x < sum.size(); ++x)
                to[x] = static_cast<std::uint8_t>((sum[x] + block / 2) / block);
        }
    });
    return out;
}

std::vector<VoxelSizeResult> voxel_size_study(const Discretisation& d, const microstructure::Microstructure& micro,
                                              std::span<const std::int64_t> factors,
                                              const microstructure::Settings& classes, const mesh::Settings& sheets,
                                              const Settings& settings)
{
    std::vector<VoxelSizeResult> study(1);
    study[0].voxel_size = micro.gray.voxel_size, study[0].threshold = micro.threshold;
    collect(d.bonds, study[0].T1, study[0].T2);
    study[0].same_T1 = study[0].T1, study[0].same_T2 = study[0].T2;
    for (const std::int64_t factor : factors) {
        microstructure::Settings there = classes;
        there.R_C /= static_cast<double>(factor), there.R_E /= static_cast<double>(factor);
        const auto coarse = microstructure::classify(coarsened(micro.gray, factor), there);
        const auto surface = mesh::mesh_cracks(coarse.crack, coarse.gray.voxel_size, sheets);
        VoxelSizeResult result{coarse.gray.voxel_size, coarse.threshold, {}, {}, {}, {}};
        const Discretisation again = discretise(d.dense, coarse, surface, settings);
        collect(again.bonds, result.T1, result.T2);
        PairCracks same;
        same.cut = d.bonds.cut;
        measure_thickness(same, d.dense.elements, d.dense.bonds.i, d.dense.bonds.j,
                          settings.r_tilde * d.dense.mean_radius, coarse, settings.counted);
        collect(same, result.same_T1, result.same_T2);
        study.push_back(std::move(result));
    }
    return study;
}

Json as_json(const std::vector<VoxelSizeResult>& study)
{
    constexpr std::size_t bars = 100;
    double most = 0.0;
    for (const VoxelSizeResult& r : study) {
        std::vector<double> T1 = r.T1;
        std::ranges::sort(T1);
        if (!T1.empty()) most = std::max(most, T1[(995 * T1.size()) / 1000]);
    }
    const double bar = 4e-9 * std::max(1.0, std::ceil(most / (4e-9 * bars)));
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
        json.push_back({{"voxel_size_m", r.voxel_size},
                        {"threshold", r.threshold},
                        {"cut_bonds", r.T1.size()},
                        {"bar_m", bar},
                        {"T1", one(r.T1)},
                        {"T2", one(r.T2)},
                        {"same_bonds",
                         {{"T1_median_m", five_numbers(r.same_T1)[2]}, {"T2_median_m", five_numbers(r.same_T2)[2]}}}});
    return json;
}

void save(const std::vector<VoxelSizeResult>& study, const std::filesystem::path& folder)
{
    io::write_text(folder / "voxel_sizes.json", as_json(study).dump(1) + "\n");
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
