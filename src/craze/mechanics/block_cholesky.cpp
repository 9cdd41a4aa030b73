#include "craze/mechanics/block_cholesky.hpp"

#include "craze/mechanics/lanes.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <algorithm>
#include <iterator>

namespace craze::mechanics {

namespace {

using FloatBlock = Eigen::Matrix<float, 6, 6>;

/// An order of elimination that fills little: place of each row.
std::vector<std::int32_t> places(const std::vector<std::vector<BlockCholesky::Entry>>& rows)
{
    const auto n = static_cast<int>(rows.size());
    std::vector<Eigen::Triplet<double>> links;
    for (int r = 0; r < n; ++r)
        for (const auto& entry : rows[static_cast<std::size_t>(r)]) {
            links.emplace_back(r, entry.column, 1.0);
            if (entry.column != r) links.emplace_back(entry.column, r, 1.0);
        }
    Eigen::SparseMatrix<double> pattern(n, n);
    pattern.setFromTriplets(links.begin(), links.end());
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
    Eigen::AMDOrdering<int>()(pattern, order);
    std::vector<std::int32_t> place(rows.size());
    for (int k = 0; k < n; ++k) place[static_cast<std::size_t>(order.indices()[k])] = k;
    return place;
}

/// y += factor A x, column by column: the two numbers after each column's six meet lanes that say nothing.
CRAZE_INLINE void add_product(const float* A, const float* x, float factor, float* y)
{
    Floats sum{};
    for (int c = 0; c < 5; ++c) sum += load(A + 6 * c) * x[c];
    const Floats last{A[30], A[31], A[32], A[33], A[34], A[35], 0.0F, 0.0F};
    store(y, load(y) + factor * (sum + last * x[5]));
}

CRAZE_MULTIVERSION void scatter(const FloatBlock* blocks, const std::int32_t* to, std::size_t count, const float* x,
                                float* y)
{
    for (std::size_t k = 0; k < count; ++k) add_product(blocks[k].data(), x, -1.0F, y + floats * to[k]);
}
CRAZE_MULTIVERSION void collect(const FloatBlock* blocks, const std::int32_t* from, std::size_t count, const float* y,
                                float* x)
{
    for (std::size_t k = 0; k < count; ++k) add_product(blocks[k].data(), y + floats * from[k], -1.0F, x);
}
CRAZE_MULTIVERSION void replace(const FloatBlock& block, float* x)
{
    float y[floats] = {};
    add_product(block.data(), x, 1.0F, y);
    store(x, load(y));
}

}  // namespace

bool BlockCholesky::factorise(const std::vector<std::vector<Entry>>& rows)
{
    const std::size_t n = rows.size();
    const auto place = places(rows);
    columns_.assign(n, {});
    // Column by column: the matrix' own blocks, then what earlier columns subtract.
    std::vector<std::vector<std::pair<std::int32_t, Block>>> own(n);
    for (std::size_t r = 0; r < n; ++r) {
        columns_[static_cast<std::size_t>(place[r])].node = static_cast<std::int32_t>(r);
        for (const Entry& entry : rows[r]) {
            const std::int32_t a = place[r], b = place[static_cast<std::size_t>(entry.column)];
            if (a >= b)
                own[static_cast<std::size_t>(b)].emplace_back(a, entry.block);
            else
                own[static_cast<std::size_t>(a)].emplace_back(b, entry.block.transpose());
        }
    }
    std::vector<std::vector<Block>> factor(n);  // blocks of `below`
    struct Reach {
        std::size_t column, at;  ///< factor[column][at] lies in the row at hand
    };
    std::vector<std::vector<Reach>> in_row(n);
    std::vector<std::vector<std::size_t>> children(n);
    std::vector<Block> work(n, Block::Zero());
    for (std::size_t j = 0; j < n; ++j) {
        auto& below = columns_[j].below;
        for (const auto& [row, block] : own[j]) {
            work[static_cast<std::size_t>(row)] += block;
            if (static_cast<std::size_t>(row) > j) below.push_back(row);
        }
        std::sort(below.begin(), below.end());
        for (const std::size_t child : children[j]) {
            std::vector<std::int32_t> both;
            std::set_union(below.begin(), below.end(), columns_[child].below.begin() + 1, columns_[child].below.end(),
                           std::back_inserter(both));
            below.swap(both);
        }
        for (const Reach& reach : in_row[j]) {
            const Block& to_j = factor[reach.column][reach.at];
            const auto& rows_below = columns_[reach.column].below;
            for (std::size_t k = reach.at; k < rows_below.size(); ++k)
                work[static_cast<std::size_t>(rows_below[k])].noalias() -= factor[reach.column][k] * to_j.transpose();
        }
        const Eigen::LLT<Block> pivot(work[j]);
        if (pivot.info() != Eigen::Success) return false;
        const Block inverse = pivot.matrixL().solve(Block::Identity());
        work[j].setZero();
        columns_[j].inverse = inverse.cast<float>();
        for (std::size_t k = 0; k < below.size(); ++k) {
            Block& block = work[static_cast<std::size_t>(below[k])];
            factor[j].push_back(block * inverse.transpose());
            block.setZero();
            in_row[static_cast<std::size_t>(below[k])].push_back({j, k});
            columns_[j].block.push_back(factor[j].back().cast<float>());
            columns_[j].transposed.push_back(factor[j].back().transpose().cast<float>());
        }
        if (!below.empty()) children[static_cast<std::size_t>(below.front())].push_back(j);
    }
    return true;
}

void BlockCholesky::solve(float* x) const
{
    std::vector<float> y(floats * columns_.size());
    for (std::size_t j = 0; j < columns_.size(); ++j) store(&y[floats * j], load(x + floats * columns_[j].node));
    for (std::size_t j = 0; j < columns_.size(); ++j) {
        const Column& c = columns_[j];
        replace(c.inverse, &y[floats * j]);
        scatter(c.block.data(), c.below.data(), c.below.size(), &y[floats * j], y.data());
    }
    for (std::size_t j = columns_.size(); j-- > 0;) {
        const Column& c = columns_[j];
        collect(c.transposed.data(), c.below.data(), c.below.size(), y.data(), &y[floats * j]);
        replace(c.inverse.transpose(), &y[floats * j]);
        store(x + floats * c.node, load(&y[floats * j]));
    }
}

}  // namespace craze::mechanics
