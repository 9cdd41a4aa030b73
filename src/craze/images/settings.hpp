// What the [images] section of the settings says.

#pragma once

#include "craze/core/schema.hpp"
#include "craze/io/volume_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace craze::images {

/// How levels become 8-bit: what lies at `low` becomes 0, what lies at `high` becomes 255.
struct Window {
    enum class Method { percentiles, values, as_is };  ///< as_is: 8-bit stays, the whole range of 16 bits is used
    Method method = Method::percentiles;            ///< used for 16-bit and float stacks; 8-bit ones stay as they are
    double low_percent = 0.1, high_percent = 99.9;  ///< of the levels other than 0 and the largest
    double low = 0.0, high = 65535.0;               ///< for `values`
};

/// Where each slice lies against its neighbours [2.3 (1)].
struct Alignment {
    bool on = true;
    std::int64_t neighbours = 4;  ///< each slice is compared with this many before it
    double max_shift = 20.0;      ///< px, between neighbours
    double least_shift = 0.25;    ///< px: corrections smaller than this leave the slice untouched
    bool remove_drift = false;    ///< follow every displacement, slow ones too: straightens inclined structures
    std::string transforms;       ///< CSV of an earlier run to use instead of measuring
};

/// Curtains of the ion beam [2.3 (2)].
struct Stripes {
    enum class Method { notch, wavelet, none };
    Method method = Method::notch;
    int axis = 0;             ///< 0: stripes run along x (the paper's ion beam), 1: along y
    double length = 0.5;      ///< shortest stripe removed, as a share of the slice's extent along the stripes
    double protect = 256.0;   ///< px: variations across the stripes longer than this, or half the slice, are kept
    std::int64_t levels = 7;  ///< wavelet: levels of decomposition
    double damping = 25.0;    ///< wavelet: width of the damped band, in waves per slice
};

/// Non-local means [2.3 (3)].
struct Denoise {
    enum class Method { nlm3d, nlm2d, none };
    Method method = Method::nlm3d;
    std::int64_t search = 21;        ///< px, odd
    std::int64_t neighbourhood = 5;  ///< px, odd
    double strength = 0.6;           ///< h in units of the noise, where h is not set
    std::optional<double> sigma;     ///< gray levels; measured where not set
    std::optional<double> h;         ///< gray levels
};

/// Shading [2.3 (4)].
struct Homogenise {
    enum class Axis { x, y, z, gradient };
    enum class By { mean, solid };
    enum class Correction { offset, gain };
    bool on = true;
    Axis axis = Axis::gradient;
    By by = By::solid;  ///< solid: the mode of the matter, which pores do not bias; mean: the paper
    Correction correction = Correction::offset;
    double smooth = 0.0;  ///< px: standard deviation of the smoothing of the profile; 0: none
};

struct Settings {
    std::string source;                   ///< folder of slices or volume file
    std::string dataset;                  ///< HDF5
    std::vector<std::int64_t> raw_shape;  ///< x, y, z of a raw file
    io::Sample raw_sample = io::Sample::u8;
    bool raw_big_endian = false;
    std::int64_t raw_header = 0;
    std::vector<double> voxel_size;  ///< m: one, or one each for x, y, z; empty: what the file says
    std::vector<std::int64_t> crop;  ///< x0, x1, y0, y1, z0, z1 in voxels, ends excluded; empty: all
    Window window;
    Alignment alignment;
    Stripes stripes;
    Denoise denoise;
    Homogenise homogenise;
    double memory = 2e9;      ///< bytes that slabs may fill
    bool keep_steps = false;  ///< leave the volumes between the steps in the folder
};

void describe(Schema& schema, Settings& settings);

/// @throws InvalidInput  naming the key, before any work starts
void check(const Settings& settings);

}  // namespace craze::images
