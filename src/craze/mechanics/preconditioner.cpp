#include "craze/mechanics/preconditioner.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/lanes.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace craze::mechanics {

namespace {

using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Inverse of a symmetric positive semi-definite block, scaled to a unit diagonal and shifted a little so that a
/// direction without stiffness is finite; empty rows stay empty.
Block safe_inverse(const Block& block)
{
    constexpr double shift = 1e-3;
    Eigen::Matrix<double, 6, 1> scale;
    for (int c = 0; c < 6; ++c) scale[c] = block(c, c) > 0.0 ? 1.0 / std::sqrt(block(c, c)) : 0.0;
    Block unit = scale.asDiagonal() * block * scale.asDiagonal();
    for (int c = 0; c < 6; ++c) unit(c, c) = scale[c] > 0.0 ? 1.0 + shift : 1.0;
    const Block inverse = unit.llt().solve(Block::Identity());
    return scale.asDiagonal() * inverse * scale.asDiagonal();
}

CRAZE_MULTIVERSION void apply_blocks(const double* inverse, const double* r, double* z, std::int64_t begin,
                                     std::int64_t end)
{
    for (std::int64_t e = begin; e < end; ++e) {
        const double *row = inverse + 36 * e, *in = r + 6 * e;
        Lanes head{};
        Pair tail{};
        for (int c = 0; c < 6; ++c) {
            head += load(row + 6 * c) * in[c];
            tail += load_pair(row + 6 * c + 4) * in[c];
        }
        store(z + 6 * e, head), store(z + 6 * e + 4, tail);
    }
}

}  // namespace

void BlockJacobi::set_up(const Stiffness& stiffness, std::span<const std::int64_t> imposed)
{
    const std::int64_t n = stiffness.elements();
    inverse_.assign(static_cast<std::size_t>(36 * n), 0.0);
    stiffness.diagonal(inverse_);
    for (const std::int64_t dof : imposed)
        for (std::int64_t c = 0; c < 6; ++c) {
            const std::int64_t e = dof / 6, k = dof % 6;
            inverse_[static_cast<std::size_t>(36 * e + 6 * k + c)] = 0.0;
            inverse_[static_cast<std::size_t>(36 * e + 6 * c + k)] = 0.0;
        }
    parallel_ranges(n, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t e = begin; e < end; ++e) {
            Eigen::Map<Block> block(inverse_.data() + 36 * e);
            block = safe_inverse(block);
        }
    });
}

void BlockJacobi::apply(std::span<const double> r, std::span<double> z) const
{
    parallel_ranges(std::ssize(r) / 6, [&](std::int64_t begin, std::int64_t end) {
        apply_blocks(inverse_.data(), r.data(), z.data(), begin, end);
    });
}

}  // namespace craze::mechanics
