// What did the microscope see? A raw stack of slices becomes gray levels one can trust [2.3].
//
//     raw stack ─► 8-bit levels ─► alignment ─► stripes ─► non-local means ─► homogenisation ─► cubic voxels ─► Gray
//
// From disk to disk in slabs: memory is bounded by `memory`, the result does not depend on the slabs or the threads,
// and a run that was stopped goes on after its last finished slab.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/vec3.hpp"
#include "craze/images/alignment.hpp"
#include "craze/images/gray.hpp"
#include "craze/images/quality.hpp"
#include "craze/images/settings.hpp"

#include <filesystem>
#include <vector>

namespace craze::images {

/// What was done to a stack, step by step; the volume itself lies on disk.
struct Preprocessed {
    Shape raw;                        ///< of the stack as it came, cropped as the settings say
    Shape shape;                      ///< of the volume given
    double voxel_size = 0.0;          ///< m
    double low = 0.0, high = 255.0;   ///< levels of the source that became 0 and 255
    CommonCrop kept;                  ///< px of the raw slices that all aligned slices cover
    Shift drift;                      ///< px per slice: linear trend of the measured positions
    double jitter = 0.0;              ///< px: rms of the corrections
    double largest_correction = 0.0;  ///< px
    std::int64_t bad_pairs = 0;       ///< pairs of slices that the robust fit set aside
    double sigma = 0.0, h = 0.0;      ///< gray levels, as used by non-local means; 0 where it is off
    Vec3 gradient;                    ///< gray levels per voxel, as fitted before it was removed
    Vec3 layers;                      ///< unit vector across the layers that homogenisation levelled
    std::vector<Quality> quality;     ///< of the raw stack, then after each step that was done
    double seconds = 0.0;
};

/// Cleans the stack and writes into `folder`: gray.mhd (+ gray.raw), transforms.csv, spectrum.csv, profile.csv and
/// strip_<n>_<step>.png, three slices after each step as in Fig. 3.
/// @throws InvalidInput  naming the file or key
Preprocessed preprocess(const Settings& settings, const std::filesystem::path& folder);

/// What preprocess wrote.
Gray load_gray(const std::filesystem::path& folder);
/// The same for gray levels that were not made by preprocess.
void save(const Gray& gray, const std::filesystem::path& folder);

/// Keys are documented in docs/results.md.
Json summary(const Preprocessed& done);

}  // namespace craze::images
