#include "craze/mechanics/preconditioner.hpp"

#include "craze/core/parallel.hpp"
#include "craze/mechanics/lanes.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace craze::mechanics {

namespace {

using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// Inverse of a symmetric positive semi-definite block, scaled to a unit diagonal and shifted a little so that a
/// direction without stiffness is finite; rows that are held are empty and stay so.
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

CRAZE_MULTIVERSION void apply_blocks(const float* inverse, const double* r, double* z, std::int64_t begin,
                                     std::int64_t end)
{
    for (std::int64_t e = begin; e < end; ++e) {
        const float* row = inverse + 36 * e;
        const double* in = r + 6 * e;
        Lanes head{};
        Pair tail{};
        for (int c = 0; c < 6; ++c) {
            head += load_single(row + 6 * c) * in[c];
            tail += load_single_pair(row + 6 * c + 4) * in[c];
        }
        store(z + 6 * e, head), store(z + 6 * e + 4, tail);
    }
}

}  // namespace

void BlockJacobi::set_up(const Stiffness& stiffness, std::span<const std::int64_t> imposed)
{
    const BeamSection& section = stiffness.section();
    const std::int64_t n = stiffness.elements();
    std::vector<double> blocks(static_cast<std::size_t>(36 * n), 0.0);
    stiffness.diagonal(blocks);
    std::vector<std::uint8_t> held(static_cast<std::size_t>(n), 0);
    for (const std::int64_t dof : imposed)
        held[static_cast<std::size_t>(dof / 6)] |= static_cast<std::uint8_t>(1U << (dof % 6));
    // What nothing holds now may be pushed later, before this inverse is made anew.
    const double R = section.R_B, axial = section.EA / (4.0 * R), bending = section.EI / R;
    inverse_.resize(blocks.size());
    parallel_ranges(n, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t e = begin; e < end; ++e) {
            Eigen::Map<Block> block(blocks.data() + 36 * e);
            for (int c = 0; c < 6; ++c) {
                if (!(block(c, c) > 0.0)) block(c, c) = c < 3 ? axial : bending;
                if (!(held[static_cast<std::size_t>(e)] >> c & 1)) continue;
                block.row(c).setZero();
                block.col(c).setZero();
            }
            Eigen::Map<Eigen::Matrix<float, 6, 6, Eigen::RowMajor>>(inverse_.data() + 36 * e) =
                safe_inverse(block).cast<float>();
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
