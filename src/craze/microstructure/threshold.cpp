#include "craze/microstructure/threshold.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace craze::microstructure {

namespace {

using Real = long double;  // third moments of 256 levels leave few digits of a double

std::array<Real, 256> normalized(const Histogram& h)
{
    Real total = 0;
    for (const auto n : h) total += static_cast<Real>(n);
    std::array<Real, 256> p{};
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = static_cast<Real>(h[i]) / total;
    return p;
}

bool single_level(const Histogram& h)
{
    return std::count_if(h.begin(), h.end(), [](std::int64_t n) { return n > 0; }) < 2;
}

// Four counters per level: equal neighbours would wait for each other's store.
void count_levels(const std::uint8_t* gray, std::size_t n, Histogram& total)
{
    std::array<std::array<std::uint32_t, 256>, 4> part{};
    std::size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (std::size_t k = 0; k < 4; ++k) ++part[k][gray[i + k]];
    for (; i < n; ++i) ++part[0][gray[i]];
    for (std::size_t level = 0; level < 256; ++level)
        for (std::size_t k = 0; k < 4; ++k) total[level] += part[k][level];
}

CRAZE_MULTIVERSION void pack_row(const std::uint8_t* gray, std::int64_t nx, int S, Mask::Word* row)
{
    for (std::int64_t x0 = 0; x0 < nx; x0 += 64) {
        std::uint8_t flag[64] = {};
        const auto n = static_cast<int>(std::min<std::int64_t>(64, nx - x0));
        for (int i = 0; i < n; ++i) flag[i] = gray[x0 + i] >= S ? 1 : 0;
        Mask::Word word = 0;
        for (int byte = 0; byte < 8; ++byte) {
            std::uint64_t eight = 0;
            std::memcpy(&eight, flag + 8 * byte, 8);
            // Gathers the lowest bits of eight bytes into the highest byte.
            word |= ((eight * 0x0102040810204080U) >> 56U) << (8 * byte);
        }
        row[x0 >> 6] = word;
    }
}

}  // namespace

Histogram histogram(const Volume<std::uint8_t>& gray)
{
    constexpr std::int64_t block = std::int64_t{1} << 22;
    const std::int64_t n = gray.shape().voxels(), blocks = (n + block - 1) / block;
    std::vector<Histogram> parts(static_cast<std::size_t>(blocks), Histogram{});
    parallel_tasks(blocks, [&](std::int64_t b) {
        count_levels(gray.data() + b * block, static_cast<std::size_t>(std::min(block, n - b * block)),
                     parts[static_cast<std::size_t>(b)]);
    });
    Histogram total{};
    for (const Histogram& part : parts)
        for (std::size_t i = 0; i < 256; ++i) total[i] += part[i];
    return total;
}

std::optional<TwoLevels> preserving_moments(const Histogram& h)
{
    if (single_level(h)) return std::nullopt;
    const auto p = normalized(h);
    Real m1 = 0, m2 = 0, m3 = 0;
    for (std::size_t i = 0; i < 256; ++i) {
        const auto level = static_cast<Real>(i);
        m1 += level * p[i];
        m2 += level * level * p[i];
        m3 += level * level * level * p[i];
    }
    const Real cd = m2 - m1 * m1;
    const Real c0 = (m1 * m3 - m2 * m2) / cd;
    const Real c1 = (m1 * m2 - m3) / cd;
    const Real root = std::sqrt(std::max<Real>(0, c1 * c1 - 4 * c0));
    const Real z0 = (-c1 - root) / 2, z1 = (-c1 + root) / 2;
    return TwoLevels{static_cast<double>(z0), static_cast<double>(z1), static_cast<double>((z1 - m1) / (z1 - z0))};
}

std::optional<int> moments_threshold(const Histogram& h)
{
    const auto two = preserving_moments(h);
    if (!two) return std::nullopt;
    const auto p = normalized(h);
    Real cumulative = 0;
    for (int t = 0; t < 255; ++t) {
        cumulative += p[static_cast<std::size_t>(t)];
        // In an image of two levels the sum meets p0 exactly: rounding must not decide.
        if (cumulative > static_cast<Real>(two->p0) - 1e-10L) return t + 1;
    }
    return 255;
}

std::optional<int> otsu_threshold(const Histogram& h)
{
    if (single_level(h)) return std::nullopt;
    const auto p = normalized(h);
    Real mean = 0;
    for (std::size_t i = 0; i < 256; ++i) mean += static_cast<Real>(i) * p[i];
    Real P = 0, m = 0, best = -1;
    int best_t = 0;
    for (int t = 0; t < 255; ++t) {
        P += p[static_cast<std::size_t>(t)];
        m += static_cast<Real>(t) * p[static_cast<std::size_t>(t)];
        if (!(P > 0) || !(1 - P > 1e-15L)) continue;
        const Real between = (mean * P - m) * (mean * P - m) / (P * (1 - P));
        if (between >= best) best = between, best_t = t;
    }
    return best_t + 1;
}

std::optional<int> entropy_threshold(const Histogram& h)
{
    if (single_level(h)) return std::nullopt;
    const auto p = normalized(h);
    // -sum (p_i/P) ln(p_i/P) = ln P - (sum p_i ln p_i) / P
    const auto p_ln_p = [&](std::size_t i) { return p[i] > 0 ? p[i] * std::log(p[i]) : Real{0}; };
    Real all = 0;
    for (std::size_t i = 0; i < 256; ++i) all += p_ln_p(i);
    Real P = 0, below = 0, best = -1;
    int best_t = 0;
    for (int t = 0; t < 255; ++t) {
        P += p[static_cast<std::size_t>(t)];
        below += p_ln_p(static_cast<std::size_t>(t));
        if (!(P > 0) || !(1 - P > 1e-15L)) continue;
        const Real entropy = std::log(P) - below / P + std::log(1 - P) - (all - below) / (1 - P);
        if (entropy > best) best = entropy, best_t = t;
    }
    return best_t + 1;
}

Mask matter_of(const Volume<std::uint8_t>& gray, int S)
{
    const Shape shape = gray.shape();
    Mask matter(shape);
    parallel_ranges(shape.ny * shape.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r)
            pack_row(gray.row(r % shape.ny, r / shape.ny).data(), shape.nx, S,
                     matter.row(r % shape.ny, r / shape.ny).data());
    });
    return matter;
}

}  // namespace craze::microstructure
