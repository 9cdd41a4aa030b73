#include "craze/domain/thickness.hpp"

#include "craze/core/index.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/voxel_walk.hpp"

#include <algorithm>
#include <cmath>

namespace craze::domain {

namespace {

struct Counter {
    const microstructure::Microstructure& micro;
    CountedVoid counted;
    CylinderVoxels found;

    void operator()(std::int64_t x, std::int64_t y, std::int64_t z)
    {
        ++found.total;
        const bool is_void = micro.crack(x, y, z) || (counted == CountedVoid::all && micro.pore(x, y, z));
        if (!is_void) return;
        ++found.black;
        const double share = static_cast<double>(micro.gray.level(x, y, z)) / micro.threshold;
        if (share < 1.0) found.darkness += 1.0 - share;
    }
};

}  // namespace

CylinderVoxels voxels_in_cylinder(const Vec3& a, const Vec3& b, double radius,
                                  const microstructure::Microstructure& micro, CountedVoid counted)
{
    const Shape& shape = micro.crack.shape();
    const double h = micro.gray.voxel_size, L = norm(b - a);
    const Vec3 t = (b - a) / L;
    Counter count{micro, counted, {}};
    // Centres on the surface are inside, whichever way they round.
    const double slack = 1e-9 * (L + radius), reach2 = (radius + slack) * (radius + slack);
    const auto inside = [&](const Vec3& from_a) {
        const double along = dot(from_a, t);
        return along >= -slack && along <= L + slack && dot(from_a, from_a) - along * along <= reach2;
    };
    // Bounds of the cylinder along y and z: its ends are discs of half width R sqrt(1 - t^2).
    std::int64_t first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double half = radius * std::sqrt(std::max(0.0, 1.0 - t[axis] * t[axis]));
        const double least = (std::min(a[axis], b[axis]) - half) / h - 0.5,
                     most = (std::max(a[axis], b[axis]) + half) / h - 0.5;
        first[axis] = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(least)) - 1);
        last[axis] = std::min(shape[axis] - 1, static_cast<std::int64_t>(std::floor(most)) + 1);
    }
    // In a row the cylinder is an interval of X = x - a.x: the quadratic |X|^2 - (X.t)^2 <= R^2 between two planes.
    const double square = 1.0 - t.x * t.x;
    for (std::int64_t z = first[2]; z <= last[2]; ++z)
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            const double wy = (static_cast<double>(y) + 0.5) * h - a.y, wz = (static_cast<double>(z) + 0.5) * h - a.z;
            const double k = t.y * wy + t.z * wz;
            double least = static_cast<double>(first[0]) * h - a.x,
                   most = (static_cast<double>(last[0]) + 1.0) * h - a.x;
            if (square > 1e-9) {
                const double middle = t.x * k / square;
                const double root = middle * middle - (wy * wy + wz * wz - k * k - radius * radius) / square;
                if (root < -1e-9 * radius * radius / square) continue;
                const double half = std::sqrt(std::max(0.0, root));
                least = std::max(least, middle - half);
                most = std::min(most, middle + half);
            }
            if (std::abs(t.x) > 1e-9) {
                const double at_a = -k / t.x, at_b = (L - k) / t.x;
                least = std::max(least, std::min(at_a, at_b));
                most = std::min(most, std::max(at_a, at_b));
            }
            // One voxel more at both ends, then trimmed by the definition: rounding decides nothing.
            auto x = std::max(first[0], static_cast<std::int64_t>(std::ceil((a.x + least) / h - 0.5)) - 1);
            auto x_last = std::min(last[0], static_cast<std::int64_t>(std::floor((a.x + most) / h - 0.5)) + 1);
            const auto from_a = [&](std::int64_t voxel) {
                return Vec3{(static_cast<double>(voxel) + 0.5) * h - a.x, wy, wz};
            };
            while (x <= x_last && !inside(from_a(x))) ++x;
            while (x_last >= x && !inside(from_a(x_last))) --x_last;
            for (; x <= x_last; ++x) count(x, y, z);
        }
    if (count.found.total == 0) walk_voxels(a, b, h, shape, count);
    return count.found;
}

double binary_thickness(const CylinderVoxels& voxels, double L_0)
{
    return voxels.total == 0 ? 0.0 : L_0 * static_cast<double>(voxels.black) / static_cast<double>(voxels.total);
}

double intensity_thickness(const CylinderVoxels& voxels, double L_0)
{
    return voxels.total == 0 ? 0.0 : L_0 * voxels.darkness / static_cast<double>(voxels.total);
}

void measure_thickness(PairCracks& cracks, const Elements& elements, std::span<const std::int32_t> i,
                       std::span<const std::int32_t> j, double R_B, const microstructure::Microstructure& micro,
                       CountedVoid counted)
{
    cracks.T1.assign(i.size(), 0.0);
    cracks.T2.assign(i.size(), 0.0);
    constexpr std::int64_t block = 1024;
    const auto pairs = static_cast<std::int64_t>(i.size());
    parallel_tasks((pairs + block - 1) / block, [&](std::int64_t task) {
        for (std::int64_t p = task * block; p < std::min(pairs, (task + 1) * block); ++p) {
            if (cracks.cut[at(p)] == 0) continue;
            const Vec3 a = elements.centre(i[at(p)]), b = elements.centre(j[at(p)]);
            const CylinderVoxels voxels = voxels_in_cylinder(a, b, R_B, micro, counted);
            cracks.T1[at(p)] = binary_thickness(voxels, norm(b - a));
            cracks.T2[at(p)] = intensity_thickness(voxels, norm(b - a));
        }
    });
}

}  // namespace craze::domain
