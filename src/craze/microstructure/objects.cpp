#include "craze/microstructure/objects.hpp"

#include <Eigen/Eigenvalues>

#include <bit>
#include <cmath>
#include <numbers>

namespace craze::microstructure {

namespace {

using Word = Mask::Word;

// Shares of the half sphere nearest to each of the 13 directions, by number of axes moved along, over their length.
const std::array<double, 4> direction_weight{0.0, 2 * 0.04577789120476, 2 * 0.03698062787608 / std::numbers::sqrt2,
                                             2 * 0.03519563978232 / std::numbers::sqrt3};

struct Sums {
    std::int64_t n = 0, x = 0, y = 0, z = 0, xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
    std::array<std::int64_t, 4> faces{};  // ways out, by number of axes moved along
    std::int32_t squared = 0;
};

std::int64_t ones(std::span<const Word> row, std::int64_t first, std::int64_t last)
{
    const auto a = static_cast<std::size_t>(first >> 6), b = static_cast<std::size_t>(last >> 6);
    const Word head = ~Word{0} << (first & 63), foot = ~Word{0} >> (63 - (last & 63));
    if (a == b) return std::popcount(row[a] & head & foot);
    std::int64_t n = std::popcount(row[a] & head) + std::popcount(row[b] & foot);
    for (std::size_t w = a + 1; w < b; ++w) n += std::popcount(row[w]);
    return n;
}

// Steps out of the set from the voxels of a run, over its 26 neighbours inside the volume.
void count_ways_out(const Mask& mask, const Run& run, std::int64_t y, std::int64_t z,
                    std::array<std::int64_t, 4>& faces)
{
    const Shape& s = mask.shape();
    const std::int64_t a = run.first, b = run.last;
    faces[1] += (a > 0 ? 1 : 0) + (b + 1 < s.nx ? 1 : 0);
    for (std::int64_t dz = -1; dz <= 1; ++dz)
        for (std::int64_t dy = -1; dy <= 1; ++dy) {
            if ((dy == 0 && dz == 0) || y + dy < 0 || z + dz < 0 || y + dy >= s.ny || z + dz >= s.nz) continue;
            const auto row = mask.row(y + dy, z + dz);
            const auto bit = [row](std::int64_t x) {
                return static_cast<std::int64_t>((row[static_cast<std::size_t>(x >> 6)] >> (x & 63)) & 1U);
            };
            const std::int64_t in = ones(row, a, b);
            const std::size_t axes = (dy != 0 ? 1U : 0U) + (dz != 0 ? 1U : 0U);
            faces[axes] += run.length() - in;
            // One step to the right: the first voxel leaves the range, the one behind the last enters it.
            const std::int64_t right = b + 1 < s.nx ? 1 - bit(b + 1) : 0, left = a > 0 ? 1 - bit(a - 1) : 0;
            faces[axes + 1] += run.length() - in - (1 - bit(a)) + right;
            faces[axes + 1] += run.length() - in - (1 - bit(b)) + left;
        }
}

void add_run(Sums& s, const Run& run, std::int64_t y, std::int64_t z)
{
    const std::int64_t a = run.first, b = run.last, n = run.length();
    const std::int64_t x = (a + b) * n / 2;
    const auto squares = [](std::int64_t k) { return k * (k + 1) * (2 * k + 1) / 6; };
    s.n += n, s.x += x, s.y += n * y, s.z += n * z;
    s.xx += squares(b) - (a > 0 ? squares(a - 1) : 0);
    s.yy += n * y * y, s.zz += n * z * z;
    s.xy += x * y, s.xz += x * z, s.yz += n * y * z;
}

Vec3 upward(const Eigen::Vector3d& v)
{
    const double sign = v.z() < 0 || (v.z() == 0 && (v.y() < 0 || (v.y() == 0 && v.x() < 0))) ? -1.0 : 1.0;
    return {sign * v.x(), sign * v.y(), sign * v.z()};
}

void set_shape(Object& object, const Sums& s)
{
    const auto n = static_cast<double>(s.n);
    const double x = static_cast<double>(s.x) / n, y = static_cast<double>(s.y) / n, z = static_cast<double>(s.z) / n;
    object.centroid = {x + 0.5, y + 0.5, z + 0.5};
    const auto moment = [n](std::int64_t sum, double u, double v) { return static_cast<double>(sum) / n - u * v; };
    // A voxel is a cube, not a point: + 1/12.
    Eigen::Matrix3d m;
    m << moment(s.xx, x, x) + 1.0 / 12, moment(s.xy, x, y), moment(s.xz, x, z),  //
        moment(s.xy, x, y), moment(s.yy, y, y) + 1.0 / 12, moment(s.yz, y, z),   //
        moment(s.xz, x, z), moment(s.yz, y, z), moment(s.zz, z, z) + 1.0 / 12;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(m);
    for (int k = 0; k < 3; ++k)
        object.semi_axes[static_cast<std::size_t>(k)] = std::sqrt(5.0 * std::max(0.0, axes.eigenvalues()[2 - k]));
    object.major = upward(axes.eigenvectors().col(2));
    object.minor = upward(axes.eigenvectors().col(0));
}

}  // namespace

std::vector<Object> measured(const Mask& mask, const Components& found, const Volume<std::int32_t>& squared)
{
    const Shape& s = mask.shape();
    std::vector<Object> objects(static_cast<std::size_t>(found.count));
    std::vector<Sums> sums(objects.size());
    for (std::int64_t r = 0; r < s.ny * s.nz; ++r) {
        const std::int64_t y = r % s.ny, z = r / s.ny;
        for (auto i = found.row_begin[static_cast<std::size_t>(r)];
             i < found.row_begin[static_cast<std::size_t>(r) + 1]; ++i) {
            const Run& run = found.runs[static_cast<std::size_t>(i)];
            Sums& sum = sums[static_cast<std::size_t>(run.label)];
            auto& box = objects[static_cast<std::size_t>(run.label)].box;
            const auto iy = static_cast<std::int32_t>(y), iz = static_cast<std::int32_t>(z);
            if (sum.n == 0) box = {run.first, run.last, iy, iy, iz, iz};
            box = {std::min(box[0], run.first), std::max(box[1], run.last), std::min(box[2], iy),
                   std::max(box[3], iy),        std::min(box[4], iz),       std::max(box[5], iz)};
            add_run(sum, run, y, z);
            count_ways_out(mask, run, y, z, sum.faces);
            const auto row = squared.row(y, z);
            sum.squared = std::max(sum.squared, *std::max_element(row.begin() + run.first, row.begin() + run.last + 1));
        }
    }
    for (std::size_t k = 0; k < objects.size(); ++k) {
        Object& object = objects[k];
        object.volume = sums[k].n;
        // S = 4 x mean projected area; each line crosses the surface once per way out in either sense.
        for (std::size_t axes = 1; axes <= 3; ++axes)
            object.surface += 2.0 * direction_weight[axes] * static_cast<double>(sums[k].faces[axes]);
        const auto volume = static_cast<double>(object.volume);
        object.equivalent_radius = std::cbrt(volume * 3.0 / (4.0 * std::numbers::pi));
        if (object.surface > 0)
            object.sphericity =
                4.0 * std::numbers::pi * object.equivalent_radius * object.equivalent_radius / object.surface;
        object.inscribed_radius = std::sqrt(static_cast<double>(sums[k].squared));
        const auto& box = object.box;
        object.at_border =
            box[0] == 0 || box[2] == 0 || box[4] == 0 || box[1] + 1 == s.nx || box[3] + 1 == s.ny || box[5] + 1 == s.nz;
        set_shape(object, sums[k]);
    }
    return objects;
}

}  // namespace craze::microstructure
