#include "craze/microstructure/sheets.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"
#include "craze/microstructure/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::microstructure {

namespace {

constexpr std::int64_t thick = 16;  // slices smoothed together

// Half of a Gaussian, normalised: weight[k] for offsets +-k.
std::vector<float> gaussian(double sigma)
{
    const auto reach = static_cast<std::size_t>(std::ceil(4 * sigma));
    std::vector<double> w(reach + 1);
    double sum = 0;
    for (std::size_t k = 0; k <= reach; ++k) {
        w[k] = std::exp(-0.5 * static_cast<double>(k * k) / (sigma * sigma));
        sum += k == 0 ? w[k] : 2 * w[k];
    }
    std::vector<float> weights;
    for (const double v : w) weights.push_back(static_cast<float>(v / sum));
    return weights;
}

// The nearest row inside: gray levels go on as they end.
std::int64_t inside(std::int64_t i, std::int64_t n) { return std::clamp<std::int64_t>(i, 0, n - 1); }

CRAZE_INLINE void add_rows(const float* __restrict a, const float* __restrict b, float weight, float* __restrict to,
                           std::int64_t n)
{
    for (std::int64_t i = 0; i < n; ++i) to[i] += weight * (a[i] + b[i]);
}

// Rows of one slice of gray levels, smoothed along z. `slices` points to the slices z - reach ... z + reach.
CRAZE_MULTIVERSION void along_z(const std::uint8_t* const* slices, const std::vector<float>& weight, float* to,
                                std::int64_t n)
{
    const auto reach = static_cast<std::int64_t>(weight.size()) - 1;
    const std::uint8_t* __restrict centre = slices[reach];
    for (std::int64_t i = 0; i < n; ++i) to[i] = weight[0] * static_cast<float>(centre[i]);
    for (std::int64_t k = 1; k <= reach; ++k) {
        const std::uint8_t* __restrict a = slices[reach - k];
        const std::uint8_t* __restrict b = slices[reach + k];
        const float w = weight[static_cast<std::size_t>(k)];
        for (std::int64_t i = 0; i < n; ++i) to[i] += w * static_cast<float>(a[i] + b[i]);
    }
}

CRAZE_MULTIVERSION void along_y(const float* slice, const std::vector<float>& weight, float* to, std::int64_t nx,
                                std::int64_t ny)
{
    for (std::int64_t y = 0; y < ny; ++y) {
        float* row = to + y * nx;
        for (std::int64_t x = 0; x < nx; ++x) row[x] = weight[0] * slice[y * nx + x];
        for (std::int64_t k = 1; k < static_cast<std::int64_t>(weight.size()); ++k)
            add_rows(slice + inside(y - k, ny) * nx, slice + inside(y + k, ny) * nx,
                     weight[static_cast<std::size_t>(k)], row, nx);
    }
}

// `padded` has room for a row and the reach on either side.
CRAZE_MULTIVERSION void along_x(float* row, const std::vector<float>& weight, float* padded, std::int64_t nx)
{
    const auto reach = static_cast<std::int64_t>(weight.size()) - 1;
    float* middle = padded + reach;
    std::fill_n(padded, reach, row[0]);
    std::copy_n(row, nx, middle);
    std::fill_n(middle + nx, reach, row[nx - 1]);
    for (std::int64_t x = 0; x < nx; ++x) row[x] = weight[0] * middle[x];
    for (std::int64_t k = 1; k <= reach; ++k)
        add_rows(middle - k, middle + k, weight[static_cast<std::size_t>(k)], row, nx);
}

// Largest eigenvalue less the larger magnitude of the other two, of a symmetric matrix (Smith 1961).
float sheetness(float xx, float yy, float zz, float xy, float xz, float yz)
{
    const float mean = (xx + yy + zz) / 3;
    const float a = xx - mean, b = yy - mean, c = zz - mean;
    const float p2 = (a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6;
    if (!(p2 > 0)) return 0;
    const float p = std::sqrt(p2);
    const float det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    const float angle = std::acos(std::clamp(det / (2 * p2 * p), -1.0F, 1.0F)) / 3;
    const float largest = mean + 2 * p * std::cos(angle);
    const float least = mean + 2 * p * std::cos(angle + 2 * std::numbers::pi_v<float> / 3);
    const float middle = 3 * mean - largest - least;
    return largest - std::max(std::abs(middle), std::abs(least));
}

// Second differences need a neighbour on either side: the voxels of a face take those of the voxel before it, so that a
// slope that ends at the face is not taken for a valley.
std::int64_t with_neighbours(std::int64_t i, std::int64_t n)
{
    return n < 3 ? i : std::clamp<std::int64_t>(i, 1, n - 2);
}

// One slice of responses from three smoothed slices.
void respond(const float* below, const float* at, const float* above, std::int64_t nx, std::int64_t ny, float scale2,
             float* to)
{
    for (std::int64_t y = 0; y < ny; ++y) {
        const std::int64_t row = with_neighbours(y, ny), here = row * nx;
        const std::int64_t up = inside(row - 1, ny) * nx, down = inside(row + 1, ny) * nx;
        for (std::int64_t x = 0; x < nx; ++x) {
            const std::int64_t c = with_neighbours(x, nx), l = inside(c - 1, nx), r = inside(c + 1, nx);
            const float twice = 2 * at[here + c];
            const float xx = at[here + l] + at[here + r] - twice, yy = at[up + c] + at[down + c] - twice,
                        zz = below[here + c] + above[here + c] - twice;
            if (!(xx + yy + zz > 0)) continue;
            const float xy = 0.25F * (at[down + r] + at[up + l] - at[down + l] - at[up + r]);
            const float xz = 0.25F * (above[here + r] + below[here + l] - above[here + l] - below[here + r]);
            const float yz = 0.25F * (above[down + c] + below[up + c] - above[up + c] - below[down + c]);
            to[y * nx + x] = std::max(to[y * nx + x], scale2 * sheetness(xx, yy, zz, xy, xz, yz));
        }
    }
}

// Slices [z0, z1) at one scale.
void respond_slab(const Volume<std::uint8_t>& gray, double sigma, std::int64_t z0, std::int64_t z1, Volume<float>& out)
{
    const Shape& s = gray.shape();
    const auto weight = gaussian(sigma);
    const auto reach = static_cast<std::int64_t>(weight.size()) - 1;
    const std::int64_t area = s.nx * s.ny;
    const std::int64_t first = std::max<std::int64_t>(0, std::min(z0 - 1, s.nz - 3)),
                       last = std::min(s.nz - 1, std::max<std::int64_t>(z1, 2));
    std::vector<float> smooth(static_cast<std::size_t>((last - first + 1) * area)), raw(static_cast<std::size_t>(area)),
        padded(static_cast<std::size_t>(s.nx + 2 * reach));
    std::vector<const std::uint8_t*> slices(static_cast<std::size_t>(2 * reach) + 1);
    for (std::int64_t z = first; z <= last; ++z) {
        for (std::int64_t k = -reach; k <= reach; ++k)
            slices[static_cast<std::size_t>(k + reach)] = gray.slice(inside(z + k, s.nz)).data();
        along_z(slices.data(), weight, raw.data(), area);
        float* to = smooth.data() + (z - first) * area;
        along_y(raw.data(), weight, to, s.nx, s.ny);
        for (std::int64_t y = 0; y < s.ny; ++y) along_x(to + y * s.nx, weight, padded.data(), s.nx);
    }
    for (std::int64_t z = z0; z < z1; ++z) {
        const std::int64_t c = with_neighbours(z, s.nz);
        const auto smoothed = [&](std::int64_t i) { return smooth.data() + (inside(i, s.nz) - first) * area; };
        respond(smoothed(c - 1), smoothed(c), smoothed(c + 1), s.nx, s.ny, static_cast<float>(sigma * sigma),
                out.slice(z).data());
    }
}

}  // namespace

Volume<float> sheet_response(const Volume<std::uint8_t>& gray, const std::vector<double>& scales)
{
    if (scales.empty()) throw InvalidInput("sheets: needs at least one scale");
    for (const double sigma : scales)
        if (!(sigma >= 0.5 && sigma <= 20))
            throw InvalidInput(fmt::format("sheets: a scale needs to be 0.5 to 20 px, got {}", sigma));
    const Shape& s = gray.shape();
    Volume<float> out(s, 0.0F);
    parallel_tasks((s.nz + thick - 1) / thick, [&](std::int64_t slab) {
        for (const double sigma : scales)
            respond_slab(gray, sigma, slab * thick, std::min(s.nz, (slab + 1) * thick), out);
    });
    return out;
}

Mask hysteresis(const Volume<float>& response, double low, double high, std::int64_t least)
{
    const Shape& s = response.shape();
    Mask weak(s);
    parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            const auto row = response.row(r % s.ny, r / s.ny);
            for (std::int64_t x = 0; x < s.nx; ++x)
                if (static_cast<double>(row[static_cast<std::size_t>(x)]) >= low) weak.set(x, r % s.ny, r / s.ny, true);
        }
    });
    const Components found = components(weak);
    const auto volume = volumes(found);
    std::vector<std::uint8_t> keep(static_cast<std::size_t>(found.count), 0);
    for (std::int64_t r = 0; r < s.ny * s.nz; ++r) {
        const auto row = response.row(r % s.ny, r / s.ny);
        for (auto i = found.row_begin[static_cast<std::size_t>(r)];
             i < found.row_begin[static_cast<std::size_t>(r) + 1]; ++i) {
            const Run& run = found.runs[static_cast<std::size_t>(i)];
            const auto label = static_cast<std::size_t>(run.label);
            if (keep[label] != 0 || volume[label] < least) continue;
            const float most = *std::max_element(row.begin() + run.first, row.begin() + run.last + 1);
            if (static_cast<double>(most) >= high) keep[label] = 1;
        }
    }
    return selected(found, keep);
}

}  // namespace craze::microstructure
