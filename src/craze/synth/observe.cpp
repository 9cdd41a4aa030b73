#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/synth/synth.hpp"

#include <fmt/format.h>

namespace craze::synth {

namespace {

constexpr std::uint8_t label_pore = 0, label_crack = 128, label_matter = 255;

struct SliceSums {
    double pore = 0.0, crack = 0.0;
    std::int64_t pore_voxels = 0, crack_voxels = 0;
};

SliceSums label_slice(std::span<const float> pore, std::span<const float> crack, std::span<std::uint8_t> label)
{
    SliceSums sums;
    for (std::size_t i = 0; i < label.size(); ++i) {
        sums.pore += pore[i];
        sums.crack += crack[i];
        const bool is_void = pore[i] + crack[i] >= 0.5F;
        const bool is_crack = is_void && crack[i] > pore[i];
        sums.pore_voxels += is_void && !is_crack;
        sums.crack_voxels += is_crack;
        label[i] = is_crack ? label_crack : is_void ? label_pore : label_matter;
    }
    return sums;
}

}  // namespace

Observation observe(const Coating& coating, const Settings& settings)
{
    const Shape shape{settings.shape[0], settings.shape[1], settings.shape[2]};
    const auto seed = static_cast<std::uint64_t>(settings.seed);
    const double h = settings.voxel_size;
    const Microscope& microscope = settings.microscope;
    Observation seen{.stack = {Volume<std::uint8_t>(shape), h},
                     .label = Volume<std::uint8_t>(shape),
                     .fraction = {},
                     .voxels = {},
                     .positions = slice_positions(microscope, shape.nz, seed)};
    const bool steady = microscope.drift == 0.0 && microscope.thickness_jitter == 0.0;
    const auto per_slice = static_cast<std::size_t>(shape.nx * shape.ny);
    std::vector<SliceSums> sums(static_cast<std::size_t>(shape.nz));
    Progress progress("synth: imaging", shape.nz);
    constexpr std::int64_t batch = 16;  // slices between two looks at Ctrl-C
    for (std::int64_t start = 0; start < shape.nz; start += batch) {
        const std::int64_t count = std::min(batch, shape.nz - start);
        parallel_ranges(count, [&](std::int64_t begin, std::int64_t end) {
            std::vector<float> pore(per_slice), crack(per_slice), work(per_slice);
            for (std::int64_t z = start + begin; z < start + end; ++z) {
                const auto k = static_cast<std::size_t>(z);
                const auto grid_at = [&](const Vec3& voxel) {
                    return SliceGrid{
                        shape.nx, shape.ny, h, {(voxel.x + 0.5) * h, (voxel.y + 0.5) * h, (voxel.z + 0.5) * h}};
                };
                render_slice(coating, grid_at({0.0, 0.0, static_cast<double>(z)}), pore, crack);
                sums[k] = label_slice(pore, crack, seen.label.slice(z));
                if (!steady) render_slice(coating, grid_at(seen.positions[k]), pore, crack);
                for (std::size_t i = 0; i < per_slice; ++i) pore[i] += crack[i];
                record_slice(microscope, pore, shape.nx, shape.ny, z, shape.nz, seed, work, seen.stack.level.slice(z));
            }
        });
        progress.advance(count);
    }
    const auto voxels = static_cast<double>(shape.voxels());
    for (const auto& slice : sums) {
        seen.fraction.pores += slice.pore / voxels;
        seen.fraction.cracks += slice.crack / voxels;
        seen.voxels.pores += static_cast<double>(slice.pore_voxels) / voxels;
        seen.voxels.cracks += static_cast<double>(slice.crack_voxels) / voxels;
    }
    seen.fraction.total = seen.fraction.pores + seen.fraction.cracks;
    seen.voxels.total = seen.voxels.pores + seen.voxels.cracks;
    return seen;
}

}  // namespace craze::synth
