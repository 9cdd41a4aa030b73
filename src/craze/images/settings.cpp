#include "craze/images/settings.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace craze::images {

void describe(Schema& schema, Settings& s)
{
    schema.path("source", s.source, "stack: a folder of slices, or a .tif, .mhd, .mha, .nrrd, .h5, .png or .raw file");
    schema.quantities("voxel_size", s.voxel_size, Dimension::length, {1e-10, 1e-2},
                      "edge of a voxel, one or [x, y, z]; empty: what the file says");
    schema.integers("crop", s.crop, {0, 1e6}, "[x0, x1, y0, y1, z0, z1] in voxels, ends excluded; empty: all");
    schema.text("dataset", s.dataset, "HDF5: path of the dataset; empty: the only volume of the file");
    schema.group("raw", "what a .raw file does not say", [&] {
        schema.integers("shape", s.raw_shape, {1, 1e6}, "voxels along x, y, z");
        schema.option("type", s.raw_sample, {"uint8", "uint16", "float32"}, "type of the values");
        schema.flag("big_endian", s.raw_big_endian, "byte order of the values");
        schema.integer("header", s.raw_header, {0, 1e9}, "bytes to skip");
    });
    schema.group("window", "levels that become 0 and 255, for stacks of 16 bits or floats", [&] {
        schema.option("method", s.window.method, {"percentiles", "values", "as_is"},
                      "from the histogram, stated, or the whole range of the type");
        schema.quantity("low_percent", s.window.low_percent, Dimension::pure, {0, 100}, "percentile that becomes 0");
        schema.quantity("high_percent", s.window.high_percent, Dimension::pure, {0, 100},
                        "percentile that becomes 255");
        schema.number("low", s.window.low, {-1e9, 1e9}, "level that becomes 0, for values");
        schema.number("high", s.window.high, {-1e9, 1e9}, "level that becomes 255, for values");
    });
    schema.group("alignment", "shifts between slices, section 2.3 (1)", [&] {
        Alignment& a = s.alignment;
        schema.flag("on", a.on, "align the slices");
        schema.integer("neighbours", a.neighbours, {1, 16}, "slices before it that each slice is compared with");
        schema.quantity("max_shift", a.max_shift, Dimension::pixel, {0.5, 1000}, "largest shift between neighbours");
        schema.quantity("least_shift", a.least_shift, Dimension::pixel, {0, 10},
                        "corrections smaller than this leave a slice untouched");
        schema.flag("remove_drift", a.remove_drift,
                    "follow slow displacements too, which straightens inclined structures");
        schema.path("transforms", a.transforms, "transforms.csv of an earlier run to use instead of measuring");
    });
    schema.group("stripes", "curtains of the ion beam, section 2.3 (2)", [&] {
        Stripes& t = s.stripes;
        schema.option("method", t.method, {"notch", "wavelet", "none"},
                      "Fourier notch (the paper), wavelet-Fourier for severe curtains, or none");
        schema.choice("axis", t.axis, {"x", "y"}, "axis along which the stripes run");
        schema.quantity("length", t.length, Dimension::fraction, {0.05, 1.0},
                        "notch: shortest stripe removed, as a share of the slice");
        schema.quantity("protect", t.protect, Dimension::pixel, {2, 1e5},
                        "notch: variations across the stripes longer than this, or than half the slice, are kept");
        schema.integer("levels", t.levels, {1, 10}, "wavelet: levels of decomposition");
        schema.number("damping", t.damping, {0.1, 100}, "wavelet: width of the damped band, waves per slice");
    });
    schema.group("denoise", "non-local means, section 2.3 (3)", [&] {
        Denoise& d = s.denoise;
        schema.option("method", d.method, {"nlm3d", "nlm2d", "none"}, "in the volume, in each slice, or none");
        schema.integer("search", d.search, {3, 63}, "search window, px, odd");
        schema.integer("neighbourhood", d.neighbourhood, {3, 11}, "local neighbourhood, px, odd");
        schema.number("strength", d.strength, {0.05, 10}, "filter strength h over the noise, where h is not set");
        schema.quantity("sigma", d.sigma, Dimension::pure, {0, 255}, "noise, gray levels; auto: measured");
        schema.quantity("h", d.h, Dimension::pure, {0.01, 255}, "filter strength, gray levels; auto: strength x sigma");
    });
    schema.group("homogenise", "shading, section 2.3 (4)", [&] {
        Homogenise& h = s.homogenise;
        schema.flag("on", h.on, "remove the intensity gradient");
        schema.option("axis", h.axis, {"x", "y", "z", "gradient"}, "direction of the gradient; gradient: fitted");
        schema.option("by", h.by, {"mean", "solid"},
                      "level kept constant: that of the solid, which pores do not bias, or the mean (the paper)");
        schema.option("correction", h.correction, {"offset", "gain"}, "add to the levels or multiply them");
        schema.quantity("smooth", h.smooth, Dimension::pixel, {0, 1e4}, "smoothing of the profile along the gradient");
    });
    schema.quantity("memory", s.memory, Dimension::size, {1e7, 1e12}, "memory that slabs may fill");
    schema.flag("keep_steps", s.keep_steps, "leave the volumes between the steps in the output folder");
}

void check(const Settings& s)
{
    const auto refuse = [](const std::string& what) { throw InvalidInput("images." + what); };
    if (s.source.empty()) refuse("source: needed the stack of images, got nothing");
    if (!std::filesystem::exists(s.source)) refuse(fmt::format("source: {} does not exist", s.source));
    if (s.voxel_size.size() > 1 && s.voxel_size.size() != 3)
        refuse(fmt::format("voxel_size: needed one or three lengths, got {}", s.voxel_size.size()));
    if (!s.raw_shape.empty() && s.raw_shape.size() != 3)
        refuse(fmt::format("raw.shape: needed three numbers (x, y, z), got {}", s.raw_shape.size()));
    if (!s.crop.empty()) {
        if (s.crop.size() != 6) refuse(fmt::format("crop: needed six numbers, got {}", s.crop.size()));
        for (std::size_t i = 0; i < 6; i += 2)
            if (s.crop[i] >= s.crop[i + 1])
                refuse(fmt::format("crop: needed a start before its end, got {} and {}", s.crop[i], s.crop[i + 1]));
    }
    if (s.window.method == Window::Method::percentiles && !(s.window.low_percent < s.window.high_percent))
        refuse("window: low_percent must be less than high_percent");
    if (s.window.method == Window::Method::values && !(s.window.low < s.window.high))
        refuse("window: low must be less than high");
    if (s.denoise.search % 2 == 0)
        refuse(fmt::format("denoise.search: needed an odd number, got {}", s.denoise.search));
    if (s.denoise.neighbourhood % 2 == 0)
        refuse(fmt::format("denoise.neighbourhood: needed an odd number, got {}", s.denoise.neighbourhood));
    if (s.denoise.h && !s.denoise.sigma && *s.denoise.h <= 0.0) refuse("denoise.h: needed a positive number");
    if (!s.alignment.transforms.empty() && !std::filesystem::exists(s.alignment.transforms))
        refuse(fmt::format("alignment.transforms: {} does not exist", s.alignment.transforms));
}

}  // namespace craze::images
