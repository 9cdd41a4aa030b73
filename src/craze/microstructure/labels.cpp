#include "craze/microstructure/labels.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"

#include <bit>
#include <limits>

namespace craze::microstructure {

namespace {

using Word = Mask::Word;

// Calls found(first, last) for each run of ones.
template <class Found>
void for_runs(std::span<const Word> row, Found&& found)
{
    bool open = false;
    std::int32_t first = 0;
    for (std::size_t w = 0; w < row.size(); ++w) {
        // A bit is set where a run begins or has just ended.
        const Word word = row[w];
        Word edges = word ^ ((word << 1U) | (open ? 1U : 0U));
        const auto base = static_cast<std::int32_t>(w * 64);
        while (edges != 0) {
            const std::int32_t x = base + std::countr_zero(edges);
            edges &= edges - 1;
            if (open)
                found(first, x - 1);
            else
                first = x;
            open = !open;
        }
    }
    if (open) found(first, static_cast<std::int32_t>(row.size() * 64) - 1);
}

std::int32_t root_of(std::int32_t* parent, std::int32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

// The smaller index becomes the root: the result does not depend on the order of unions.
void unite(std::int32_t* parent, std::int32_t i, std::int32_t j)
{
    i = root_of(parent, i);
    j = root_of(parent, j);
    if (i < j)
        parent[j] = i;
    else
        parent[i] = j;
}

struct Joiner {
    const Components& c;
    std::int32_t* parent;

    // Unites runs of rows a and b that overlap when widened by `reach`.
    void rows(std::int64_t a, std::int64_t b, std::int32_t reach) const
    {
        const Run* runs = c.runs.data();
        auto i = c.row_begin[static_cast<std::size_t>(a)], j = c.row_begin[static_cast<std::size_t>(b)];
        const auto i_end = c.row_begin[static_cast<std::size_t>(a) + 1];
        const auto j_end = c.row_begin[static_cast<std::size_t>(b) + 1];
        while (i < i_end && j < j_end) {
            if (runs[i].first <= runs[j].last + reach && runs[j].first <= runs[i].last + reach)
                unite(parent, static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
            if (runs[i].last < runs[j].last)
                ++i;
            else
                ++j;
        }
    }

    void slices(std::int64_t z, Connectivity connectivity) const
    {
        const std::int64_t ny = c.shape.ny;
        const int reach = connectivity == Connectivity::faces ? 0 : 1;
        for (std::int64_t y = 0; y < ny; ++y) {
            const std::int64_t row = y + ny * z, under = row - ny;
            rows(row, under, reach);
            if (connectivity == Connectivity::faces) continue;
            const int diagonal = connectivity == Connectivity::corners ? 1 : 0;
            if (y > 0) rows(row, under - 1, diagonal);
            if (y + 1 < ny) rows(row, under + 1, diagonal);
        }
    }

    void within(std::int64_t z, Connectivity connectivity) const
    {
        for (std::int64_t y = 1; y < c.shape.ny; ++y) {
            const std::int64_t row = y + c.shape.ny * z;
            rows(row, row - 1, connectivity == Connectivity::faces ? 0 : 1);
        }
    }
};

void find_runs(const Mask& mask, Components& c)
{
    const Shape& s = c.shape;
    const std::int64_t rows = s.ny * s.nz;
    c.row_begin.assign(static_cast<std::size_t>(rows) + 1, 0);
    parallel_ranges(rows, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            std::int64_t n = 0;
            for_runs(mask.row(r % s.ny, r / s.ny), [&](std::int32_t, std::int32_t) { ++n; });
            c.row_begin[static_cast<std::size_t>(r) + 1] = n;
        }
    });
    for (std::size_t r = 1; r < c.row_begin.size(); ++r) c.row_begin[r] += c.row_begin[r - 1];
    if (c.row_begin.back() > std::numeric_limits<std::int32_t>::max())
        throw ComputationFailed("labels: the mask has more than 2^31 runs of voxels; clean or crop the volume");
    c.runs.resize(static_cast<std::size_t>(c.row_begin.back()));
    parallel_ranges(rows, [&](std::int64_t begin, std::int64_t end) {
        Run* out = c.runs.data() + c.row_begin[static_cast<std::size_t>(begin)];
        for (std::int64_t r = begin; r < end; ++r)
            for_runs(mask.row(r % s.ny, r / s.ny), [&](std::int32_t first, std::int32_t last) {
                *out++ = Run{first, last, 0};
            });
    });
}

}  // namespace

Components components(const Mask& mask, Connectivity connectivity)
{
    Components c;
    c.shape = mask.shape();
    if (mask.empty()) {
        c.row_begin.assign(1, 0);
        return c;
    }
    find_runs(mask, c);
    std::vector<std::int32_t> parent(c.runs.size());
    for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<std::int32_t>(i);
    const Joiner join{c, parent.data()};
    // Slabs first, each on its own; then the planes between them.
    std::vector<std::uint8_t> between(static_cast<std::size_t>(c.shape.nz), 0);
    parallel_ranges(c.shape.nz, [&](std::int64_t begin, std::int64_t end) {
        between[static_cast<std::size_t>(begin)] = begin > 0 ? 1 : 0;
        for (std::int64_t z = begin; z < end; ++z) {
            join.within(z, connectivity);
            if (z > begin) join.slices(z, connectivity);
        }
    });
    for (std::int64_t z = 1; z < c.shape.nz; ++z)
        if (between[static_cast<std::size_t>(z)] != 0) join.slices(z, connectivity);
    // A root precedes its members.
    for (std::size_t i = 0; i < parent.size(); ++i) {
        const auto p = static_cast<std::size_t>(parent[i]);
        c.runs[i].label = p == i ? c.count++ : c.runs[p].label;
    }
    return c;
}

std::vector<std::int64_t> volumes(const Components& c)
{
    std::vector<std::int64_t> volume(static_cast<std::size_t>(c.count), 0);
    for (const Run& run : c.runs) volume[static_cast<std::size_t>(run.label)] += run.length();
    return volume;
}

Volume<std::int32_t> painted(const Components& c)
{
    const Shape& s = c.shape;
    Volume<std::int32_t> labels(s);
    parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            const auto row = labels.row(r % s.ny, r / s.ny);
            std::fill(row.begin(), row.end(), 0);
            const auto from = c.row_begin[static_cast<std::size_t>(r)],
                       to = c.row_begin[static_cast<std::size_t>(r) + 1];
            for (auto i = from; i < to; ++i) {
                const Run& run = c.runs[static_cast<std::size_t>(i)];
                std::fill(row.begin() + run.first, row.begin() + run.last + 1, run.label + 1);
            }
        }
    });
    return labels;
}

Mask selected(const Components& c, const std::vector<std::uint8_t>& keep)
{
    const Shape& s = c.shape;
    Mask mask(s);
    parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            const auto row = mask.row(r % s.ny, r / s.ny);
            const auto from = c.row_begin[static_cast<std::size_t>(r)],
                       to = c.row_begin[static_cast<std::size_t>(r) + 1];
            for (auto i = from; i < to; ++i) {
                const Run& run = c.runs[static_cast<std::size_t>(i)];
                if (keep[static_cast<std::size_t>(run.label)] == 0) continue;
                const auto a = static_cast<std::size_t>(run.first >> 6), b = static_cast<std::size_t>(run.last >> 6);
                const Word head = ~Word{0} << (run.first & 63), foot = ~Word{0} >> (63 - (run.last & 63));
                if (a == b) {
                    row[a] |= head & foot;
                } else {
                    row[a] |= head;
                    for (std::size_t w = a + 1; w < b; ++w) row[w] = ~Word{0};
                    row[b] |= foot;
                }
            }
        }
    });
    return mask;
}

}  // namespace craze::microstructure
