// Voxel data: a box of values, x fastest.

#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace craze {

/// Voxel counts along x (fastest), y, z.
struct Shape {
    std::int64_t nx = 0, ny = 0, nz = 0;

    constexpr std::int64_t voxels() const { return nx * ny * nz; }
    constexpr std::int64_t operator[](int axis) const { return axis == 0 ? nx : axis == 1 ? ny : nz; }
    friend constexpr bool operator==(const Shape&, const Shape&) = default;
};

/// A box of voxel values in one allocation; voxel (x, y, z) lies at x + nx (y + ny z). Move-only: copies are
/// asked for by name. In space, voxel (x, y, z) fills [x h, (x+1) h] x ... with h its edge: centres at (x + 1/2) h.
template <class T>
class Volume {
public:
    Volume() = default;
    /// Values are left uninitialised.
    explicit Volume(Shape shape)
        : shape_(shape), data_(std::make_unique_for_overwrite<T[]>(static_cast<std::size_t>(shape.voxels())))
    {
    }
    Volume(Shape shape, T value) : Volume(shape) { std::fill_n(data_.get(), shape.voxels(), value); }
    Volume(Volume&&) noexcept = default;
    Volume& operator=(Volume&&) noexcept = default;

    Volume copy() const
    {
        Volume twin(shape_);
        std::copy_n(data_.get(), shape_.voxels(), twin.data_.get());
        return twin;
    }

    const Shape& shape() const { return shape_; }
    bool empty() const { return shape_.voxels() == 0; }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    std::span<T> values() { return {data_.get(), static_cast<std::size_t>(shape_.voxels())}; }
    std::span<const T> values() const { return {data_.get(), static_cast<std::size_t>(shape_.voxels())}; }

    T& operator()(std::int64_t x, std::int64_t y, std::int64_t z) { return data_[index(x, y, z)]; }
    const T& operator()(std::int64_t x, std::int64_t y, std::int64_t z) const { return data_[index(x, y, z)]; }

    std::span<T> row(std::int64_t y, std::int64_t z)
    {
        return {data_.get() + index(0, y, z), static_cast<std::size_t>(shape_.nx)};
    }
    std::span<const T> row(std::int64_t y, std::int64_t z) const
    {
        return {data_.get() + index(0, y, z), static_cast<std::size_t>(shape_.nx)};
    }
    std::span<T> slice(std::int64_t z)
    {
        return {data_.get() + index(0, 0, z), static_cast<std::size_t>(shape_.nx * shape_.ny)};
    }
    std::span<const T> slice(std::int64_t z) const
    {
        return {data_.get() + index(0, 0, z), static_cast<std::size_t>(shape_.nx * shape_.ny)};
    }

private:
    std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        assert(x >= 0 && x < shape_.nx && y >= 0 && y < shape_.ny && z >= 0 && z < shape_.nz);
        return static_cast<std::size_t>(x + shape_.nx * (y + shape_.ny * z));
    }

    Shape shape_;
    std::unique_ptr<T[]> data_;
};

}  // namespace craze
