#include "craze/images/non_local_means.hpp"

#include "craze/core/aligned.hpp"
#include "craze/core/parallel.hpp"
#include "craze/images/patch_weights.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

namespace craze::images {

namespace {

// Of a tile, in vectors, rows and planes: what a row of all shifts needs stays in the second-level cache, the sums of a
// tile in the third.
constexpr std::int64_t tile_length = 30, tile_ny = 16, tile_nz = 32;

// A line of n cut into the fewest parts of at most so many, as equal as can be: threads are done together.
struct Cuts {
    Cuts(std::int64_t line, std::int64_t most) : n(line), count((line + most - 1) / most) {}
    std::int64_t n, count;
    std::int64_t operator[](std::int64_t part) const { return n * part / count; }
};

// Each pair of voxels p and p + s is met once, at p, with s in one half of the search window. One of the two lies in
// the volume, so p may lie up to R before it or behind.
struct Frame {
    Frame(const NonLocalMeans& filter, Shape of)
        : shape(of),
          R(filter.search / 2),
          P(filter.neighbourhood / 2),
          Rz(filter.in_volume ? R : 0),
          Pz(filter.in_volume ? P : 0),
          length((of.nx + 2 * R + lanes - 1) / lanes)
    {
    }
    Shape shape;
    std::int64_t R, P, Rz, Pz;
    std::int64_t length;  // voxels along x of each strip: lane l of vector i of a row lies at x_of(i, l)
    std::int64_t x_of(std::int64_t i, std::int64_t lane) const { return i + length * lane - R; }
};

// The slices of a slab, mirrored outwards far enough for every tile, in the two forms that the loops read.
struct Slab {
    Slab(const Frame& frame)
        : margin(frame.R + frame.P),
          margin_y(frame.R + frame.P),
          margin_z(frame.Rz + frame.Pz),
          stride((frame.length + 2 * margin) * lanes),
          rows(frame.shape.ny + 2 * margin_y),
          planes(frame.shape.nz + 2 * margin_z)
    {
        for (std::int64_t i = 0; i < stride; ++i)
            source.push_back(
                static_cast<std::int32_t>(mirrored(frame.x_of(i / lanes - margin, i % lanes), frame.shape.nx)));
    }
    std::int64_t bytes() const { return 4 * stride * rows * planes; }
    // Where vector i of a row begins.
    std::size_t at(std::int64_t i, std::int64_t y, std::int64_t z) const
    {
        return static_cast<std::size_t>((i + margin) * lanes + stride * (y + margin_y + rows * (z + margin_z)));
    }
    void fill(std::int64_t plane, Shape shape, const PatchScale& scale, std::span<const std::uint8_t> slice)
    {
        parallel_ranges(rows, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t row = begin; row < end; ++row) {
                const std::uint8_t* from = slice.data() + shape.nx * mirrored(row - margin_y, shape.ny);
                const std::size_t to = at(-margin, row - margin_y, plane - margin_z);
                for (std::size_t i = 0; i < source.size(); ++i) {
                    const std::uint8_t v = from[source[i]];
                    scaled[to + i] = scale.scaled[v];
                    level[to + i] = static_cast<std::int16_t>(v << 7);
                }
            }
        });
    }

    std::int64_t margin;                // vectors before the first
    std::int64_t margin_y, margin_z;    // voxels before the first
    std::int64_t stride, rows, planes;  // values, rows, planes
    std::vector<std::int32_t> source;   // where along x each value of a row comes from
    Aligned<std::int16_t> scaled;       // for differences
    Aligned<std::int16_t> level;        // << 7, for sums
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
          sums_length_(tile_length + 2 * f_.R),
          sums_ny_(tile_ny + 2 * f_.R),
          sums_(static_cast<std::size_t>(sums_length_ * sums_ny_ * (tile_nz + f_.Rz) * sums_of_vector)),
          column_stride_((tile_length + n_ - 1) * lanes),
          column_(static_cast<std::size_t>((tile_ny + f_.R + 2 * f_.P + 2) * shifts_ * column_stride_)),
          weight_stride_(tile_length * lanes),
          weight_(static_cast<std::size_t>(shifts_ * weight_stride_))
    {
    }

    /// p in vectors [i0, i1), rows [y0, y1), planes [z0, z1); boxes at a face go on beyond it as far as some p + s lies
    /// in the volume.
    void filter(std::int64_t i0, std::int64_t i1, std::int64_t y0, std::int64_t y1, std::int64_t z0, std::int64_t z1)
    {
        i0_ = i0, length_ = i1 - i0, y0_ = y0, y1_ = y1, z0_ = z0, z1_ = z1;
        std::ranges::fill(sums_, 0);
        for (std::int64_t sz = 0; sz <= f_.Rz; ++sz)
            for (std::int64_t sy = sz == 0 ? 0 : -f_.R; sy <= f_.R; ++sy) add_shifts(sy, sz);
    }

    void add_to(Sums& sums)
    {
        const auto [nx, ny, nz] = f_.shape;
        const std::lock_guard guard(sums.lock);
        for (std::int64_t z = z0_; z < std::min(nz, z1_ + f_.Rz); ++z)
            for (std::int64_t y = std::max<std::int64_t>(0, y0_ - f_.R); y < std::min(ny, y1_ + f_.R); ++y)
                for (std::int64_t i = i0_ - f_.R; i < i0_ + length_ + f_.R; ++i) {
                    const std::int32_t* from = sums_at(i, y, z);
                    for (std::int64_t lane = 0; lane < lanes; ++lane) {
                        const std::int64_t x = f_.x_of(i, lane), at = lane % 2 * (lanes / 2) + lane / 2;
                        if (x < 0 || x >= nx) continue;
                        const auto to = static_cast<std::size_t>(x + nx * (y + ny * z));
                        sums.weighted[to] += from[at], sums.weights[to] += from[lanes + at];
                    }
                }
    }

private:
    std::int32_t* sums_at(std::int64_t i, std::int64_t y, std::int64_t z)
    {
        return &sums_[static_cast<std::size_t>(
            (i - i0_ + f_.R + sums_length_ * (y - y0_ + f_.R + sums_ny_ * (z - z0_))) * sums_of_vector)];
    }

    // The sums of a tile lie in the third-level cache: ask for a row while its weights are made.
    static void fetch(const std::int32_t* row, std::int64_t vectors)
    {
        for (std::int64_t i = 0; i < vectors * sums_of_vector; i += 16) __builtin_prefetch(row + i, 1, 2);
    }

    // All shifts (sx, sy, sz) with the same sy and sz: they read the same rows, so their sums share the accumulators.
    void add_shifts(std::int64_t sy, std::int64_t sz)
    {
        const std::int64_t ny = f_.shape.ny, nz = f_.shape.nz;
        const std::int64_t first_sx = sy == 0 && sz == 0 ? 1 : -f_.R;
        const std::int64_t y_low = y0_ == 0 ? std::min<std::int64_t>(0, -sy) : y0_,
                           y_high = y1_ == ny ? std::max(ny, ny - sy) : y1_, z_low = z0_ == 0 ? -sz : z0_;
        PatchRow r;
        r.length = length_, r.count = f_.R - first_sx + 1, r.neighbourhood = n_;
        r.column_stride = column_stride_, r.weight_stride = weight_stride_;
        r.weight = weight_.data();
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
                look(r, y, z == z_low ? z - f_.Pz : z + f_.Pz, first_sx, sy, sz);
                if (z == z_low) start_columns(r, scale_, 2 * f_.Pz + 1, slab_.rows * slab_.stride);
                const bool complete = centre >= y_low;
                const bool here = complete && z >= 0 && centre >= 0 && centre < ny;
                const bool there = complete && z + sz < nz && centre + sy >= 0 && centre + sy < ny;
                if (here) fetch(sums_at(i0_, centre, z), length_);
                if (there) fetch(sums_at(i0_ - f_.R, centre + sy, z + sz), length_ + 2 * f_.R);
                weigh_row(r, scale_, z == z_low, here || there);
                WeightedRows rows{r.weight, weight_stride_, r.count, length_, first_sx, nullptr};
                if (here) {
                    rows.level = &slab_.level[slab_.at(i0_, centre + sy, z + sz)];
                    add_here(rows, sums_at(i0_, centre, z));
                }
                if (there) {
                    rows.level = &slab_.level[slab_.at(i0_, centre, z)];
                    add_there(rows, sums_at(i0_, centre + sy, z + sz));
                }
            }
        }
    }

    void look(PatchRow& r, std::int64_t y, std::int64_t z, std::int64_t sx, std::int64_t sy, std::int64_t sz)
    {
        const std::int64_t i = i0_ - f_.P, back = slab_.rows * slab_.stride * (2 * f_.Pz + 1);
        r.p_new = slab_.scaled.data() + slab_.at(i, y, z);
        r.ps_new = slab_.scaled.data() + slab_.at(i + sx, y + sy, z + sz);
        r.p_old = r.p_new - back, r.ps_old = r.ps_new - back;
    }

    const Frame& f_;
    const PatchScale& scale_;
    const Slab& slab_;
    std::int64_t shifts_, n_;
    std::int64_t i0_ = 0, length_ = 0, y0_ = 0, y1_ = 0, z0_ = 0, z1_ = 0;
    std::int64_t sums_length_, sums_ny_;
    Aligned<std::int32_t> sums_;
    std::int64_t column_stride_;
    Aligned<std::uint16_t> column_;  // per row and shift: squares summed along z; before them a row of zeros and one of
                                     // columns summed along y
    std::int64_t weight_stride_;
    Aligned<std::uint16_t> weight_;  // per shift: the row of weights just made
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
    const Cuts along(frame.length, tile_length), down(ny, tile_ny), deep(nz, tile_nz);
    const std::int64_t tiles = along.count * down.count * deep.count;
    std::vector<std::unique_ptr<Tile>> workers;
    std::vector<Tile*> idle;
    std::mutex lock;
    parallel_tasks(tiles, [&](std::int64_t task) {
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
        const std::int64_t i = task % along.count, y = task / along.count % down.count,
                           z = task / along.count / down.count;
        tile->filter(along[i], along[i + 1], down[y], down[y + 1], deep[z], deep[z + 1]);
        tile->add_to(sums);
        const std::lock_guard guard(lock);
        idle.push_back(tile);
        if (advance) advance(1.0 / static_cast<double>(tiles));
    });
    parallel_ranges(static_cast<std::int64_t>(sums.weights.size()), [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
            result.values()[i] = level_of(result.values()[i], sums.weighted[i], sums.weights[i], scale.one);
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
