#include "craze/microstructure/classification.hpp"

#include "craze/core/parallel.hpp"
#include "craze/microstructure/morphology.hpp"

#include <algorithm>

namespace craze::microstructure {

namespace {

// Adds what matter behind the border would reach: all voxels within `reach` of a wall.
void add_walls(Mask& mask, std::int64_t reach)
{
    const Shape& s = mask.shape();
    const auto near = [reach](std::int64_t i, std::int64_t n) { return i < reach || i >= n - reach; };
    parallel_ranges(s.ny * s.nz, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t r = begin; r < end; ++r) {
            const std::int64_t y = r % s.ny, z = r / s.ny;
            const bool whole = near(y, s.ny) || near(z, s.nz);
            for (std::int64_t x = 0; x < s.nx; ++x)
                if (whole || near(x, s.nx)) mask.set(x, y, z, true);
        }
    });
}

}  // namespace

Mask closed_void(const Mask& matter, double R_C, Border border)
{
    const Ball ball(R_C);
    Mask grown = dilated(matter, ball);
    if (border == Border::matter) {
        std::int64_t reach = 0;
        while ((reach + 1) * (reach + 1) <= ball.squared) ++reach;
        add_walls(grown, reach);
    }
    // What matter cannot reach are the centres of the balls that fit.
    return dilated(complement(grown), ball);
}

Classification classified(const Mask& matter, double R_C, double R_E, Border border)
{
    Classification c;
    c.closed = closed_void(matter, R_C, border);
    c.enlarged = dilated(c.closed, Ball(R_E));
    const Mask empty = complement(matter);
    c.pore = intersection(empty, c.enlarged);
    c.crack = difference(empty, c.pore);
    return c;
}

}  // namespace craze::microstructure
