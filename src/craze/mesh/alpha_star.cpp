#include "craze/mesh/alpha_star.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace craze::mesh {

namespace {

using Word = Mask::Word;

constexpr std::int32_t unknown = -1, never = -2;

int dot(const Offset& a, const Offset& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Offset cross(const Offset& a, const Offset& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Offset operator-(const Offset& a, const Offset& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Offset operator+(const Offset& a, const Offset& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Offset operator*(int s, const Offset& a) { return {s * a.x, s * a.y, s * a.z}; }

// `count` (< 64) bits of a row from voxel `x` on, which may begin before the row and end after it.
Word bits_from(std::span<const Word> row, std::int64_t x, int count)
{
    const std::int64_t w = x >> 6, n = static_cast<std::int64_t>(row.size());
    const auto shift = static_cast<unsigned>(x & 63);
    const Word low = w >= 0 && w < n ? row[static_cast<std::size_t>(w)] : 0;
    const Word high = w + 1 >= 0 && w + 1 < n ? row[static_cast<std::size_t>(w + 1)] : 0;
    const Word bits = shift == 0 ? low : low >> shift | high << (64 - shift);
    return bits & ((Word{1} << count) - 1);
}

}  // namespace

Neighbourhood::Neighbourhood(double alpha)
{
    const double limit = 4.0 * alpha * alpha;
    const int reach = static_cast<int>(2.0 * alpha);
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y) {
            const double rest = limit - y * y - z * z;
            if (rest < 0.0) continue;
            const int r = static_cast<int>(std::sqrt(rest));
            rows_.push_back({y, z, r, offsets_.size()});
            for (int x = -r; x <= r; ++x) offsets_.push_back({x, y, z});
        }
}

void Neighbourhood::gather(const Mask& mask, std::int64_t x, std::int64_t y, std::int64_t z,
                           std::span<Word> occupied) const
{
    const Shape& s = mask.shape();
    std::ranges::fill(occupied, Word{0});
    for (const Row& row : rows_) {
        const std::int64_t yy = y + row.dy, zz = z + row.dz;
        if (yy < 0 || yy >= s.ny || zz < 0 || zz >= s.nz) continue;
        const int count = 2 * row.reach + 1;
        const Word bits = bits_from(mask.row(yy, zz), x - row.reach, count);
        if (bits == 0) continue;
        const std::size_t word = row.first / 64, shift = row.first % 64;
        occupied[word] |= bits << shift;
        if (shift + static_cast<std::size_t>(count) > 64) occupied[word + 1] |= bits >> (64 - shift);
    }
}

AlphaStar::AlphaStar(const Neighbourhood& around, double alpha)
    : around_(around), alpha2_(alpha * alpha), cuts_edge_(around.size() - around.middle() - 1)
{
    index_.assign(cuts_edge_.size() * cuts_edge_.size(), unknown);
    // All balls of radius alpha and less through 0 and d hold the points that see them at a wide enough angle.
    for (std::size_t i = 0; i < cuts_edge_.size(); ++i) {
        const Offset d = around[around.middle() + 1 + i];
        const double free = std::sqrt(std::max(0.0, alpha2_ - 0.25 * dot(d, d)));
        for (std::size_t k = 0; k < around.size(); ++k) {
            const Offset s = around[k];
            const Offset c = cross(s, d);
            const double off_axis = std::sqrt(static_cast<double>(dot(c, c)) / dot(d, d));
            if (!(dot(s, d) - 2.0 * off_axis * free > dot(s, s) + 1e-9)) continue;
            const auto word = static_cast<std::uint32_t>(k / 64);
            if (cuts_edge_[i].empty() || cuts_edge_[i].back().word != word) cuts_edge_[i].push_back({word, 0});
            cuts_edge_[i].back().mask |= Word{1} << (k % 64);
        }
    }
}

std::uint32_t AlphaStar::append(const std::vector<std::size_t>& offsets)
{
    const std::size_t begin = bits_.size();
    for (const std::size_t k : offsets) {
        const auto word = static_cast<std::uint32_t>(k / 64);
        if (bits_.size() == begin || bits_.back().word != word) bits_.push_back({word, 0});
        bits_.back().mask |= Word{1} << (k % 64);
    }
    return static_cast<std::uint32_t>(begin);
}

// Spheres through 0, q, r have their centres at (C + w n) / (2 n.n), n = q x r, C.n = 0. A point s lies outside while
// w s.n <= A = s.s n.n - s.C: an upper bound of w where s is above the triangle, a lower one where it is below. If
// both sides have a bound within reach of alpha, the triangle has a tetrahedron of the shape on either side, or none
// of the spheres is empty: it is not seen in both cases, so the bounds themselves need not be compared.
std::int32_t AlphaStar::work_out(std::size_t q_index, std::size_t r_index)
{
    const Offset q = around_[q_index], r = around_[r_index];
    const Offset n = cross(q, r);
    const int nn = dot(n, n);
    if (nn == 0) return never;
    const Offset C = dot(q, q) * cross(r, n) + dot(r, r) * cross(n, q);
    const double CC = static_cast<double>(C.x) * C.x + static_cast<double>(C.y) * C.y + static_cast<double>(C.z) * C.z;
    const double limit = 4.0 * alpha2_ * nn * nn;  // the integers multiplied here stay below 2^53
    if (CC > limit) return never;

    std::vector<std::size_t> forbid, above, below;
    for (std::size_t k = 0; k < around_.size(); ++k) {
        if (k == around_.middle() || k == q_index || k == r_index) continue;
        const Offset s = around_[k];
        const int B = dot(s, n), A = dot(s, s) * nn - dot(s, C);
        if (B == 0) {
            // On the circle: the fan of a face starts at its first corner, and its triangles have no corner between.
            const bool spoils_fan = k < around_.middle() || dot(cross(r - q, s - q), n) < 0;
            if (A < 0 || (A == 0 && spoils_fan)) forbid.push_back(k);
            continue;
        }
        const double a = A, b = B;
        if (CC * b * b + a * a * nn <= limit * b * b)
            (B > 0 ? above : below).push_back(k);
        else if (A < 0)
            forbid.push_back(k);
    }
    Triple t{};
    t.forbid = append(forbid);
    t.above = append(above);
    t.below = append(below);
    t.end = static_cast<std::uint32_t>(bits_.size());
    triples_.push_back(t);
    return static_cast<std::int32_t>(triples_.size()) - 1;
}

std::int32_t AlphaStar::triple(std::size_t q, std::size_t r)
{
    const std::size_t first = around_.middle() + 1;
    std::int32_t& known = index_[(q - first) * cuts_edge_.size() + (r - first)];
    if (known == unknown) known = work_out(q, r);
    return known;
}

std::span<const AlphaStar::Triangle> AlphaStar::of(std::span<const Word> occupied)
{
    ends_.clear();
    found_.clear();
    const std::size_t first = around_.middle() + 1;
    for (std::size_t w = first / 64; w < occupied.size(); ++w) {
        Word rest = occupied[w];
        if (w == first / 64) rest &= ~Word{0} << (first % 64);
        for (; rest != 0; rest &= rest - 1) {
            const std::size_t q = w * 64 + static_cast<std::size_t>(std::countr_zero(rest));
            const auto& cuts = cuts_edge_[q - first];
            if (std::ranges::none_of(cuts, [&](const Bits& b) { return (occupied[b.word] & b.mask) != 0; }))
                ends_.push_back(q);
        }
    }
    for (std::size_t i = 0; i < ends_.size(); ++i)
        for (std::size_t j = i + 1; j < ends_.size(); ++j) {
            const std::int32_t known = triple(ends_[i], ends_[j]);
            if (known < 0) continue;
            const Triple& t = triples_[static_cast<std::size_t>(known)];
            if (any(occupied, t.forbid, t.above)) continue;
            const bool above = any(occupied, t.above, t.below), below = any(occupied, t.below, t.end);
            if (above && below) continue;
            if (above)
                found_.push_back({ends_[j], ends_[i], 1});
            else
                found_.push_back({ends_[i], ends_[j], static_cast<std::uint8_t>(below ? 1 : 2)});
        }
    return found_;
}

}  // namespace craze::mesh
