#include "craze/domain/pores.hpp"

#include "craze/core/parallel.hpp"

#include <cmath>

namespace craze::domain {

std::vector<std::uint8_t> carve(const Elements& elements, const Mask& pore, double voxel_size)
{
    const Shape& shape = pore.shape();
    std::vector<std::uint8_t> in_pore(elements.r.size(), 0);
    parallel_ranges(elements.size(), [&](std::int64_t begin, std::int64_t end) {
        for (auto e = static_cast<std::size_t>(begin); e < static_cast<std::size_t>(end); ++e) {
            const double x = std::floor(elements.x[e] / voxel_size), y = std::floor(elements.y[e] / voxel_size),
                         z = std::floor(elements.z[e] / voxel_size);
            if (x >= 0.0 && y >= 0.0 && z >= 0.0 && x < static_cast<double>(shape.nx) &&
                y < static_cast<double>(shape.ny) && z < static_cast<double>(shape.nz))
                in_pore[e] =
                    pore(static_cast<std::int64_t>(x), static_cast<std::int64_t>(y), static_cast<std::int64_t>(z));
        }
    });
    return in_pore;
}

}  // namespace craze::domain
