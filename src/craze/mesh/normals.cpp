#include "craze/mesh/normals.hpp"

#include "craze/core/parallel.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace craze::mesh {

namespace {

Vec3 area_vector(const CrackSurface& surface, std::int32_t triangle)
{
    const auto& t = surface.triangles[static_cast<std::size_t>(triangle)];
    const auto corner = [&](std::size_t k) { return surface.vertices[static_cast<std::size_t>(t[k])]; };
    return 0.5 * faces_of(surface, static_cast<std::size_t>(triangle)) *
           cross(corner(1) - corner(0), corner(2) - corner(0));
}

// The sum of area vectors around a vertex, each turned towards the principal direction of them all.
Vec3 first_normal(const CrackSurface& surface, std::span<const std::int32_t> around)
{
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    for (const std::int32_t t : around) {
        const Vec3 n = area_vector(surface, t);
        const double size = norm(n);
        if (!(size > 0.0)) continue;
        const Eigen::Vector3d v(n.x, n.y, n.z);
        tensor += v * v.transpose() / size;
    }
    const double trace = tensor.trace();
    if (!(trace > 0.0)) return {};
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(tensor / trace);
    const Eigen::Vector3d e = solver.eigenvectors().col(2);
    Vec3 sum;
    for (const std::int32_t t : around) {
        const Vec3 n = area_vector(surface, t);
        sum += dot(n, {e.x(), e.y(), e.z()}) < 0.0 ? -n : n;
    }
    return sum;
}

float dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

Incidence::Incidence(const CrackSurface& surface)
{
    first_.assign(surface.vertices.size() + 1, 0);
    for (const auto& t : surface.triangles)
        for (const std::int32_t v : t) ++first_[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    triangles_.resize(3 * surface.triangles.size());
    std::vector<std::int64_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (const std::int32_t v : surface.triangles[t])
            triangles_[static_cast<std::size_t>(next[static_cast<std::size_t>(v)]++)] = static_cast<std::int32_t>(t);
}

std::vector<Direction> smooth_normals(const CrackSurface& surface, const Incidence& incidence, int rounds)
{
    const auto n = static_cast<std::int64_t>(surface.vertices.size());
    std::vector<Direction> normals(surface.vertices.size()), next(surface.vertices.size());
    // Areas in units of the whole, so that floats of any physical size neither overflow nor vanish.
    double unit = parallel_sum(static_cast<std::int64_t>(surface.triangles.size()), [&](std::int64_t t) {
        return norm(area_vector(surface, static_cast<std::int32_t>(t)));
    });
    unit /= std::max(1.0, static_cast<double>(surface.triangles.size()));
    if (!(unit > 0.0)) return normals;
    parallel_ranges(n, [&](std::int64_t begin, std::int64_t end) {
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
            const Vec3 first = first_normal(surface, incidence.at(v)) / unit;
            normals[v] = {static_cast<float>(first.x), static_cast<float>(first.y), static_cast<float>(first.z)};
        }
    });
    for (int round = 0; round < rounds; ++round) {
        parallel_ranges(n, [&](std::int64_t begin, std::int64_t end) {
            for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
                const auto around = incidence.at(v);
                const Direction own = normals[v];
                Direction sum;
                for (const std::int32_t t : around)
                    for (const std::int32_t corner : surface.triangles[static_cast<std::size_t>(t)]) {
                        const Direction& other = normals[static_cast<std::size_t>(corner)];
                        const float sign = dot(own, other) < 0.0F ? -1.0F : 1.0F;
                        sum.x += sign * other.x, sum.y += sign * other.y, sum.z += sign * other.z;
                    }
                const float share = 1.0F / (3.0F * static_cast<float>(std::max<std::size_t>(around.size(), 1)));
                next[v] = {sum.x * share, sum.y * share, sum.z * share};
            }
        });
        normals.swap(next);
    }
    for (Direction& d : normals) {
        const float size = std::sqrt(dot(d, d));
        if (size > 0.0F) d = {d.x / size, d.y / size, d.z / size};
    }
    return normals;
}

}  // namespace craze::mesh
