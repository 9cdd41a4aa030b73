#include "craze/synth/splats.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/random.hpp"
#include "craze/synth/height_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace craze::synth {

namespace {

using std::numbers::pi;

/// One splat: where it lies and how thick it is.
struct Splat {
    double x, y, radius, thickness;
    std::array<double, 4> rim_height, rim_phase;

    /// Thickness at a point, m; 0 outside the rim.
    double at(double px, double py) const
    {
        const double dx = px - x, dy = py - y, angle = std::atan2(dy, dx);
        double rim = 1.0;
        for (std::size_t k = 0; k < 4; ++k)
            rim += rim_height[k] * std::sin(static_cast<double>(k + 2) * angle + rim_phase[k]);
        const double rho = std::sqrt(dx * dx + dy * dy) / (radius * rim);
        return rho < 1.0 ? thickness * std::sqrt(1.0 - rho * rho) : 0.0;
    }
};

Splat thrown(const Splats& splats, const Vec3& size, Random& random)
{
    Splat s{};
    s.thickness = draw(splats.thickness, random);
    s.radius = draw(splats.radius, random);
    s.x = random.uniform(-s.radius, size.x + s.radius);
    s.y = random.uniform(-s.radius, size.y + s.radius);
    for (std::size_t k = 0; k < 4; ++k) {
        s.rim_height[k] = splats.raggedness * random.uniform(0.0, 1.0) / static_cast<double>(k + 1);
        s.rim_phase[k] = random.uniform(0.0, 2.0 * pi);
    }
    return s;
}

/// What stays open under a splat: each connected gap becomes a pore of ellipsoidal lobes.
void keep_gaps(const HeightField& below, const HeightField& bottom, std::vector<std::uint8_t>& open, double least,
               Coating& coating)
{
    const auto gap = [&](std::size_t i) { return bottom.z[i] - below.z[i]; };
    for (const auto& patch : connected_patches(below, open)) {
        Pore pore;
        pore.population = 1;
        std::vector<std::size_t> left = patch;
        while (!left.empty() && pore.lobes.size() < 12) {
            const std::size_t peak = *std::max_element(left.begin(), left.end(),
                                                       [&](std::size_t p, std::size_t q) { return gap(p) < gap(q); });
            if (gap(peak) < least) break;
            // The lobe: cells near the peak that are open at least half as wide.
            const double wide = 2.5 * gap(peak) + 2.0 * below.cell;
            std::vector<std::size_t> lobe, rest;
            for (const std::size_t i : left)
                (gap(i) >= 0.5 * gap(peak) && below.distance(i, peak) < wide ? lobe : rest).push_back(i);
            const PatchShape shape =
                shape_of(below, lobe, [&](std::size_t i) { return 0.5 * (bottom.z[i] + below.z[i]); });
            pore.lobes.push_back(
                {shape.centre,
                 shape.frame,
                 {std::max(shape.a, 0.3 * gap(peak)), std::max(shape.b, 0.3 * gap(peak)), 0.5 * gap(peak)}});
            left = std::move(rest);
        }
        if (!pore.lobes.empty()) coating.pores.push_back(std::move(pore));
    }
}

/// Patches of the interface where the splat did not wet: the highest values of a smooth random field, higher at the
/// rim.
void keep_unbonded(const Splats& splats, const Splat& splat, const HeightField& bottom,
                   const std::vector<std::uint8_t>& touching, Random& random, Coating& coating)
{
    if (splats.unbonded <= 0.0) return;
    constexpr std::size_t waves = 12;
    std::array<std::array<double, 3>, waves> wave{};
    for (auto& w : wave) {
        const double number = pi / splats.patch * random.uniform(0.6, 1.3), angle = random.uniform(0.0, 2.0 * pi);
        w = {number * std::cos(angle), number * std::sin(angle), random.uniform(0.0, 2.0 * pi)};
    }
    std::vector<double> field(bottom.z.size(), 0.0), sorted;
    for (std::size_t i = 0; i < field.size(); ++i) {
        if (!touching[i]) continue;
        const auto [x, y] = bottom.place(i);
        for (const auto& w : wave) field[i] += std::sin(w[0] * x + w[1] * y + w[2]) / std::sqrt(0.5 * waves);
        field[i] += std::hypot(x - splat.x, y - splat.y) / splat.radius;
        sorted.push_back(field[i]);
    }
    if (sorted.empty()) return;
    const auto rank = static_cast<std::size_t>((1.0 - splats.unbonded) * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank), sorted.end());
    std::vector<std::uint8_t> loose(field.size());
    for (std::size_t i = 0; i < field.size(); ++i) loose[i] = touching[i] && field[i] > sorted[rank];
    for (auto left : connected_patches(bottom, loose)) {
        while (left.size() >= 12) {  // fewer cells are no crack worth a name
            const std::size_t seed = *std::max_element(
                left.begin(), left.end(), [&](std::size_t p, std::size_t q) { return field[p] < field[q]; });
            std::vector<std::size_t> patch, rest;
            for (const std::size_t i : left) (bottom.distance(i, seed) < splats.patch ? patch : rest).push_back(i);
            left = std::move(rest);
            if (patch.size() < 12) continue;
            const PatchShape shape = shape_of(bottom, patch, [&](std::size_t i) { return bottom.z[i]; });
            Crack crack{.centre = shape.centre, .frame = shape.frame, .a = shape.a, .b = shape.b};
            crack.aperture = draw(splats.aperture, random);
            crack.population = 1;
            coating.cracks.push_back(crack);
        }
    }
}

/// Shrinkage breaks the splat into islands, cells of the points of a jittered grid; part of the walls between is
/// cracked.
void keep_walls(const Splats& splats, const Splat& splat, const HeightField& bottom, Random& random, Coating& coating)
{
    if (splats.cracked <= 0.0) return;
    const auto n = static_cast<int>(std::ceil(2.4 * splat.radius / splats.island)) + 2;
    std::vector<std::array<double, 2>> seeds;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            seeds.push_back({splat.x + splats.island * (i - 0.5 * n + random.uniform()),
                             splat.y + splats.island * (j - 0.5 * n + random.uniform())});
    for (std::size_t p = 0; p < seeds.size(); ++p)
        for (std::size_t q = 0; q < p; ++q) {
            const double dx = seeds[p][0] - seeds[q][0], dy = seeds[p][1] - seeds[q][1], d = std::hypot(dx, dy);
            if (d > 3.0 * splats.island || d < 1e-3 * splats.island) continue;
            const double mx = 0.5 * (seeds[p][0] + seeds[q][0]), my = 0.5 * (seeds[p][1] + seeds[q][1]);
            // The wall: the part of the bisector nearer to this pair than to any other seed.
            double from = -2.0 * splats.island, to = 2.0 * splats.island;
            for (std::size_t o = 0; o < seeds.size() && from < to; ++o) {
                if (o == p || o == q) continue;
                const double ox = seeds[o][0] - seeds[p][0], oy = seeds[o][1] - seeds[p][1];
                if (ox * ox + oy * oy > 25.0 * splats.island * splats.island) continue;
                // |m + s t - o|^2 >= |m + s t - p|^2 with t = (-dy, dx) / d: linear in s.
                const double slope = 2.0 * (-ox * dy + oy * dx) / d;
                const double limit = 2.0 * ((mx - seeds[p][0]) * ox + (my - seeds[p][1]) * oy) - (ox * ox + oy * oy);
                if (std::abs(slope) < 1e-15 * d)
                    from = limit > 0.0 ? to : from;
                else if (slope > 0.0)
                    to = std::min(to, -limit / slope);
                else
                    from = std::max(from, -limit / slope);
            }
            if (to - from < 0.1 * splats.island) continue;
            const double chance = random.uniform(), aperture = draw(splats.aperture, random), tilt = random.normal();
            const double s = 0.5 * (from + to), x = mx - s * dy / d, y = my + s * dx / d;
            const double thick = splat.at(x, y);
            if (chance > splats.cracked || thick <= 0.0 || !bottom.holds(x, y)) continue;
            const Vec3 normal = normalized(Vec3{dx / d, dy / d, 0.1 * tilt});
            const Vec3 along{-dy / d, dx / d, 0.0};
            Crack crack{.centre = {x, y, bottom.at(x, y) + 0.5 * thick},
                        .frame = {along, cross(normal, along), normal},
                        .a = 0.5 * (to - from),
                        .b = 0.5 * thick};
            crack.outline = Outline::rectangle;
            crack.aperture = aperture;
            crack.population = 0;
            coating.cracks.push_back(crack);
        }
}

void keep_bubbles(const Splats& splats, const Splat& splat, const HeightField& bottom, Random& random, Coating& coating)
{
    double volume = 0.0;
    for (std::size_t i = 0; i < bottom.z.size(); ++i) {
        const auto [x, y] = bottom.place(i);
        volume += splat.at(x, y) * bottom.cell * bottom.cell;
    }
    double filled = 0.0;
    for (int tries = 0; tries < 100000 && filled < splats.bubbles * volume; ++tries) {
        const double x = splat.x + splat.radius * random.uniform(-1.2, 1.2),
                     y = splat.y + splat.radius * random.uniform(-1.2, 1.2);
        const double wanted = draw(splats.bubble, random), height = random.uniform(), thick = splat.at(x, y);
        if (!bottom.holds(x, y) || thick < 2.2 * splats.bubble.least) continue;
        const double radius = std::min(wanted, 0.45 * thick);
        // The last one is drawn with the chance that the target asks for.
        const double body = 4.0 / 3.0 * pi * radius * radius * radius;
        if (random.uniform() * body > splats.bubbles * volume - filled) break;
        filled += body;
        const double z = bottom.at(x, y) + radius + height * (thick - 2.0 * radius);
        coating.pores.push_back({{{{x, y, z}, {}, {radius, radius, radius}}}, 0});
    }
}

}  // namespace

void describe(Schema& schema, Splats& s)
{
    constexpr Range sizes{1e-9, 1e-3};
    describe(schema, "thickness", s.thickness, "thickness in the middle of a splat");
    describe(schema, "radius", s.radius, "radius of a splat");
    schema.number("raggedness", s.raggedness, {0, 0.3}, "raggedness of the rim over the radius");
    schema.quantity("filling", s.filling, Dimension::length, sizes, "radius of the sharpest valley that melt fills");
    schema.quantity("bubbles", s.bubbles, Dimension::fraction, {0, 0.3}, "porosity of globular pores");
    describe(schema, "bubble", s.bubble, "radius of a globular pore");
    schema.quantity("unbonded", s.unbonded, Dimension::fraction, {0, 1}, "share of the interfaces that is a crack");
    schema.quantity("patch", s.patch, Dimension::length, sizes, "size of an unbonded patch");
    schema.quantity("island", s.island, Dimension::length, sizes, "distance of the cracks across a splat");
    schema.quantity("cracked", s.cracked, Dimension::fraction, {0, 1},
                    "share of the walls between islands that is cracked");
    describe(schema, "aperture", s.aperture, "greatest opening of a crack");
}

void check(const Splats& s)
{
    check(s.thickness, "splats.thickness");
    check(s.radius, "splats.radius");
    check(s.bubble, "splats.bubble");
    check(s.aperture, "splats.aperture");
}

Coating spray(const Splats& splats, const Vec3& size, std::uint64_t seed)
{
    check(splats);
    Coating coating{size, {}, {}};
    coating.pore_names = {"bubbles", "between splats"};
    coating.crack_names = {"intra-splat cracks", "inter-splat cracks"};
    const double cell = std::max(std::cbrt(size.x * size.y * size.z) / 160.0, 0.5 * splats.filling);
    HeightField surface(size.x, size.y, cell);
    const double least = splats.filling;
    for (std::uint64_t serial = 0; *std::min_element(surface.z.begin(), surface.z.end()) < size.z; ++serial) {
        if (serial > 1000000)
            throw InvalidInput("synth: a million splats do not fill the box; make them thicker or wider");
        Random random(seed, mixed(0x73706c6174000000U) + serial);
        const Splat splat = thrown(splats, size, random);
        std::vector<double> thick(surface.z.size());
        bool lands = false;
        for (std::size_t i = 0; i < thick.size(); ++i) {
            const auto [x, y] = surface.place(i);
            thick[i] = splat.at(x, y);
            lands = lands || thick[i] > 0.0;
        }
        if (!lands) continue;
        const HeightField bottom = closed_by_parabola(surface, splats.filling);
        std::vector<std::uint8_t> open(thick.size()), touching(thick.size());
        for (std::size_t i = 0; i < thick.size(); ++i) {
            const bool under = thick[i] > 0.0, gaping = bottom.z[i] - surface.z[i] > 0.5 * least;
            open[i] = under && gaping;
            touching[i] = under && !gaping;
        }
        keep_gaps(surface, bottom, open, least, coating);
        keep_unbonded(splats, splat, bottom, touching, random, coating);
        keep_walls(splats, splat, bottom, random, coating);
        keep_bubbles(splats, splat, bottom, random, coating);
        for (std::size_t i = 0; i < thick.size(); ++i)
            if (thick[i] > 0.0) surface.z[i] = bottom.z[i] + thick[i];
    }
    // What lies wholly outside the box has served its purpose.
    const auto outside = [&](const Vec3& c, double reach) {
        return c.x < -reach || c.x > size.x + reach || c.y < -reach || c.y > size.y + reach || c.z < -reach ||
               c.z > size.z + reach;
    };
    std::erase_if(coating.cracks, [&](const Crack& crack) { return outside(crack.centre, reach(crack)); });
    std::erase_if(coating.pores, [&](const Pore& pore) {
        const auto ball = bounding_ball(pore);
        return outside({ball[0], ball[1], ball[2]}, ball[3]);
    });
    return coating;
}

}  // namespace craze::synth
