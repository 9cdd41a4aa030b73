// What a mask's shape is made of, counted the slow and plain way.

#pragma once

#include "craze/core/mask.hpp"

#include <cstdlib>
#include <vector>

namespace craze::support {

/// Components of the pixels of slice z that are `in` (8- or 4-connected), by flooding; outside counts as out.
inline int components_of_slice(const Mask& mask, std::int64_t z, bool in, bool eight)
{
    const Shape s = mask.shape();
    const std::int64_t w = s.nx + 2, h = s.ny + 2;
    std::vector<char> left(static_cast<std::size_t>(w * h), 0);
    for (std::int64_t y = 0; y < h; ++y)
        for (std::int64_t x = 0; x < w; ++x) {
            const bool inside = x > 0 && y > 0 && x <= s.nx && y <= s.ny && mask(x - 1, y - 1, z);
            left[static_cast<std::size_t>(x + w * y)] = inside == in;
        }
    int count = 0;
    std::vector<std::int64_t> todo;
    for (std::int64_t start = 0; start < w * h; ++start) {
        if (!left[static_cast<std::size_t>(start)]) continue;
        ++count;
        todo.assign(1, start);
        left[static_cast<std::size_t>(start)] = 0;
        while (!todo.empty()) {
            const std::int64_t at = todo.back();
            todo.pop_back();
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const std::int64_t x = at % w + dx, y = at / w + dy;
                    if ((!eight && dx != 0 && dy != 0) || x < 0 || y < 0 || x >= w || y >= h) continue;
                    auto& there = left[static_cast<std::size_t>(x + w * y)];
                    if (there) there = 0, todo.push_back(x + w * y);
                }
        }
    }
    return count;
}

/// Of the union of the closed pixels of slice z, 8-connected: pixels, edges and corners counted with alternating sign.
inline std::int64_t euler_number_of_slice(const Mask& mask, std::int64_t z)
{
    const Shape s = mask.shape();
    const auto pixel = [&](std::int64_t x, std::int64_t y) {
        return x >= 0 && y >= 0 && x < s.nx && y < s.ny && mask(x, y, z);
    };
    std::int64_t sum = 0;
    for (std::int64_t y = 0; y <= s.ny; ++y)
        for (std::int64_t x = 0; x <= s.nx; ++x) {
            const bool here = pixel(x, y), left = pixel(x - 1, y), above = pixel(x, y - 1);
            sum += (here || left || above || pixel(x - 1, y - 1) ? 1 : 0) - (here || left ? 1 : 0) -
                   (here || above ? 1 : 0) + (here ? 1 : 0);
        }
    return sum;
}

inline bool in(const Mask& m, std::int64_t x, std::int64_t y, std::int64_t z)
{
    const Shape& s = m.shape();
    return x >= 0 && y >= 0 && z >= 0 && x < s.nx && y < s.ny && z < s.nz && m(x, y, z);
}

/// Parts of the set (26-connected) or of the rest (6-connected, with a border of rest around the volume).
inline int components(const Mask& m, bool set)
{
    const std::int64_t nx = m.shape().nx + 2, ny = m.shape().ny + 2, nz = m.shape().nz + 2;
    std::vector<char> left(static_cast<std::size_t>(nx * ny * nz));
    for (std::int64_t i = 0; i < nx * ny * nz; ++i)
        left[static_cast<std::size_t>(i)] = in(m, i % nx - 1, i / nx % ny - 1, i / nx / ny - 1) == set;
    int count = 0;
    std::vector<std::int64_t> todo;
    for (std::int64_t start = 0; start < nx * ny * nz; ++start) {
        if (!left[static_cast<std::size_t>(start)]) continue;
        ++count;
        left[static_cast<std::size_t>(start)] = 0;
        todo.assign(1, start);
        while (!todo.empty()) {
            const std::int64_t i = todo.back();
            todo.pop_back();
            for (int k = 0; k < 27; ++k) {
                const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
                if (!set && std::abs(dx) + std::abs(dy) + std::abs(dz) != 1) continue;
                const std::int64_t x = i % nx + dx, y = i / nx % ny + dy, z = i / nx / ny + dz;
                if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
                const std::int64_t j = x + nx * (y + ny * z);
                if (left[static_cast<std::size_t>(j)]) left[static_cast<std::size_t>(j)] = 0, todo.push_back(j);
            }
        }
    }
    return count;
}

/// Of the union of closed voxels: cubes, faces, edges and corners counted with alternating sign.
inline std::int64_t euler_number(const Mask& m)
{
    const Shape& s = m.shape();
    std::int64_t sum = 0;
    for (std::int64_t z = 0; z <= 2 * s.nz; ++z)
        for (std::int64_t y = 0; y <= 2 * s.ny; ++y)
            for (std::int64_t x = 0; x <= 2 * s.nx; ++x) {
                // Odd coordinates are voxel middles, even ones lie between: the cell is there if a voxel around is.
                bool there = false;
                for (int k = 0; k < 8; ++k) {
                    const auto at = [&](std::int64_t c, int side) { return c % 2 != 0 ? c / 2 : c / 2 - side; };
                    there |= in(m, at(x, k & 1), at(y, k >> 1 & 1), at(z, k >> 2));
                }
                if (there) sum += (x % 2 + y % 2 + z % 2) % 2 == 0 ? 1 : -1;
            }
    return sum;
}

}  // namespace craze::support
