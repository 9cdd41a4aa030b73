#include "craze/synth/height_field.hpp"

namespace craze::synth {

namespace {

/// One pass along one axis: out(i) = max over k of sign * in(i + k) - k^2 c^2 / 2R, times sign.
void parabola_pass(const HeightField& in, HeightField& out, bool along_x, double sign, double radius,
                   std::int64_t reach)
{
    const std::int64_t n = along_x ? in.nx : in.ny, lines = along_x ? in.ny : in.nx;
    const std::int64_t step = along_x ? 1 : in.nx, next = along_x ? in.nx : 1;
    std::vector<double> fall(static_cast<std::size_t>(reach + 1));
    for (std::size_t k = 0; k < fall.size(); ++k)
        fall[k] = static_cast<double>(k * k) * in.cell * in.cell / (2.0 * radius);
    for (std::int64_t line = 0; line < lines; ++line)
        for (std::int64_t i = 0; i < n; ++i) {
            double best = -1e300;
            for (std::int64_t j = std::max<std::int64_t>(0, i - reach); j <= std::min(n - 1, i + reach); ++j)
                best = std::max(best, sign * in.z[static_cast<std::size_t>(line * next + j * step)] -
                                          fall[static_cast<std::size_t>(std::abs(j - i))]);
            out.z[static_cast<std::size_t>(line * next + i * step)] = sign * best;
        }
}

}  // namespace

HeightField closed_by_parabola(const HeightField& field, double radius)
{
    const auto [low, high] = std::minmax_element(field.z.begin(), field.z.end());
    // Beyond this distance the paraboloid has fallen by more than all heights differ.
    const auto reach = std::min(std::max(field.nx, field.ny),
                                static_cast<std::int64_t>(std::sqrt(2.0 * radius * (*high - *low)) / field.cell) + 1);
    HeightField one = field, other = field;
    parabola_pass(field, one, true, 1.0, radius, reach);
    parabola_pass(one, other, false, 1.0, radius, reach);
    parabola_pass(other, one, true, -1.0, radius, reach);
    parabola_pass(one, other, false, -1.0, radius, reach);
    for (std::size_t i = 0; i < other.z.size(); ++i) other.z[i] = std::max(other.z[i], field.z[i]);  // rounding
    return other;
}

std::vector<std::vector<std::size_t>> connected_patches(const HeightField& field, const std::vector<std::uint8_t>& in)
{
    std::vector<std::vector<std::size_t>> patches;
    std::vector<std::uint8_t> left = in;
    for (std::size_t first = 0; first < left.size(); ++first) {
        if (!left[first]) continue;
        left[first] = 0;
        std::vector<std::size_t> patch{first};
        for (std::size_t at = 0; at < patch.size(); ++at) {
            const auto k = static_cast<std::int64_t>(patch[at]), x = k % field.nx, y = k / field.nx;
            const auto visit = [&](std::int64_t to, bool inside) {
                if (!inside || !left[static_cast<std::size_t>(to)]) return;
                left[static_cast<std::size_t>(to)] = 0;
                patch.push_back(static_cast<std::size_t>(to));
            };
            visit(k - 1, x > 0);
            visit(k + 1, x + 1 < field.nx);
            visit(k - field.nx, y > 0);
            visit(k + field.nx, y + 1 < field.ny);
        }
        patches.push_back(std::move(patch));
    }
    return patches;
}

}  // namespace craze::synth
