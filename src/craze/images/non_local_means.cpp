#include "craze/images/non_local_means.hpp"

#include "craze/core/parallel.hpp"
#include "craze/images/patch_weights.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

namespace craze::images {

namespace {

// Of a tile: what a row of all shifts needs stays in the second-level cache, the sums of a tile in the third.
constexpr std::int64_t tile_nx = longest_row, tile_ny = 48, tile_nz = 32;

std::int64_t round_up(std::int64_t n, std::int64_t step) { return (n + step - 1) / step * step; }

// Each pair of voxels p and p + s is met once, at p, with s in one half of the search window. One of the two lies in
// the volume, so p may lie up to R before it or behind.
struct Frame {
    Frame(const NonLocalMeans& filter, Shape of)
        : shape(of),
          R(filter.search / 2),
          P(filter.neighbourhood / 2),
          Rz(filter.in_volume ? R : 0),
          Pz(filter.in_volume ? P : 0),
          overrun(round_up(R, lanes)),
          across(round_up(of.nx + 2 * R, lanes))
    {
    }
    Shape shape;
    std::int64_t R, P, Rz, Pz;
    std::int64_t overrun;  // px that shifted rows go beyond a tile, in whole lanes
    std::int64_t across;   // px along x of all tiles together, from -R on
};

// The slices of a slab, mirrored outwards far enough for every tile, in the two forms that the loops read.
struct Slab {
    Slab(const Frame& frame)
        : margin(round_up(2 * frame.overrun + frame.R + frame.P, lanes)),
          margin_y(frame.R + frame.P),
          margin_z(frame.Rz + frame.Pz),
          stride(2 * margin + round_up(frame.shape.nx, lanes) + lanes),
          rows(frame.shape.ny + 2 * margin_y),
          planes(frame.shape.nz + 2 * margin_z)
    {
    }
    std::int64_t bytes() const { return 4 * stride * rows * planes; }
    std::size_t at(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return static_cast<std::size_t>(x + margin + stride * (y + margin_y + rows * (z + margin_z)));
    }
    void fill(std::int64_t plane, Shape shape, const PatchScale& scale, std::span<const std::uint8_t> slice)
    {
        parallel_ranges(rows, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                const std::uint8_t* from = slice.data() + shape.nx * mirrored(row - margin_y, shape.ny);
                const std::size_t to = at(-margin, row - margin_y, plane - margin_z);
                for (std::int64_t x = 0; x < stride; ++x) {
                    const std::uint8_t v = from[mirrored(x - margin, shape.nx)];
                    scaled[to + static_cast<std::size_t>(x)] = scale.scaled[v];
                    level[to + static_cast<std::size_t>(x)] = static_cast<std::int16_t>(v << 7);
                }
            }
        });
    }

    std::int64_t margin, margin_y, margin_z;  // voxels before the first
    std::int64_t stride, rows, planes;
    std::vector<std::int16_t> scaled;  // for differences
    std::vector<std::int16_t> level;   // << 7, for sums
};

// Sums of weights and of weighted levels of the voxels of a slab.
struct Sums {
    std::vector<std::int32_t> weighted, weights;
    std::mutex lock;
};

// Works on one box of voxels p after the other, with sums of its own for all p and p + s.
class Tile {
public:
    Tile(const Frame& frame, const NonLocalMeans& filter, const PatchScale& scale, const Slab& slab)
        : f_(frame),
          scale_(scale),
          slab_(slab),
          shifts_(2 * frame.R + 1),
          n_(filter.neighbourhood),
          sums_nx_(tile_nx + 2 * f_.overrun),
          sums_ny_(tile_ny + 2 * f_.R),
          weighted_(static_cast<std::size_t>(sums_nx_ * sums_ny_ * (tile_nz + f_.Rz))),
          weights_(weighted_.size()),
          column_stride_(tile_nx + lanes),
          column_(static_cast<std::size_t>((tile_ny + f_.R + 2 * f_.P + 2) * shifts_ * column_stride_)),
          weight_stride_(tile_nx + 4 * f_.overrun),
          weight_(static_cast<std::size_t>(shifts_ * weight_stride_))
    {
    }

    /// p in [x0, x1) x [y0, y1) x [z0, z1); boxes at a face go on beyond it as far as some p + s lies in the volume.
    void filter(std::int64_t x0, std::int64_t x1, std::int64_t y0, std::int64_t y1, std::int64_t z0, std::int64_t z1)
    {
        x0_ = x0, length_ = x1 - x0, y0_ = y0, y1_ = y1, z0_ = z0, z1_ = z1;
        std::ranges::fill(weighted_, 0);
        std::ranges::fill(weights_, 0);
        std::ranges::fill(weight_, std::uint16_t{0});
        for (std::int64_t sz = 0; sz <= f_.Rz; ++sz)
            for (std::int64_t sy = sz == 0 ? 0 : -f_.R; sy <= f_.R; ++sy) add_shifts(sy, sz);
    }

    void add_to(Sums& sums)
    {
        const auto [nx, ny, nz] = f_.shape;
        const std::int64_t x_low = std::max<std::int64_t>(0, x0_ - f_.overrun),
                           x_high = std::min(nx, x0_ + length_ + f_.overrun);
        const std::lock_guard guard(sums.lock);
        for (std::int64_t z = z0_; z < std::min(nz, z1_ + f_.Rz); ++z)
            for (std::int64_t y = std::max<std::int64_t>(0, y0_ - f_.R); y < std::min(ny, y1_ + f_.R); ++y) {
                const Accumulators from = sums_at(x_low, y, z);
                const auto to = static_cast<std::size_t>(x_low + nx * (y + ny * z));
                for (std::size_t i = 0; i < static_cast<std::size_t>(x_high - x_low); ++i) {
                    sums.weighted[to + i] += from.weighted[i];
                    sums.weights[to + i] += from.weights[i];
                }
            }
    }

private:
    Accumulators sums_at(std::int64_t x, std::int64_t y, std::int64_t z)
    {
        const auto at =
            static_cast<std::size_t>(x - x0_ + f_.overrun + sums_nx_ * (y - y0_ + f_.R + sums_ny_ * (z - z0_)));
        return {&weighted_[at], &weights_[at]};
    }

    // The sums of a tile lie in the third-level cache: ask for a row while its weights are made.
    static void fetch(Accumulators row, std::int64_t n)
    {
        for (std::int64_t i = 0; i < n; i += 16) {
            __builtin_prefetch(row.weighted + i, 1, 2);
            __builtin_prefetch(row.weights + i, 1, 2);
        }
    }

    // All shifts (sx, sy, sz) with the same sy and sz: they read the same rows, so their sums share the accumulators.
    void add_shifts(std::int64_t sy, std::int64_t sz)
    {
        const auto [nx, ny, nz] = f_.shape;
        const std::int64_t first_sx = sy == 0 && sz == 0 ? 1 : -f_.R;
        const std::int64_t y_low = y0_ == 0 ? std::min<std::int64_t>(0, -sy) : y0_,
                           y_high = y1_ == ny ? std::max(ny, ny - sy) : y1_, z_low = z0_ == 0 ? -sz : z0_;
        PatchRow r;
        r.length = length_, r.count = f_.R - first_sx + 1, r.neighbourhood = n_;
        r.column_stride = column_stride_, r.weight_stride = weight_stride_;
        r.weight = &weight_[static_cast<std::size_t>(2 * f_.overrun)];
        const auto columns = [&](std::int64_t b) {
            return &column_[static_cast<std::size_t>((b + 2) * shifts_ * column_stride_)];
        };
        const std::uint16_t* zeros = columns(-2);
        r.band = columns(-1);
        for (std::int64_t z = z_low; z < z1_; ++z) {
            std::fill_n(r.band, r.count * column_stride_, std::uint16_t{0});
            for (std::int64_t y = y_low - f_.P; y < y_high + f_.P; ++y) {
                const std::int64_t b = y - (y_low - f_.P), centre = y - f_.P;  // whose neighbourhoods are complete
                r.column = columns(b);
                r.column_old = b < n_ ? zeros : columns(b - n_);
                if (z == z_low) {
                    std::fill_n(r.column, r.count * column_stride_, std::uint16_t{0});
                    for (std::int64_t dz = -f_.Pz; dz <= f_.Pz; ++dz) {
                        look(r, y, z + dz, first_sx, sy, sz);
                        start_columns(r, scale_);
                    }
                } else {
                    look(r, y, z + f_.Pz, first_sx, sy, sz);
                }
                const bool complete = centre >= y_low;
                const bool here = complete && z >= 0 && centre >= 0 && centre < ny;
                const bool there = complete && z + sz < nz && centre + sy >= 0 && centre + sy < ny;
                if (here) fetch(sums_at(x0_, centre, z), length_);
                if (there) fetch(sums_at(x0_ - f_.overrun, centre + sy, z + sz), length_ + 2 * f_.overrun);
                weigh_row(r, scale_, z == z_low, here || there);
                if (here) add_here(r, centre, z, first_sx, sy, sz);
                if (there) add_there(r, centre, z, first_sx, sy, sz);
            }
        }
    }

    void look(PatchRow& r, std::int64_t y, std::int64_t z, std::int64_t sx, std::int64_t sy, std::int64_t sz)
    {
        const std::int64_t x = x0_ - f_.P, back = slab_.rows * slab_.stride * (2 * f_.Pz + 1);
        r.p_new = slab_.scaled.data() + slab_.at(x, y, z);
        r.ps_new = slab_.scaled.data() + slab_.at(x + sx, y + sy, z + sz);
        r.p_old = r.p_new - back, r.ps_old = r.ps_new - back;
    }

    // w_s(p) v(p + s) to p.
    void add_here(const PatchRow& r, std::int64_t y, std::int64_t z, std::int64_t sx, std::int64_t sy, std::int64_t sz)
    {
        add_rows({r.weight, slab_.level.data() + slab_.at(x0_ + sx, y + sy, z + sz), weight_stride_, 1, r.count},
                 sums_at(x0_, y, z), length_);
    }

    // w_s(p) v(p) to p + s.
    void add_there(const PatchRow& r, std::int64_t y, std::int64_t z, std::int64_t sx, std::int64_t sy, std::int64_t sz)
    {
        const std::int64_t x = x0_ - f_.overrun;
        add_rows(
            {r.weight - f_.overrun - sx, slab_.level.data() + slab_.at(x - sx, y, z), weight_stride_ - 1, -1, r.count},
            sums_at(x, y + sy, z + sz), length_ + 2 * f_.overrun);
    }

    const Frame& f_;
    const PatchScale& scale_;
    const Slab& slab_;
    std::int64_t shifts_, n_;
    std::int64_t x0_ = 0, length_ = 0, y0_ = 0, y1_ = 0, z0_ = 0, z1_ = 0;
    std::int64_t sums_nx_, sums_ny_;
    std::vector<std::int32_t> weighted_, weights_;
    std::int64_t column_stride_;
    std::vector<std::uint16_t> column_;  // per row and shift: squares summed along z; before them a row of zeros
                                         // and one of columns summed along y
    std::int64_t weight_stride_;
    std::vector<std::uint16_t> weight_;  // per shift: the row of weights just made, zeros on both sides
};

}  // namespace

std::int64_t memory_of_slab(const NonLocalMeans& filter, Shape shape, std::int64_t slices)
{
    const Frame frame(filter, {shape.nx, shape.ny, slices});
    return Slab(frame).bytes() + 9 * frame.shape.voxels();
}

void filter_slab(const NonLocalMeans& filter, Shape shape, std::int64_t z0, std::int64_t z1,
                 const std::function<void(std::int64_t, std::span<std::uint8_t>)>& read,
                 const std::function<void(std::int64_t, std::span<const std::uint8_t>)>& write,
                 const std::function<void(double)>& advance)
{
    const Frame frame(filter, {shape.nx, shape.ny, z1 - z0});
    const auto [nx, ny, nz] = frame.shape;
    const PatchScale scale(filter);
    Slab slab(frame);
    slab.scaled.resize(static_cast<std::size_t>(slab.stride * slab.rows * slab.planes));
    slab.level.resize(slab.scaled.size());
    Volume<std::uint8_t> result(frame.shape);
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(nx * ny));
    std::int64_t last = -1;
    for (std::int64_t plane = 0; plane < slab.planes; ++plane) {
        const std::int64_t z = mirrored(z0 + plane - slab.margin_z, shape.nz);
        if (z != last) read(z, slice);
        last = z;
        slab.fill(plane, shape, scale, slice);
        if (z0 + plane - slab.margin_z == z && z >= z0 && z < z1)
            std::ranges::copy(slice, result.slice(z - z0).begin());
    }
    Sums sums;
    sums.weighted.assign(static_cast<std::size_t>(frame.shape.voxels()), 0);
    sums.weights.assign(sums.weighted.size(), 0);
    const std::int64_t columns = (frame.across + tile_nx - 1) / tile_nx,
                       step = round_up((frame.across + columns - 1) / columns, lanes),
                       down = (ny + tile_ny - 1) / tile_ny, deep = (nz + tile_nz - 1) / tile_nz,
                       tiles = columns * down * deep;
    std::vector<std::unique_ptr<Tile>> workers;
    std::vector<Tile*> idle;
    std::mutex lock;
    parallel_tasks(tiles, [&, ny = ny, nz = nz](std::int64_t task) {
        Tile* tile = nullptr;
        {
            const std::lock_guard guard(lock);
            if (idle.empty()) {
                workers.push_back(std::make_unique<Tile>(frame, filter, scale, slab));
                idle.push_back(workers.back().get());
            }
            tile = idle.back();
            idle.pop_back();
        }
        const std::int64_t x = task % columns * step, y = task / columns % down * tile_ny,
                           z = task / columns / down * tile_nz;
        if (x < frame.across)
            tile->filter(x - frame.R, std::min(x + step, frame.across) - frame.R, y, std::min(y + tile_ny, ny), z,
                         std::min(z + tile_nz, nz));
        if (x < frame.across) tile->add_to(sums);
        const std::lock_guard guard(lock);
        idle.push_back(tile);
        if (advance) advance(1.0 / static_cast<double>(tiles));
    });
    parallel_ranges(static_cast<std::int64_t>(sums.weights.size()), [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            result.values()[i] = level_of(result.values()[i], sums.weighted[i], sums.weights[i]);
    });
    for (std::int64_t z = z0; z < z1; ++z) write(z, result.slice(z - z0));
}

Volume<std::uint8_t> non_local_means(const Volume<std::uint8_t>& gray, const NonLocalMeans& filter)
{
    Volume<std::uint8_t> result(gray.shape());
    filter_slab(
        filter, gray.shape(), 0, gray.shape().nz,
        [&](std::int64_t z, std::span<std::uint8_t> to) { std::ranges::copy(gray.slice(z), to.begin()); },
        [&](std::int64_t z, std::span<const std::uint8_t> from) { std::ranges::copy(from, result.slice(z).begin()); });
    return result;
}

}  // namespace craze::images
