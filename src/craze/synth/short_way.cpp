#include "craze/synth/short_way.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/synth/cutter.hpp"
#include "craze/synth/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace craze::synth {

namespace {

/// Points spread evenly over the unit disc (sunflower).
constexpr std::size_t lines = 16;
std::array<std::array<double, 2>, lines> disc_points()
{
    std::array<std::array<double, 2>, lines> points{};
    for (std::size_t i = 0; i < lines; ++i) {
        const double r = std::sqrt((static_cast<double>(i) + 0.5) / lines);
        const double angle = static_cast<double>(i) * std::numbers::pi * (3.0 - std::sqrt(5.0));
        points[i] = {r * std::cos(angle), r * std::sin(angle)};
    }
    return points;
}

domain::PairCracks cut_pairs(const domain::Elements& elements, const std::vector<std::int32_t>& i,
                             const std::vector<std::int32_t>& j, const Cutter& cutter, double R_B, const Sight& sight)
{
    const auto points = disc_points();
    domain::PairCracks cracks{std::vector<std::uint8_t>(i.size(), 0), std::vector<double>(i.size(), 0.0),
                              std::vector<double>(i.size(), 0.0)};
    parallel_ranges(static_cast<std::int64_t>(i.size()), [&](std::int64_t begin, std::int64_t end) {
        std::vector<Crossing> found;
        for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
            const Vec3 from = elements.centre(i[b]), to = elements.centre(j[b]), middle = 0.5 * (from + to);
            found.clear();
            cutter.cross(middle, from, to, found);
            const auto seen = std::count_if(found.begin(), found.end(), [&](const Crossing& crossing) {
                return crossing.opening > sight.least_opening() && crossing.rim > sight.rim;
            });
            if (seen == 0) continue;
            cracks.cut[b] = static_cast<std::uint8_t>(std::min<std::ptrdiff_t>(seen, 255));
            const double L_0 = norm(to - from);
            const Frame frame = frame_about((to - from) / L_0, 0.0);
            for (const auto& point : points) {
                const Vec3 aside = R_B * (point[0] * frame.u + point[1] * frame.v);
                found.clear();
                cutter.cross(middle, from + aside, to + aside, found);
                double T1 = 0.0, T2 = 0.0;
                for (const auto& crossing : found) {
                    T1 += sight.width(crossing.opening) / crossing.cosine;
                    T2 += sight.intensity(crossing.opening) / crossing.cosine;
                }
                cracks.T1[b] += std::min(T1, L_0) / lines;
                cracks.T2[b] += std::min(T2, L_0) / lines;
            }
        }
    });
    return cracks;
}

}  // namespace

domain::Discretisation discretise(const Coating& coating, domain::Domain dense, double R_B, const Sight& sight)
{
    const Vec3& size = coating.size;
    if (!(norm(dense.box - size) <= 1e-3 * norm(size)))
        throw InvalidInput(
            fmt::format("short way: the packing's box {:g} x {:g} x {:g} m is not the coating's {:g} x "
                        "{:g} x {:g} m; pack the box of the recipe",
                        dense.box.x, dense.box.y, dense.box.z, size.x, size.y, size.z));
    double longest = 0.0;
    const auto measure = [&](const auto& pairs) {
        for (std::size_t b = 0; b < pairs.i.size(); ++b)
            longest = std::max(longest, norm(dense.elements.centre(pairs.j[b]) - dense.elements.centre(pairs.i[b])));
    };
    measure(dense.bonds);
    measure(dense.near);
    const Cutter cutter(coating, 0.5 * longest + R_B, sight.margin);

    domain::Discretisation out;
    const std::int32_t n = dense.elements.size();
    out.in_pore.resize(static_cast<std::size_t>(n));
    parallel_ranges(n, [&](std::int64_t begin, std::int64_t end) {
        for (auto e = static_cast<std::int32_t>(begin); e < static_cast<std::int32_t>(end); ++e)
            out.in_pore[static_cast<std::size_t>(e)] = cutter.in_pore(dense.elements.centre(e));
    });
    out.bonds = cut_pairs(dense.elements, dense.bonds.i, dense.bonds.j, cutter, R_B, sight);
    out.near = cut_pairs(dense.elements, dense.near.i, dense.near.j, cutter, R_B, sight);
    out.p_vx = porosity({size, coating.pores, {}}, std::cbrt(size.x * size.y * size.z) / 128.0).pores;
    out.dense = std::move(dense);
    return out;
}

}  // namespace craze::synth
