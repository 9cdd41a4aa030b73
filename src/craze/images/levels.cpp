#include "craze/images/levels.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace craze::images {

namespace {

constexpr std::size_t bins = 65536;

template <class T>
const T* row_of(const std::vector<std::byte>& slice, std::int64_t at)
{
    return reinterpret_cast<const T*>(slice.data()) + at;
}

template <class T>
CRAZE_INLINE void to_levels(const T* __restrict from, std::uint8_t* __restrict to, std::int64_t n, float low,
                            float scale)
{
    for (std::int64_t x = 0; x < n; ++x) {
        const float v = (static_cast<float>(from[x]) - low) * scale + 0.5F;
        to[x] = static_cast<std::uint8_t>(v > 255.0F ? 255.0F : v > 0.0F ? v : 0.0F);  // NaN becomes 0
    }
}
CRAZE_MULTIVERSION void levels_of(const std::uint16_t* from, std::uint8_t* to, std::int64_t n, float low, float scale)
{
    to_levels(from, to, n, low, scale);
}
CRAZE_MULTIVERSION void levels_of(const float* from, std::uint8_t* to, std::int64_t n, float low, float scale)
{
    to_levels(from, to, n, low, scale);
}

// The bin under which `share` of the counts lie.
double quantile(const std::vector<std::int64_t>& histogram, double share)
{
    const std::int64_t all = std::accumulate(histogram.begin(), histogram.end(), std::int64_t{0});
    std::int64_t below = 0;
    for (std::size_t v = 0; v < bins; ++v) {
        below += histogram[v];
        if (static_cast<double>(below) > share * static_cast<double>(all)) return static_cast<double>(v);
    }
    return static_cast<double>(bins - 1);
}

}  // namespace

LevelSource::LevelSource(const Settings& settings)
{
    io::OpenOptions options;
    options.dataset = settings.dataset;
    if (settings.raw_shape.size() == 3)
        options.raw_shape = {settings.raw_shape[0], settings.raw_shape[1], settings.raw_shape[2]};
    options.raw_sample = settings.raw_sample;
    options.raw_big_endian = settings.raw_big_endian;
    options.raw_header = settings.raw_header;
    reader_ = io::open_volume(settings.source, options);
    shape_ = reader_->info().shape;
    raw_.resize(static_cast<std::size_t>(reader_->info().slice_bytes()));
    crop(settings.crop);
    find_voxel_size(settings);
    find_window(settings.window);
}

void LevelSource::crop(const std::vector<std::int64_t>& box)
{
    if (box.empty()) return;
    for (int axis = 0; axis < 3; ++axis)
        if (box[static_cast<std::size_t>(2 * axis + 1)] > shape_[axis])
            throw InvalidInput(fmt::format("images.crop: {} to {} along {} leaves the stack of {} x {} x {} voxels",
                                           box[static_cast<std::size_t>(2 * axis)],
                                           box[static_cast<std::size_t>(2 * axis + 1)], "xyz"[axis], shape_.nx,
                                           shape_.ny, shape_.nz));
    x0_ = box[0], y0_ = box[2], z0_ = box[4];
    shape_ = {box[1] - box[0], box[3] - box[2], box[5] - box[4]};
}

void LevelSource::find_voxel_size(const Settings& settings)
{
    const auto& said = settings.voxel_size;
    voxel_size_ = said.empty()       ? reader_->info().voxel_size
                  : said.size() == 1 ? Vec3{said[0], said[0], said[0]}
                                     : Vec3{said[0], said[1], said[2]};
    // A picture format knows the pixel but not the step between slices.
    if (said.empty() && voxel_size_.z <= 0.0 && voxel_size_.x > 0.0) {
        voxel_size_.z = voxel_size_.x;
        notice(fmt::format("{}: says the size of a pixel but not the step between slices; taken as equal",
                           settings.source));
    }
    for (int axis = 0; axis < 3; ++axis)
        if (!(voxel_size_[axis] >= 1e-10 && voxel_size_[axis] <= 1e-2))
            throw InvalidInput(
                fmt::format("images.voxel_size: {} does not say a usable one; set it, as in voxel_size = \"23.6 nm\"",
                            settings.source));
}

void LevelSource::find_window(const Window& window)
{
    const io::Sample sample = reader_->info().sample;
    if (sample == io::Sample::u8) {
        if (window.method == Window::Method::values && (window.low > 0.0 || window.high < 255.0) &&
            window.high <= 255.0)
            low_ = window.low, high_ = window.high;
        return;
    }
    low_ = 0.0, high_ = sample == io::Sample::u16 ? 65535.0 : 1.0;
    if (window.method == Window::Method::values) low_ = window.low, high_ = window.high;
    if (window.method != Window::Method::percentiles) return;
    const Shape& whole = reader_->info().shape;
    const std::int64_t pixels = whole.nx * whole.ny;
    double least = 0.0, step = 1.0;
    if (sample == io::Sample::f32) {
        double most = -1e300;
        least = 1e300;
        for (std::int64_t z = z0_; z < z0_ + shape_.nz; ++z) {
            reader_->read_slice(z, raw_);
            for (std::int64_t i = 0; i < pixels; ++i) {
                const float v = *row_of<float>(raw_, i);
                if (std::isfinite(v)) least = std::min<double>(least, v), most = std::max<double>(most, v);
            }
        }
        if (!(most > least))
            throw InvalidInput(fmt::format("{}: all values are equal or not numbers", reader_->path().string()));
        step = (most - least) / (bins - 1);
    }
    std::vector<std::int64_t> histogram(bins);
    Progress progress("images: window", shape_.nz);
    for (std::int64_t z = z0_; z < z0_ + shape_.nz; ++z) {
        reader_->read_slice(z, raw_);
        for (std::int64_t y = y0_; y < y0_ + shape_.ny; ++y)
            for (std::int64_t x = x0_; x < x0_ + shape_.nx; ++x) {
                const std::int64_t at = x + whole.nx * y;
                if (sample == io::Sample::u16)
                    ++histogram[*row_of<std::uint16_t>(raw_, at)];
                else if (const float v = *row_of<float>(raw_, at); std::isfinite(v))
                    ++histogram[static_cast<std::size_t>((static_cast<double>(v) - least) / step)];
            }
        progress.advance();
    }
    // The ends of a 16-bit range are what lies outside of the specimen or saturates.
    if (sample == io::Sample::u16) histogram.front() = histogram.back() = 0;
    low_ = least + step * quantile(histogram, window.low_percent / 100.0);
    high_ = least + step * quantile(histogram, window.high_percent / 100.0);
    if (!(high_ > low_))
        throw InvalidInput(fmt::format("{}: its levels from percentile {} to {} are all {}; set images.window",
                                       reader_->path().string(), window.low_percent, window.high_percent, low_));
}

void LevelSource::read(std::int64_t z, std::span<std::uint8_t> to)
{
    reader_->read_slice(z + z0_, raw_);
    const std::int64_t stride = reader_->info().shape.nx;
    const auto low = static_cast<float>(low_), scale = static_cast<float>(255.0 / (high_ - low_));
    for (std::int64_t y = 0; y < shape_.ny; ++y) {
        const std::int64_t at = x0_ + stride * (y + y0_);
        std::uint8_t* row = to.data() + shape_.nx * y;
        switch (reader_->info().sample) {
            case io::Sample::u8: {
                const auto* from = row_of<std::uint8_t>(raw_, at);
                if (low_ == 0.0 && high_ == 255.0)
                    std::copy_n(from, shape_.nx, row);
                else
                    to_levels(from, row, shape_.nx, low, scale);
                break;
            }
            case io::Sample::u16: levels_of(row_of<std::uint16_t>(raw_, at), row, shape_.nx, low, scale); break;
            case io::Sample::f32: levels_of(row_of<float>(raw_, at), row, shape_.nx, low, scale); break;
        }
    }
}

}  // namespace craze::images
