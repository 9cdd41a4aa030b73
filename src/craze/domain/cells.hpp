// Points sorted into the cells of a regular grid: who is near whom, in linear time.

#pragma once

#include "craze/core/vec3.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace craze::domain {

/// Linked cells over the box [0, size]. Points outside belong to the nearest cell.
class Cells {
public:
    /// @param edge  least edge of a cell, m; larger cells are used where the box would need too many
    Cells(const Vec3& box, double edge, std::span<const double> x, std::span<const double> y,
          std::span<const double> z);

    std::array<std::int32_t, 3> count() const { return count_; }
    std::int32_t along(int axis, double position) const
    {
        const auto cell = static_cast<std::int32_t>(position * inverse_edge_[axis]);
        return cell < 0                                         ? 0
               : cell >= count_[static_cast<std::size_t>(axis)] ? count_[static_cast<std::size_t>(axis)] - 1
                                                                : cell;
    }
    std::int64_t index(std::int32_t cx, std::int32_t cy, std::int32_t cz) const
    {
        return cx + static_cast<std::int64_t>(count_[0]) * (cy + static_cast<std::int64_t>(count_[1]) * cz);
    }
    /// Members of the cells cx_begin ... cx_end - 1 of row (cy, cz), by cell, then ascending.
    std::span<const std::int32_t> row(std::int32_t cx_begin, std::int32_t cx_end, std::int32_t cy,
                                      std::int32_t cz) const
    {
        const auto begin = static_cast<std::size_t>(start_[static_cast<std::size_t>(index(cx_begin, cy, cz))]);
        const auto end = static_cast<std::size_t>(start_[static_cast<std::size_t>(index(cx_end - 1, cy, cz)) + 1]);
        return {members_.data() + begin, end - begin};
    }

    std::span<const std::int32_t> members() const { return members_; }

private:
    std::array<std::int32_t, 3> count_{};
    Vec3 inverse_edge_;
    std::vector<std::int32_t> start_;  // cells + 1
    std::vector<std::int32_t> members_;
};

/// Position along the Morton curve of a point of the box: 21 bits an axis.
std::uint64_t morton_code(const Vec3& point, const Vec3& box);

/// The order that sorts codes; equal codes keep their order.
std::vector<std::int32_t> morton_order(const Vec3& box, std::span<const double> x, std::span<const double> y,
                                       std::span<const double> z);

}  // namespace craze::domain
