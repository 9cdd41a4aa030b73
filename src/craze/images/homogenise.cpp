#include "craze/images/homogenise.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace craze::images {

namespace {

// Sums over one row: how many voxels count, their levels, x, x^2 and x times level.
struct RowSums {
    std::int64_t n = 0, v = 0, x = 0, xx = 0, xv = 0;
};

// In blocks short enough for 32 bits, whose own x count from their first voxel.
CRAZE_MULTIVERSION RowSums sums_of(const std::uint8_t* row, std::int64_t nx, int low, int high)
{
    constexpr std::int64_t block = 256;
    RowSums sums;
    for (std::int64_t x0 = 0; x0 < nx; x0 += block) {
        const auto length = static_cast<std::int32_t>(std::min(block, nx - x0));
        std::int32_t n = 0, v = 0, x = 0, xx = 0, xv = 0;
        for (std::int32_t i = 0; i < length; ++i) {
            const std::int32_t in = row[x0 + i] >= low && row[x0 + i] <= high ? 1 : 0, level = in * row[x0 + i];
            n += in, v += level, x += in * i, xx += in * i * i, xv += level * i;
        }
        sums.n += n, sums.v += v, sums.x += x + x0 * n, sums.xv += xv + x0 * v;
        sums.xx += xx + 2 * x0 * x + x0 * x0 * n;
    }
    return sums;
}

// Where in a thread's table the voxels of a row count: four tables for each layer, as equal neighbours would wait for
// each other in one.
constexpr std::int64_t tables = 4;
CRAZE_MULTIVERSION void places_of(std::int32_t* __restrict to, std::int64_t nx, float start, float step, float last)
{
    for (std::int64_t x = 0; x < nx; ++x) {
        const float at = start + step * static_cast<float>(x);
        const auto layer = static_cast<std::int32_t>(at < 0.0F ? 0.0F : at > last ? last : at);
        to[x] = (layer * static_cast<std::int32_t>(tables) + static_cast<std::int32_t>(x % tables)) * 256;
    }
}

CRAZE_MULTIVERSION void shift_levels(std::uint8_t* __restrict to, const std::uint8_t* __restrict from,
                                     const float* __restrict by, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) {
        const float v = static_cast<float>(from[x]) + by[x] + 0.5F;
        to[x] = static_cast<std::uint8_t>(v > 255.0F ? 255.0F : v > 0.0F ? v : 0.0F);
    }
}

CRAZE_MULTIVERSION void scale_levels(std::uint8_t* __restrict to, const std::uint8_t* __restrict from,
                                     const float* __restrict by, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) {
        const float v = static_cast<float>(from[x]) * by[x] + 0.5F;
        to[x] = static_cast<std::uint8_t>(v > 255.0F ? 255.0F : v > 0.0F ? v : 0.0F);
    }
}

// Between two neighbours of a table, for a whole row.
CRAZE_MULTIVERSION void between(float* __restrict to, const float* __restrict table, float share, std::int64_t n)
{
    for (std::int64_t x = 0; x < n; ++x) to[x] = table[x] + share * (table[x + 1] - table[x]);
}

double mean_of(const Histogram& h, double& count)
{
    double sum = 0.0;
    count = 0.0;
    for (int v = 0; v < 256; ++v) {
        const auto n = static_cast<double>(h[static_cast<std::size_t>(v)]);
        count += n, sum += n * v;
    }
    return count > 0.0 ? sum / count : 0.0;
}

void smooth(std::vector<double>& profile, double sigma)
{
    if (sigma <= 0.0) return;
    const auto n = static_cast<std::int64_t>(profile.size()), reach = static_cast<std::int64_t>(std::ceil(4.0 * sigma));
    const std::vector<double> from = profile;
    for (std::int64_t i = 0; i < n; ++i) {
        double sum = 0.0, weights = 0.0;
        for (std::int64_t j = std::max<std::int64_t>(0, i - reach); j <= std::min(n - 1, i + reach); ++j) {
            const double d = static_cast<double>(j - i) / sigma, w = std::exp(-0.5 * d * d);
            sum += w * from[static_cast<std::size_t>(j)], weights += w;
        }
        profile[static_cast<std::size_t>(i)] = sum / weights;
    }
}

}  // namespace

Homogeniser::Homogeniser(Shape shape, const Homogenise& settings, const Histogram& histogram)
    : shape_(shape), settings_(settings), solid_(solid_of(histogram)), moments_(14)
{
    // Shading widens the peak of the whole volume: leave it room.
    if (solid_.low > 0.0) solid_.low -= solid_.spread, solid_.high += solid_.spread;
    if (settings_.by == Homogenise::By::mean) solid_.low = 0.0, solid_.high = 255.0;
}

// The voxels' sums over n, x, y, z, xx, xy, xz, yy, yz, zz, v, xv, yv, zv, one row at a time.
void Homogeniser::fit(std::int64_t z, std::span<const std::uint8_t> slice)
{
    const auto ny = static_cast<std::size_t>(shape_.ny);
    std::vector<RowSums> rows(ny);
    const int low = static_cast<int>(std::ceil(solid_.low)), high = static_cast<int>(std::floor(solid_.high));
    parallel_ranges(shape_.ny, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y)
            rows[static_cast<std::size_t>(y)] = sums_of(slice.data() + shape_.nx * y, shape_.nx, low, high);
    });
    const auto w = static_cast<double>(z);
    for (std::size_t j = 0; j < ny; ++j) {
        const auto n = static_cast<double>(rows[j].n), v = static_cast<double>(rows[j].v),
                   x = static_cast<double>(rows[j].x), xx = static_cast<double>(rows[j].xx),
                   xv = static_cast<double>(rows[j].xv), y = static_cast<double>(j);
        const double add[14] = {n,         x,         y * n,     w * n, xx, x * y, x * w,
                                y * y * n, y * w * n, w * w * n, v,     xv, y * v, w * v};
        for (std::size_t i = 0; i < 14; ++i) moments_[i] += add[i];
    }
}

void Homogeniser::choose_direction()
{
    direction_ = settings_.axis == Homogenise::Axis::x   ? Vec3{1, 0, 0}
                 : settings_.axis == Homogenise::Axis::y ? Vec3{0, 1, 0}
                                                         : Vec3{0, 0, 1};
    if (moments_[0] > 0.0) {
        const auto& m = moments_;
        Eigen::Matrix4d a;
        a << m[0], m[1], m[2], m[3], m[1], m[4], m[5], m[6], m[2], m[5], m[7], m[8], m[3], m[6], m[8], m[9];
        const Eigen::Vector4d b(m[10], m[11], m[12], m[13]);
        const Eigen::Vector4d plane = a.completeOrthogonalDecomposition().solve(b);
        gradient_ = {plane[1], plane[2], plane[3]};
        for (int axis = 0; axis < 3; ++axis)
            if (shape_[axis] < 2 || !std::isfinite(gradient_[axis])) gradient_[axis] = 0.0;
        if (settings_.axis == Homogenise::Axis::gradient && norm(gradient_) > 0.0) direction_ = normalized(gradient_);
    }
    const double far_x = static_cast<double>(shape_.nx - 1), far_y = static_cast<double>(shape_.ny - 1),
                 far_z = static_cast<double>(shape_.nz - 1);
    start_ =
        std::min(0.0, direction_.x * far_x) + std::min(0.0, direction_.y * far_y) + std::min(0.0, direction_.z * far_z);
    const double end =
        std::max(0.0, direction_.x * far_x) + std::max(0.0, direction_.y * far_y) + std::max(0.0, direction_.z * far_z);
    layers_ = static_cast<std::int64_t>(std::floor(end - start_ + 0.5)) + 1;
    layer_.assign(static_cast<std::size_t>(layers_), Histogram{});
}

double Homogeniser::position(double x, double y, double z) const
{
    return direction_.x * x + direction_.y * y + direction_.z * z - start_;
}

void Homogeniser::learn(std::int64_t z, std::span<const std::uint8_t> slice)
{
    if (layer_.empty()) choose_direction();
    // Each thread counts for itself; whole numbers have no order.
    const std::int64_t team = std::min<std::int64_t>(threads(), shape_.ny);
    counts_.resize(std::max(counts_.size(), static_cast<std::size_t>(team)));
    parallel_tasks(team, [&](std::int64_t t) {
        std::vector<std::uint32_t>& counts = counts_[static_cast<std::size_t>(t)];
        counts.resize(static_cast<std::size_t>(layers_ * tables * 256));
        std::vector<std::int32_t> place(static_cast<std::size_t>(shape_.nx));
        for (std::int64_t y = shape_.ny * t / team; y < shape_.ny * (t + 1) / team; ++y) {
            const std::uint8_t* row = slice.data() + shape_.nx * y;
            places_of(place.data(), shape_.nx,
                      static_cast<float>(position(0.0, static_cast<double>(y), static_cast<double>(z)) + 0.5),
                      static_cast<float>(direction_.x), static_cast<float>(layers_ - 1));
            for (std::size_t x = 0; x < place.size(); ++x) ++counts[static_cast<std::size_t>(place[x]) + row[x]];
        }
    });
}

void Homogeniser::gather_counts()
{
    for (const auto& counts : counts_)
        for (std::size_t i = 0; i < counts.size(); ++i) layer_[i / (256 * tables)][i % 256] += counts[i];
    counts_.clear();
}

void Homogeniser::settle()
{
    if (layer_.empty()) choose_direction();
    gather_counts();
    // A layer at a corner holds few voxels: it borrows from its neighbours until it has enough.
    const auto total = [](const Histogram& h) { return std::accumulate(h.begin(), h.end(), std::int64_t{0}); };
    std::int64_t largest = 0;
    for (const Histogram& h : layer_) largest = std::max(largest, total(h));
    const std::int64_t enough = std::max<std::int64_t>(1, largest / 4);
    profile_.assign(layer_.size(), 0.0);
    double level = 0.0, count = 0.0;
    for (std::int64_t i = 0; i < layers_; ++i) {
        Histogram h = layer_[static_cast<std::size_t>(i)];
        const auto own = static_cast<double>(total(h));
        for (std::int64_t reach = 1; total(h) < enough && reach < layers_; ++reach)
            for (const std::int64_t j : {i - reach, i + reach})
                if (j >= 0 && j < layers_)
                    for (std::size_t v = 0; v < 256; ++v) h[v] += layer_[static_cast<std::size_t>(j)][v];
        double n = 0.0;
        const double mean = mean_of(h, n);
        profile_[static_cast<std::size_t>(i)] =
            settings_.by == Homogenise::By::mean ? mean : centre_of_solid(h, solid_of(h));
        level += own * profile_[static_cast<std::size_t>(i)], count += own;
    }
    smooth(profile_, settings_.smooth);
    level = count > 0.0 ? level / count : 0.0;
    correction_.clear();
    for (const double p : profile_)
        correction_.push_back(static_cast<float>(settings_.correction == Homogenise::Correction::offset ? level - p
                                                 : p > 0.0                                              ? level / p
                                                                                                        : 1.0));
    correction_.push_back(correction_.back());
    // The same at the steps that a row takes through the layers: neighbouring voxels read neighbouring values.
    steps_.clear();
    if (std::abs(direction_.x) < least_step) return;
    const auto length = static_cast<double>(layers_ - 1);
    const auto steps = static_cast<std::int64_t>(length / std::abs(direction_.x)) + shape_.nx + 2;
    for (std::int64_t i = 0; i < steps; ++i)
        steps_.push_back(correction_at(static_cast<double>(i) * direction_.x + (direction_.x < 0.0 ? length : 0.0)));
}

float Homogeniser::correction_at(double layer) const
{
    const double at = std::clamp(layer, 0.0, static_cast<double>(layers_ - 1));
    const auto i = static_cast<std::size_t>(at);
    return correction_[i] + static_cast<float>(at - static_cast<double>(i)) * (correction_[i + 1] - correction_[i]);
}

void Homogeniser::corrections_of_row(double start, std::span<float> to) const
{
    const double step = direction_.x;
    if (!steps_.empty()) {
        const double from = std::max(0.0, (start - (step < 0.0 ? static_cast<double>(layers_ - 1) : 0.0)) / step);
        const std::size_t i = std::min(static_cast<std::size_t>(from), steps_.size() - to.size() - 1);
        return between(to.data(), &steps_[i], static_cast<float>(from - std::floor(from)), std::ssize(to));
    }
    // Hardly a layer from end to end: straight from one multiple of 64 voxels to the next.
    constexpr std::size_t stretch = 64;
    for (std::size_t x = 0; x < to.size(); x += stretch) {
        const float a = correction_at(start + step * static_cast<double>(x)),
                    b = correction_at(start + step * static_cast<double>(x + stretch));
        for (std::size_t i = x; i < std::min(to.size(), x + stretch); ++i)
            to[i] = a + (b - a) * (static_cast<float>(i - x) / static_cast<float>(stretch));
    }
}

void Homogeniser::remove(std::int64_t z, std::span<const std::uint8_t> slice, std::span<std::uint8_t> to) const
{
    const bool offset = settings_.correction == Homogenise::Correction::offset;
    parallel_ranges(shape_.ny, [&](std::int64_t begin, std::int64_t end) {
        std::vector<float> by(static_cast<std::size_t>(shape_.nx));
        for (std::int64_t y = begin; y < end; ++y) {
            corrections_of_row(position(0.0, static_cast<double>(y), static_cast<double>(z)), by);
            const std::uint8_t* from = slice.data() + shape_.nx * y;
            (offset ? shift_levels : scale_levels)(to.data() + shape_.nx * y, from, by.data(), shape_.nx);
        }
    });
}

}  // namespace craze::images
