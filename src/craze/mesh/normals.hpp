// Which way the crack faces, at a scale where voxels no longer show.

#pragma once

#include "craze/mesh/crack_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mesh {

/// Which triangles meet at each vertex.
class Incidence {
public:
    explicit Incidence(const CrackSurface& surface);
    /// Triangles at vertex v, ascending.
    std::span<const std::int32_t> at(std::size_t v) const
    {
        const auto begin = static_cast<std::size_t>(first_[v]), end = static_cast<std::size_t>(first_[v + 1]);
        return std::span(triangles_).subspan(begin, end - begin);
    }
    std::size_t vertices() const { return first_.size() - 1; }

private:
    std::vector<std::int64_t> first_;
    std::vector<std::int32_t> triangles_;
};

struct Direction {
    float x = 0.0F, y = 0.0F, z = 0.0F;
};

/// Unit normal of the crack at each vertex, shape (vertices,). A sheet has no outside: the sign means nothing.
///
/// Triangles between voxels know a few dozen directions only. Area vectors around each vertex, turned to one side of
/// their principal plane, are averaged over the vertex's triangles `rounds` times, each time after turning them to
/// one side: a blur of about 0.7 sqrt(rounds) px along the sheet. A vector sum gives the normal of a staircase exactly.
std::vector<Direction> smooth_normals(const CrackSurface& surface, const Incidence& incidence, int rounds);

/// Blur of about 3 px: beyond the longest steps of sheets that alpha = 2 px joins.
inline constexpr int normal_rounds = 16;

}  // namespace craze::mesh
