#include "craze/mesh/measures.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mesh/normals.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace craze::mesh {

namespace {

using std::numbers::pi;

Vec3 vec(const Direction& d) { return {d.x, d.y, d.z}; }

constexpr int steps_per_voxel = 4;
constexpr int counts_per_voxel = 3 * steps_per_voxel;  // an opening is the mean of three chords

// Chord of the crack through `from` along +-n: how many midpoints of quarter-voxel steps lie in crack voxels.
int chord(const Mask& crack, const Vec3& from, const Vec3& n, double h)
{
    constexpr double step = 1.0 / steps_per_voxel;
    constexpr int most = steps_per_voxel * 256;  // no crack gapes a quarter of a thousand voxels
    const Shape& s = crack.shape();
    int inside = 0;
    for (const double sign : {-1.0, 1.0})
        for (int k = 0; k < most; ++k) {
            const Vec3 p = from / h + (sign * step * (k + 0.5)) * n;
            const auto x = static_cast<std::int64_t>(std::floor(p.x)), y = static_cast<std::int64_t>(std::floor(p.y)),
                       z = static_cast<std::int64_t>(std::floor(p.z));
            if (x < 0 || y < 0 || z < 0 || x >= s.nx || y >= s.ny || z >= s.nz || !crack(x, y, z)) break;
            ++inside;
        }
    return inside;
}

// Chords through three points of a triangle, summed. Corners are voxel centres in the middle of the crack, where chords
// are rounded always the same way; points between are not.
int opening_at(const Mask& crack, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double h)
{
    constexpr double near = 0.6, far = 0.2;
    return (chord(crack, near * a + far * b + far * c, n, h) + chord(crack, far * a + near * b + far * c, n, h) +
            chord(crack, far * a + far * b + near * c, n, h));
}

// What each triangle is, once the staircases are smoothed.
struct Facets {
    std::vector<Direction> normal;      // unit
    std::vector<std::int32_t> opening;  // in counts: integers, so that classes and quantiles know no unit
    std::vector<double> area;           // m2, one face
};

double metres(std::int32_t counts, double h) { return counts * h / counts_per_voxel; }

Facets facets_of(const CrackSurface& surface, const Mask& crack, double h, const std::vector<Direction>& normals)
{
    const auto m = static_cast<std::int64_t>(surface.triangles.size());
    Facets facets;
    facets.normal.resize(surface.triangles.size());
    facets.opening.resize(surface.triangles.size());
    facets.area.resize(surface.triangles.size());
    parallel_ranges(m, [&](std::int64_t begin, std::int64_t end) {
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
            const auto& k = surface.triangles[t];
            const auto corner = [&](std::size_t i) { return surface.vertices[static_cast<std::size_t>(k[i])]; };
            const auto normal = [&](std::size_t i) { return vec(normals[static_cast<std::size_t>(k[i])]); };
            Vec3 mean = normal(0);
            for (const std::size_t i : {1U, 2U}) mean += dot(normal(i), normal(0)) < 0.0 ? -normal(i) : normal(i);
            const Vec3 flat = 0.5 * cross(corner(1) - corner(0), corner(2) - corner(0));
            mean = norm(mean) > 0.0 ? normalized(mean) : Vec3{0.0, 0.0, 1.0};  // only where all triangles are flat
            facets.normal[t] = {static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z)};
            facets.area[t] = 0.5 * faces_of(surface, t) * std::abs(dot(flat, mean));
            facets.opening[t] = opening_at(crack, corner(0), corner(1), corner(2), mean, h);
        }
    });
    return facets;
}

// A number for each triangle: 0, 1, ... for connected parts, in the order of their first vertex.
std::vector<std::int32_t> connected_parts(const CrackSurface& surface, std::int32_t& parts)
{
    std::vector<std::int32_t> root(surface.vertices.size());
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](std::int32_t v) {
        while (root[static_cast<std::size_t>(v)] != v) {
            auto& up = root[static_cast<std::size_t>(v)];
            up = root[static_cast<std::size_t>(up)];
            v = up;
        }
        return v;
    };
    for (const auto& t : surface.triangles) {
        std::int32_t a = find(t[0]);
        for (const std::int32_t v : {t[1], t[2]}) {
            const std::int32_t b = find(v);
            root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
            a = std::min(a, b);
        }
    }
    std::vector<std::int32_t> number(surface.vertices.size(), -1), part(surface.triangles.size());
    parts = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        auto& n = number[static_cast<std::size_t>(find(surface.triangles[t][0]))];
        if (n < 0) n = parts++;
        part[t] = n;
    }
    return part;
}

void add_square(Tensor& tensor, const Vec3& n, double weight)
{
    tensor[0] += weight * n.x * n.x, tensor[1] += weight * n.y * n.y, tensor[2] += weight * n.z * n.z;
    tensor[3] += weight * n.y * n.z, tensor[4] += weight * n.x * n.z, tensor[5] += weight * n.x * n.y;
}

struct Principal {
    Vec3 direction;
    double share = 0.0;
};

Principal principal(const Tensor& t)
{
    Eigen::Matrix3d m;
    m << t[0], t[5], t[4], t[5], t[1], t[3], t[4], t[3], t[2];
    const double trace = m.trace();
    if (!(trace > 0.0)) return {{0.0, 0.0, 1.0}, 1.0 / 3.0};
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m / trace);
    const Eigen::Vector3d e = solver.eigenvectors().col(2);
    const double sign = e.z() < 0.0 ? -1.0 : 1.0;
    return {{sign * e.x(), sign * e.y(), sign * e.z()}, solver.eigenvalues()[2]};
}

// Borders of the volume that a crack reaches: thinning has drawn it back by about half its opening.
void find_borders(SingleCrack& crack, const Shape& shape, double h)
{
    const double near = 0.5 * crack.opening + 2.0 * h;
    for (int axis = 0; axis < 3; ++axis) {
        const bool low = crack.least[axis] <= near;
        const bool high = crack.most[axis] >= static_cast<double>(shape[axis]) * h - near;
        crack.at_border |= low || high;
        crack.spans[static_cast<std::size_t>(axis)] = low && high;
    }
}

void find_single_cracks(const CrackSurface& surface, const Facets& facets, const Shape& shape, double h,
                        CrackMeasures& m)
{
    std::int32_t parts = 0;
    m.crack_of = connected_parts(surface, parts);
    m.cracks.resize(static_cast<std::size_t>(parts));
    constexpr double far = std::numeric_limits<double>::infinity();
    for (SingleCrack& c : m.cracks) c.least = {far, far, far}, c.most = {-far, -far, -far};
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto part = static_cast<std::size_t>(m.crack_of[t]);
        SingleCrack& c = m.cracks[part];
        ++c.triangles;
        c.area += facets.area[t];
        c.opening += facets.area[t] * metres(facets.opening[t], h);
        add_square(c.fabric, vec(facets.normal[t]), facets.area[t]);
        for (const std::int32_t corner : surface.triangles[t]) {
            const Vec3& p = surface.vertices[static_cast<std::size_t>(corner)];
            c.centre += p * (facets.area[t] / 3.0);
            for (int axis = 0; axis < 3; ++axis) {
                c.least[axis] = std::min(c.least[axis], p[axis]);
                c.most[axis] = std::max(c.most[axis], p[axis]);
            }
        }
    }
    for (std::size_t k = 0; k < m.cracks.size(); ++k) {
        SingleCrack& c = m.cracks[k];
        if (c.area > 0.0)
            c.opening /= c.area, c.centre = c.centre / c.area;
        else
            c.centre = 0.5 * (c.least + c.most);
        c.radius = std::sqrt(c.area / pi);
        const Principal p = principal(c.fabric);
        const double trace = c.fabric[0] + c.fabric[1] + c.fabric[2];
        for (double& component : c.fabric) component /= trace > 0.0 ? trace : 1.0;
        c.normal = p.direction;
        c.flatness = p.share;
        find_borders(c, shape, h);
    }
    std::vector<std::int32_t> order(m.cracks.size()), place(m.cracks.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::int32_t k) { return m.cracks[static_cast<std::size_t>(k)].area; });
    std::vector<SingleCrack> sorted;
    for (std::size_t k = 0; k < order.size(); ++k) {
        place[static_cast<std::size_t>(order[k])] = static_cast<std::int32_t>(k);
        sorted.push_back(m.cracks[static_cast<std::size_t>(order[k])]);
    }
    m.cracks = std::move(sorted);
    for (std::int32_t& c : m.crack_of) c = place[static_cast<std::size_t>(c)];
}

double degrees(double y, double x) { return std::atan2(y, x) * 180.0 / pi; }

int class_of(double angle, double turn, int classes)
{
    const double wrapped = angle - turn * std::floor(angle / turn);
    return std::min(static_cast<int>(wrapped / turn * classes), classes - 1);
}

void find_directions(const Facets& facets, CrackMeasures& m)
{
    std::array<double, 3> lengths{};
    for (std::size_t t = 0; t < facets.area.size(); ++t) {
        const double area = facets.area[t];
        Vec3 n = vec(facets.normal[t]);
        if (n.z < 0.0) n = -n;
        add_square(m.fabric, n, area / m.area);
        const int ring = std::min(static_cast<int>((1.0 - n.z) * PoleFigure::rings), PoleFigure::rings - 1);
        const int sector = class_of(degrees(n.y, n.x), 360.0, PoleFigure::sectors);
        m.poles.share[static_cast<std::size_t>(sector + PoleFigure::sectors * ring)] += area / m.area;
        // A section cuts a facet along n x axis, over a length per area of the section that goes with |n x axis|.
        const std::array<std::array<double, 2>, 3> traces{{{-n.z, n.y}, {-n.z, n.x}, {-n.y, n.x}}};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double length = area * std::hypot(traces[axis][0], traces[axis][1]);
            const int bin = class_of(degrees(traces[axis][1], traces[axis][0]), 180.0, Rose::bins);
            m.rose.share[axis][static_cast<std::size_t>(bin)] += length;
            lengths[axis] += length;
        }
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (double& share : m.rose.share[axis])
            if (lengths[axis] > 0.0) share /= lengths[axis];
}

void find_openings(const Facets& facets, double h, CrackMeasures& m)
{
    constexpr auto counts_per_class = static_cast<std::size_t>(counts_per_voxel * Openings::step);
    static_assert(counts_per_class == counts_per_voxel * Openings::step);
    std::vector<double> share;  // of the area, by opening in counts
    for (std::size_t t = 0; t < facets.area.size(); ++t) {
        const auto k = static_cast<std::size_t>(facets.opening[t]);
        if (k >= share.size()) share.resize(k + 1, 0.0);
        share[k] += facets.area[t] / m.area;
        m.openings.mean += facets.area[t] / m.area * metres(facets.opening[t], h);
    }
    m.openings.share.resize((share.size() + counts_per_class - 1) / counts_per_class, 0.0);
    for (std::size_t k = 0; k < share.size(); ++k) m.openings.share[k / counts_per_class] += share[k];
    constexpr std::array quantile{0.1, 0.5, 0.9};
    for (std::size_t q = 0; q < 3; ++q) {
        std::size_t k = 0;
        for (double below = share[0]; below < quantile[q] && k + 1 < share.size();) below += share[++k];
        m.openings.quantiles[q] = metres(static_cast<std::int32_t>(k), h);
    }
}

}  // namespace

CrackMeasures measure(const CrackSurface& surface, const Mask& crack, double voxel_size)
{
    const double h = voxel_size;
    CrackMeasures m;
    m.voxel_size = h;
    m.volume = static_cast<double>(crack.shape().voxels()) * h * h * h;
    const Incidence incidence(surface);
    m.quality = quality(surface, incidence);
    const Facets facets = facets_of(surface, crack, h, smooth_normals(surface, incidence, normal_rounds));
    const auto count = static_cast<std::int64_t>(surface.triangles.size());
    m.triangle_area = parallel_sum(count, [&](std::int64_t i) {
        const auto t = static_cast<std::size_t>(i);
        const auto corner = [&](std::size_t k) {
            return surface.vertices[static_cast<std::size_t>(surface.triangles[t][k])];
        };
        return 0.25 * faces_of(surface, t) * norm(cross(corner(1) - corner(0), corner(2) - corner(0)));
    });
    m.area = parallel_sum(count, [&](std::int64_t t) { return facets.area[static_cast<std::size_t>(t)]; });
    find_single_cracks(surface, facets, crack.shape(), h, m);
    for (const SingleCrack& c : m.cracks) {
        const double a3 = c.radius * c.radius * c.radius;
        m.crack_density += a3 / m.volume;
        for (std::size_t k = 0; k < 6; ++k) m.density_tensor[k] += a3 / m.volume * c.fabric[k];
        for (std::size_t axis = 0; axis < 3; ++axis) m.spans[axis] |= c.spans[axis];
    }
    if (m.area > 0.0) {
        m.largest_share = m.cracks.front().area / m.area;
        find_directions(facets, m);
        find_openings(facets, h, m);
    }
    m.opening_of.reserve(facets.opening.size());
    for (const std::int32_t counts : facets.opening) m.opening_of.push_back(static_cast<float>(metres(counts, h)));
    return m;
}

}  // namespace craze::mesh
