#include "craze/mechanics/vectors.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace craze::mechanics {

namespace {

constexpr std::int64_t block = 6 * 512;
constexpr std::int64_t wide = 12;  // running sums, a multiple of six and of four

/// Sum of the running sums, always in the same order.
CRAZE_INLINE double total(const double* s)
{
    double t = 0.0;
    for (int k = 0; k < wide; ++k) t += s[k];
    return t;
}

CRAZE_MULTIVERSION double dot_block(const double* a, const double* b, std::int64_t n)
{
    double s[wide] = {};
    std::int64_t k = 0;
    for (; k + wide <= n; k += wide)
        for (std::int64_t c = 0; c < wide; ++c) s[c] += a[k + c] * b[k + c];
    for (; k < n; ++k) s[k % wide] += a[k] * b[k];
    return total(s);
}

CRAZE_MULTIVERSION double square_block(const double* r, const double* weight, std::int64_t n)
{
    double s[wide] = {};
    std::int64_t k = 0;
    for (; k + wide <= n; k += wide)
        for (std::int64_t c = 0; c < wide; ++c) s[c] += weight[c] * r[k + c] * r[k + c];
    for (; k < n; ++k) s[k % wide] += weight[k % wide] * r[k] * r[k];
    return total(s);
}

CRAZE_MULTIVERSION void add_block(double* y, double s, const double* x, std::int64_t n)
{
    for (std::int64_t k = 0; k < n; ++k) y[k] += s * x[k];
}

/// Calls work(begin, length) on fixed blocks and adds what it gives in their order.
template <class Work>
double over_blocks(std::int64_t n, Work&& work)
{
    const std::int64_t blocks = (n + block - 1) / block;
    std::vector<double> part(static_cast<std::size_t>(blocks));
    parallel_ranges(blocks, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t b = begin; b < end; ++b)
            part[static_cast<std::size_t>(b)] = work(b * block, std::min(block, n - b * block));
    });
    double sum = 0.0;
    for (const double p : part) sum += p;
    return sum;
}

struct Weights {
    double value[wide];
    explicit Weights(double inv_radius)
    {
        for (int k = 0; k < wide; ++k) value[k] = k % 6 < 3 ? 1.0 : inv_radius * inv_radius;
    }
};

}  // namespace

double dot(std::span<const double> a, std::span<const double> b)
{
    assert(a.size() == b.size());
    return over_blocks(std::ssize(a),
                       [&](std::int64_t at, std::int64_t n) { return dot_block(a.data() + at, b.data() + at, n); });
}

void add_scaled(std::span<double> y, double s, std::span<const double> x)
{
    parallel_ranges(std::ssize(y), [&](std::int64_t begin, std::int64_t end) {
        add_block(y.data() + begin, s, x.data() + begin, end - begin);
    });
}

double weighted_square(std::span<const double> r, double inv_radius)
{
    const Weights weights(inv_radius);
    return over_blocks(std::ssize(r),
                       [&](std::int64_t at, std::int64_t n) { return square_block(r.data() + at, weights.value, n); });
}

}  // namespace craze::mechanics
