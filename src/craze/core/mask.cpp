#include "craze/core/mask.hpp"

#include "craze/core/parallel.hpp"

#include <bit>

namespace craze {

std::int64_t Mask::count() const
{
    std::int64_t total = 0;  // integers: any summation order gives the same bits
#pragma omp parallel for reduction(+ : total) schedule(static)
    for (std::size_t w = 0; w < words_.size(); ++w) total += std::popcount(words_[w]);
    return total;
}

namespace {

template <class Combine>
Mask combined(const Mask& a, const Mask& b, Combine combine)
{
    assert(a.shape() == b.shape());
    Mask out(a.shape());
    const auto wa = a.words(), wb = b.words();
    const auto wo = out.words();
    parallel_ranges(static_cast<std::int64_t>(wo.size()), [&](std::int64_t begin, std::int64_t end) {
        for (auto w = static_cast<std::size_t>(begin); w < static_cast<std::size_t>(end); ++w)
            wo[w] = combine(wa[w], wb[w]);
    });
    return out;
}

}  // namespace

Mask complement(const Mask& a)
{
    Mask out(a.shape());
    const Shape& s = a.shape();
    const auto last = static_cast<std::size_t>(a.words_per_row() - 1);
    parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            const auto from = a.row(r % s.ny, r / s.ny);
            const auto to = out.row(r % s.ny, r / s.ny);
            for (std::size_t w = 0; w < to.size(); ++w) to[w] = ~from[w];
            to[last] &= a.tail();
        }
    });
    return out;
}

Mask intersection(const Mask& a, const Mask& b)
{
    return combined(a, b, [](Mask::Word u, Mask::Word v) { return u & v; });
}

Mask difference(const Mask& a, const Mask& b)
{
    return combined(a, b, [](Mask::Word u, Mask::Word v) { return u & ~v; });
}

}  // namespace craze
