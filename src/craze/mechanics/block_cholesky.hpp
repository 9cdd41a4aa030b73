// A sparse Cholesky factor in blocks of six, solved fast enough to be a small part of each iteration.

#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace craze::mechanics {

/// Factorises in double precision and solves in single, a block at a time.
class BlockCholesky {
public:
    using Block = Eigen::Matrix<double, 6, 6>;
    struct Entry {
        std::int32_t column = 0;
        Block block = Block::Zero();
    };
    /// @param rows  lower triangle of a symmetric matrix: the diagonal block of each row first, then those with smaller
    ///              columns, each once
    /// Gives whether the matrix is positive definite.
    bool factorise(const std::vector<std::vector<Entry>>& rows);
    /// Loads become what they cause; rows of eight, the last two of each not used.
    void solve(float* x) const;

private:
    struct Column {
        std::int32_t node = 0;               ///< of the matrix
        std::vector<std::int32_t> below;     ///< columns that this one reaches, ascending
        Eigen::Matrix<float, 6, 6> inverse;  ///< of the diagonal block of the factor
        std::vector<Eigen::Matrix<float, 6, 6>> block, transposed;
    };
    std::vector<Column> columns_;
};

}  // namespace craze::mechanics
