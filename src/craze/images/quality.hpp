// How good the images are: a few numbers and pictures after each step.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/core/volume.hpp"
#include "craze/images/solid.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace craze::images {

/// Of a volume after one step, from up to 24 of its slices. Gray levels unless said otherwise.
struct Quality {
    std::string step;
    double noise = 0.0;        ///< standard deviation of the noise, from neighbouring voxels
    double noise_apart = 0.0;  ///< the same from voxels of the solid 4 px apart, which correlated noise lowers less
    bool correlated = false;   ///< noise_apart is much larger, and no larger 8 px apart, as texture would be
    double stripes = 0.0;      ///< rms over the stripes of the mean along them, slow variations left out
    Vec3 gradient;             ///< of the solid, per voxel
    double shading = 0.0;      ///< what the fitted plane varies by over the volume
    double solid = 0.0, dark = 0.0;  ///< level of the solid, mean level of what is darker than all of it
    double contrast_to_noise = 0.0;  ///< (solid - dark) / noise
    std::vector<double> spectrum;    ///< power of the stripes; index m is m / (2 extent) waves per pixel across them
};

/// Noise of a slice: median of the absolute response to a mask that is blind to planes and parabolas along the axes
/// (Immerkaer 1996), over that of Gaussian noise of unit deviation. 0 where the mask does not fit.
/// @param apart  px between the values of the mask
/// @param solid  masks with a level outside of its range do not count
double noise_of_slice(std::span<const std::uint8_t> slice, std::int64_t nx, std::int64_t ny, std::int64_t apart = 1,
                      const Solid& solid = {});

/// Mean of the solid's levels along each line of a slice parallel to `axis` (0: x, 1: y).
std::vector<double> line_means(std::span<const std::uint8_t> slice, std::int64_t nx, std::int64_t ny, int axis,
                               const Solid& solid);

using SliceReader = std::function<void(std::int64_t, std::span<std::uint8_t>)>;

/// @param stripe_axis  axis along which stripes run, 0 or 1
/// @param protect      px: variations across the stripes longer than this are no stripes
Quality quality_of(const std::string& step, Shape shape, const SliceReader& read, int stripe_axis, double protect);

/// Noise of the volume: median over the slices looked at.
double noise_of(Shape shape, const SliceReader& read);

/// Three slices of the volume side by side, at 11, 28 and 70 % of its height as in Fig. 3.
void write_strip(const std::filesystem::path& file, Shape shape, const SliceReader& read);

}  // namespace craze::images
