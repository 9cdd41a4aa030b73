// Which sheet is each crack? The door of the room: crack voxels in, a surface without thickness out [2.5, Fig. 8].

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/mask.hpp"
#include "craze/core/schema.hpp"
#include "craze/mesh/crack_surface.hpp"
#include "craze/mesh/measures.hpp"

#include <filesystem>

namespace craze::mesh {

enum class SkeletonKind {
    per_slice,       ///< the paper's: thin lines in each slice; a crack that lies in a slice is lost but for lines
    medial_surface,  ///< thin sheets in three dimensions, whatever way a crack lies
};

/// Section [mesh].
struct Settings {
    SkeletonKind skeleton = SkeletonKind::per_slice;
    int slice_axis = 2;  ///< the slices of per_slice are perpendicular to it: 0 x, 1 y, 2 z (as imaged)
    /// Radius of the largest empty ball that spans a triangle, px. Two: skeleton lines of neighbouring slices up to
    /// three pixels apart are joined (sheets steeper than 18 degrees to the slices), and cracks more than four voxels
    /// apart never are; with about 2.4 triangles per skeleton voxel. The paper does not say its own.
    double alpha = 2.0;
    bool stl = false, vtp = false;  ///< further formats beside cracks.ply
};

void describe(Schema& schema, Settings& settings);
/// @throws InvalidInput  naming the key
void check(const Settings& settings);

/// The surface of the cracks in `crack` (true inside cracks): skeleton, then alpha shape of its voxel centres.
/// Vertices are skeleton voxel centres, (x + 1/2) h along each axis. The same bits on any number of threads.
/// @param voxel_size  h, m
/// @throws InvalidInput  when h is not positive
CrackSurface mesh_cracks(const Mask& crack, double voxel_size, const Settings& settings);

/// Writes cracks.ply (binary, metres) into `folder`: all that the next room needs.
void save(const CrackSurface& surface, const std::filesystem::path& folder);
/// The same, and what was measured: cracks.csv, pole_figure.csv and .png, rose.csv and .png, openings.csv; and further
/// formats of the surface as settings say.
void save(const CrackSurface& surface, const CrackMeasures& measures, const Settings& settings,
          const std::filesystem::path& folder);
/// @throws InvalidInput  when cracks.ply is missing or damaged
CrackSurface load_surface(const std::filesystem::path& folder);

/// What summary.json says; keys in docs/results.md.
Json summary(const CrackSurface& surface, const CrackMeasures& measures);

}  // namespace craze::mesh
