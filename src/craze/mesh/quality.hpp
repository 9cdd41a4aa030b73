// Is the mesh clean? How its triangles fit together.

#pragma once

#include "craze/mesh/crack_surface.hpp"
#include "craze/mesh/normals.hpp"

namespace craze::mesh {

struct MeshQuality {
    std::int64_t duplicate_triangles = 0;   ///< more than one with the same corners: 0 from alpha_shape
    std::int64_t degenerate_triangles = 0;  ///< a corner twice, or no area: 0 from alpha_shape
    std::int64_t unused_vertices = 0;       ///< 0 from alpha_shape
    std::int64_t edges = 0;
    std::int64_t rim_edges = 0;           ///< of one triangle: where a sheet ends
    std::int64_t branching_edges = 0;     ///< of more than two: where sheets meet, or a sheet meets a solid part
    std::int64_t branching_vertices = 0;  ///< around which the triangles are neither one disc nor one half disc
    std::int64_t euler_number = 0;        ///< vertices in use - edges + triangles

    bool clean() const { return duplicate_triangles == 0 && degenerate_triangles == 0 && unused_vertices == 0; }
    /// A two-dimensional manifold, with or without rim.
    bool manifold() const { return clean() && branching_edges == 0 && branching_vertices == 0; }
};

MeshQuality quality(const CrackSurface& surface, const Incidence& incidence);

}  // namespace craze::mesh
