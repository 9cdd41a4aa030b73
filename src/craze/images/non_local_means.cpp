#include "craze/images/non_local_means.hpp"

#include "craze/core/parallel.hpp"
#include "craze/images/patch_weights.hpp"

#include <algorithm>
#include <mutex>
#include <vector>

namespace craze::images {

namespace {

constexpr std::int64_t tile_ny = 32, tile_nz = 64;

std::int64_t round_up(std::int64_t n, std::int64_t step) { return (n + step - 1) / step * step; }

// The slices of a slab, mirrored outwards far enough for every tile, in the two forms that the loops read.
struct Slab {
    Shape shape;                    // of the slices filtered
    std::int64_t margin, margin_z;  // px before the first voxel of a row, of a column, of the slab
    std::int64_t stride, rows, planes;
    std::vector<std::int16_t> scaled;  // for differences
    std::vector<std::int16_t> level;   // << 7, for sums

    std::int64_t at(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return x + margin + stride * (y + margin + rows * (z + margin_z));
    }
};

Slab lay_out(const NonLocalMeans& filter, Shape shape, std::int64_t slices)
{
    Slab slab;
    slab.shape = {shape.nx, shape.ny, slices};
    const std::int64_t reach = filter.search / 2 + filter.neighbourhood / 2;
    slab.margin = round_up(reach, 16);
    slab.margin_z = filter.halo();
    // Tiles and rows of weights overrun the last voxel by less than a row.
    slab.stride = round_up(shape.nx, tile_nx(filter.search / 2)) + 2 * slab.margin + row_length;
    slab.rows = shape.ny + 2 * slab.margin;
    slab.planes = slices + 2 * slab.margin_z;
    return slab;
}

void fill_plane(Slab& slab, const PatchScale& scale, std::span<const std::uint8_t> slice, std::int64_t plane)
{
    const auto [nx, ny, nz] = slab.shape;
    parallel_ranges(slab.rows, [&, nx = nx, ny = ny](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const std::uint8_t* from = slice.data() + nx * mirrored(row - slab.margin, ny);
            const std::int64_t at = slab.stride * (row + slab.rows * plane);
            for (std::int64_t x = 0; x < slab.stride; ++x) {
                const std::uint8_t v = from[mirrored(x - slab.margin, nx)];
                slab.scaled[static_cast<std::size_t>(at + x)] = scale.scaled[v];
                slab.level[static_cast<std::size_t>(at + x)] = static_cast<std::int16_t>(v << 7);
            }
        }
    });
}

// One tile of voxels: its sums of weights and of weighted levels, and what the loops need on the way.
class Tile {
public:
    Tile(const NonLocalMeans& filter, const PatchScale& scale, const Slab& slab)
        : R_(filter.search / 2),
          P_(filter.neighbourhood / 2),
          Rz_(filter.in_volume ? R_ : 0),
          Pz_(filter.in_volume ? P_ : 0),
          nx_(tile_nx(R_)),
          scale_(scale),
          slab_(slab),
          weighted_(static_cast<std::size_t>(nx_ * tile_ny * tile_nz)),
          weights_(weighted_.size()),
          column_(static_cast<std::size_t>((2 * R_ + 1) * (tile_ny + R_ + 2 * P_) * padded_row)),
          rows_(static_cast<std::size_t>((2 * R_ + 1) * (filter.neighbourhood + 1) * row_length)),
          weight_(static_cast<std::size_t>(round_up(2 * R_ + 1, chunk) * row_length))
    {
    }

    /// Voxels [x0, x0 + nx) x [y0, y1) x [z0, z1), counted from the slab's first.
    void filter(std::int64_t x0, std::int64_t y0, std::int64_t y1, std::int64_t z0, std::int64_t z1)
    {
        x0_ = x0, y0_ = y0, y1_ = y1, z0_ = z0, z1_ = z1;
        for (std::int64_t z = z0; z < z1; ++z)
            for (std::int64_t y = y0; y < y1; ++y) start_row(&slab_.level[index(x0, y, z)], accumulators(y, z), nx_);
        for (std::int64_t sz = 0; sz <= Rz_; ++sz)
            for (std::int64_t sy = sz == 0 ? 0 : -R_; sy <= R_; ++sy) add_shifts(sy, sz);
    }

    void finish_row(std::int64_t y, std::int64_t z, std::span<std::uint8_t> to)
    {
        const Accumulators row = accumulators(y, z);
        for (std::size_t x = 0; x < to.size(); ++x) to[x] = level_of(row.weighted[x], row.weights[x]);
    }

private:
    std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return static_cast<std::size_t>(slab_.at(x, y, z));
    }
    Accumulators accumulators(std::int64_t y, std::int64_t z)
    {
        const auto at = static_cast<std::size_t>(nx_ * (y - y0_ + tile_ny * (z - z0_)));
        return {&weighted_[at], &weights_[at]};
    }

    // All shifts (sx, sy, sz) with the same sy and sz: they read the same rows, so their sums share the accumulators.
    void add_shifts(std::int64_t sy, std::int64_t sz)
    {
        const std::int64_t first_sx = sy == 0 && sz == 0 ? 1 : -R_, count = R_ - first_sx + 1;
        const std::int64_t y_low = std::min(y0_, y0_ - sy), y_high = std::max(y1_, y1_ - sy);
        const std::int64_t band = y_high - y_low + 2 * P_;
        std::fill(weight_.begin(), weight_.end(), std::uint16_t{0});
        for (std::int64_t z = z0_ - sz; z < z1_; ++z) {
            std::fill(rows_.begin(), rows_.end(), std::uint16_t{0});
            for (std::int64_t b = 0; b < band; ++b) {
                const std::int64_t y = y_low - P_ + b,
                                   centre = y - P_;  // the row whose neighbourhoods are now complete
                const bool complete = b >= 2 * P_;
                const bool here = complete && z >= z0_ && centre >= y0_ && centre < y1_;
                const bool there = complete && z + sz < z1_ && centre + sy >= y0_ && centre + sy < y1_;
                for (std::int64_t k = 0; k < count; ++k) {
                    const std::int64_t sx = first_sx + k, start = x0_ - std::max<std::int64_t>(sx, 0) - P_;
                    std::uint16_t* column =
                        &column_[static_cast<std::size_t>((k * (tile_ny + R_ + 2 * P_) + b) * padded_row)];
                    update_column(column, start, y, z, sx, sy, sz, z == z0_ - sz);
                    sum_rows(column, k, b, here || there);
                }
                if (here) add_row(z, centre, first_sx, count, sy, sz, false);
                if (there) add_row(z, centre, first_sx, count, sy, sz, true);
            }
        }
    }

    // Squared differences summed along z, kept up from plane to plane.
    void update_column(std::uint16_t* column, std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t sx,
                       std::int64_t sy, std::int64_t sz, bool first)
    {
        const auto a = [&](std::int64_t dz) { return &slab_.scaled[index(x, y, z + dz)]; };
        const auto b = [&](std::int64_t dz) { return &slab_.scaled[index(x + sx, y + sy, z + sz + dz)]; };
        if (first) {
            std::fill_n(column, padded_row, std::uint16_t{0});
            for (std::int64_t dz = -Pz_; dz <= Pz_; ++dz) add_squares(a(dz), b(dz), column, scale_);
        } else {
            slide_squares(a(Pz_), b(Pz_), a(-Pz_ - 1), b(-Pz_ - 1), column, scale_);
        }
    }

    void sum_rows(const std::uint16_t* column, std::int64_t k, std::int64_t b, bool needed)
    {
        const std::int64_t n = 2 * P_ + 1;
        std::uint16_t* ring = &rows_[static_cast<std::size_t>(k * (n + 1) * row_length)];
        sum_patch(column, ring + (b % n) * row_length, ring + n * row_length,
                  needed ? &weight_[static_cast<std::size_t>(k * row_length)] : nullptr, n, scale_);
    }

    // w_s(p) v(p + s) to p, or w_s(p) v(p) to p + s.
    void add_row(std::int64_t z, std::int64_t y, std::int64_t first_sx, std::int64_t count, std::int64_t sy,
                 std::int64_t sz, bool there)
    {
        const Accumulators row = there ? accumulators(y + sy, z + sz) : accumulators(y, z);
        for (std::int64_t k = 0; k < count; k += chunk) {
            WeightedRow terms[chunk];
            for (std::int64_t j = 0; j < chunk; ++j) {
                const std::int64_t sx = std::min(first_sx + k + j, R_);
                const std::int64_t skip = there ? std::max<std::int64_t>(-sx, 0) : std::max<std::int64_t>(sx, 0);
                terms[j].weight = &weight_[static_cast<std::size_t>((k + j) * row_length + (k + j < count ? skip : 0))];
                terms[j].level = &slab_.level[there ? index(x0_ - sx, y, z) : index(x0_ + sx, y + sy, z + sz)];
            }
            add_chunk(terms, row, nx_);
        }
    }

    std::int64_t R_, P_, Rz_, Pz_, nx_;
    const PatchScale& scale_;
    const Slab& slab_;
    std::int64_t x0_ = 0, y0_ = 0, y1_ = 0, z0_ = 0, z1_ = 0;
    std::vector<std::int32_t> weighted_, weights_;
    std::vector<std::uint16_t> column_;  // per shift and row: squares summed along z
    std::vector<std::uint16_t> rows_;    // per shift: the last rows summed along x too, and their sum along y
    std::vector<std::uint16_t> weight_;  // per shift: the row of weights just made
};

}  // namespace

std::int64_t memory_of_slab(const NonLocalMeans& filter, Shape shape, std::int64_t slices)
{
    const Slab slab = lay_out(filter, shape, slices);
    return slab.stride * slab.rows * slab.planes * 4 + shape.nx * shape.ny * slices;
}

void filter_slab(const NonLocalMeans& filter, Shape shape, std::int64_t z0, std::int64_t z1,
                 const std::function<void(std::int64_t, std::span<std::uint8_t>)>& read,
                 const std::function<void(std::int64_t, std::span<const std::uint8_t>)>& write,
                 const std::function<void(double)>& advance)
{
    const PatchScale scale(filter);
    Slab slab = lay_out(filter, shape, z1 - z0);
    slab.scaled.resize(static_cast<std::size_t>(slab.stride * slab.rows * slab.planes));
    slab.level.resize(slab.scaled.size());
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(shape.nx * shape.ny));
    std::int64_t last = -1;
    for (std::int64_t plane = 0; plane < slab.planes; ++plane) {
        const std::int64_t z = mirrored(z0 + plane - slab.margin_z, shape.nz);
        if (z != last) read(z, slice);
        last = z;
        fill_plane(slab, scale, slice, plane);
    }
    Volume<std::uint8_t> result(slab.shape);
    const std::int64_t step = tile_nx(filter.search / 2);
    const std::int64_t across = (shape.nx + step - 1) / step, down = (shape.ny + tile_ny - 1) / tile_ny,
                       deep = (z1 - z0 + tile_nz - 1) / tile_nz, tiles = across * down * deep;
    std::vector<std::unique_ptr<Tile>> workers;
    std::vector<Tile*> idle;
    std::mutex lock;
    parallel_tasks(tiles, [&](std::int64_t task) {
        Tile* tile = nullptr;
        {
            const std::lock_guard guard(lock);
            if (idle.empty()) {
                workers.push_back(std::make_unique<Tile>(filter, scale, slab));
                idle.push_back(workers.back().get());
            }
            tile = idle.back();
            idle.pop_back();
        }
        const std::int64_t x = task % across * step, y = task / across % down * tile_ny,
                           z = task / across / down * tile_nz;
        const std::int64_t y_end = std::min(y + tile_ny, shape.ny), z_end = std::min(z + tile_nz, z1 - z0);
        tile->filter(x, y, y_end, z, z_end);
        for (std::int64_t k = z; k < z_end; ++k)
            for (std::int64_t j = y; j < y_end; ++j)
                tile->finish_row(j, k,
                                 result.row(j, k).subspan(static_cast<std::size_t>(x),
                                                          static_cast<std::size_t>(std::min(step, shape.nx - x))));
        const std::lock_guard guard(lock);
        idle.push_back(tile);
        if (advance) advance(1.0 / static_cast<double>(tiles));
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
