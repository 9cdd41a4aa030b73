#include "craze/core/errors.hpp"
#include "craze/core/random.hpp"
#include "craze/synth/synth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::synth {

namespace {

using std::numbers::pi;

Vec3 direction(Random& random)
{
    for (;;) {
        const Vec3 g{random.normal(), random.normal(), random.normal()};
        const double length = norm(g);
        if (length > 1e-6) return g / length;
    }
}

/// A normal about an axis: large scatter makes it isotropic.
Vec3 scattered(const Vec3& axis, double scatter, Random& random)
{
    return normalized(axis + scatter * Vec3{random.normal(), random.normal(), random.normal()});
}

/// A point of the box widened by `margin` on every side, so that bodies cut by its faces are as frequent as inside.
Vec3 anywhere(const Vec3& size, double margin, Random& random)
{
    return {random.uniform(-margin, size.x + margin), random.uniform(-margin, size.y + margin),
            random.uniform(-margin, size.z + margin)};
}

bool inside(const Vec3& p, const Vec3& size, double margin = 0.0)
{
    return p.x >= -margin && p.x <= size.x + margin && p.y >= -margin && p.y <= size.y + margin && p.z >= -margin &&
           p.z <= size.z + margin;
}

Vec3 near(const Vec3& parent, double spread, Random& random)
{
    return parent + spread * Vec3{random.normal(), random.normal(), random.normal()};
}

// Pores -------------------------------------------------------------------------------------------------------------

Pore shaped(const PorePopulation& p, Random& random)
{
    const double radius = draw(p.radius, random);
    // Semi-axes r f^(-1/3) (1, 1, f): the volume of the ball is kept.
    const double wide = radius * std::pow(p.flatness, -1.0 / 3.0);
    Pore pore;
    if (p.shape == PoreShape::globular) {
        // Two axes drawn between flat and round, in any orientation.
        const double middle = random.uniform(p.flatness, 1.0),
                     unit = radius * std::pow(middle * p.flatness, -1.0 / 3.0);
        pore.lobes.push_back({{},
                              frame_about(direction(random), random.uniform(0.0, 2.0 * pi)),
                              {unit, unit * middle, unit * p.flatness}});
        return pore;
    }
    // Splats lie across z, and so do the gaps between them unless scattered: the lobes are flat along the pore's normal
    // within some degrees, and spread sideways.
    Frame splat;
    if (p.scatter > 0.0) splat = frame_about(scattered({0.0, 0.0, 1.0}, p.scatter, random), 0.0);
    const auto in_splat = [&](const Vec3& v) { return v.x * splat.u + v.y * splat.v + v.z * splat.n; };
    Vec3 at{};
    for (std::int64_t l = 0; l < p.lobes; ++l) {
        const double scale = l == 0 ? 1.0 : random.uniform(0.55, 0.95);
        const Vec3 normal = in_splat(normalized(Vec3{0.25 * random.normal(), 0.25 * random.normal(), 1.0}));
        pore.lobes.push_back({at,
                              frame_about(normal, random.uniform(0.0, 2.0 * pi)),
                              {wide * scale, wide * scale * random.uniform(0.7, 1.0), wide * p.flatness * scale}});
        const double angle = random.uniform(0.0, 2.0 * pi), step = wide * random.uniform(0.5, 0.9);
        const Vec3& from = pore.lobes[static_cast<std::size_t>(random.below(l + 1))].centre;
        at = from +
             in_splat({step * std::cos(angle), step * std::sin(angle), 0.35 * p.flatness * wide * random.normal()});
    }
    return pore;
}

void move(Pore& pore, const Vec3& to)
{
    const Vec3 by = to - pore.lobes.front().centre;
    for (auto& lobe : pore.lobes) lobe.centre += by;
}

void grow(Pore& pore, double factor)
{
    const Vec3 about = pore.lobes.front().centre;
    for (auto& lobe : pore.lobes) {
        lobe.centre = about + factor * (lobe.centre - about);
        lobe.semi *= factor;
    }
}

/// Volume of the pore inside the box, by 24^3 points of its own box.
double volume_in(const Pore& pore, const Vec3& size)
{
    const auto ball = bounding_ball(pore);
    constexpr int n = 24;
    const double edge = 2.0 * ball[3] / n;
    std::int64_t hits = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) {
                const Vec3 p{ball[0] - ball[3] + (i + 0.5) * edge, ball[1] - ball[3] + (j + 0.5) * edge,
                             ball[2] - ball[3] + (k + 0.5) * edge};
                if (inside(p, size) && contains(pore, p)) ++hits;
            }
    return static_cast<double>(hits) * edge * edge * edge;
}

/// Least distance of two pores, from below: lobes are taken as the balls about them.
double clearance(const Pore& one, const Pore& other)
{
    double least = 1e300;
    for (const auto& a : one.lobes)
        for (const auto& b : other.lobes)
            least = std::min(least, norm(a.centre - b.centre) - std::max({a.semi.x, a.semi.y, a.semi.z}) -
                                        std::max({b.semi.x, b.semi.y, b.semi.z}));
    return least;
}

void place_pores(const PorePopulation& p, std::int32_t number, const Settings& settings, Coating& coating)
{
    const Vec3& size = coating.size;
    const double box = size.x * size.y * size.z;
    const std::size_t first = coating.pores.size();
    double filled = 0.0;
    std::int64_t centred = 0;
    for (std::uint64_t serial = 0; p.count > 0 ? centred < p.count : filled < p.porosity * box; ++serial) {
        Random random(static_cast<std::uint64_t>(settings.seed),
                      mixed(0x706f726500000000U + static_cast<std::uint64_t>(number)) + serial);
        Pore pore = shaped(p, random);
        pore.population = number;
        const double reach = bounding_ball(pore)[3];
        bool placed = false;
        for (int tries = 0; tries < 2000 && !placed; ++tries) {
            const std::size_t earlier = coating.pores.size() - first;
            Vec3 at = anywhere(size, reach, random);
            if (earlier > 0 && random.uniform() < p.clustered)
                at = near(
                    coating.pores[first + static_cast<std::size_t>(random.below(static_cast<std::int64_t>(earlier)))]
                        .lobes.front()
                        .centre,
                    p.cluster_radius, random);
            if (!inside(at, size, reach)) continue;
            move(pore, at);
            placed = p.gap < 0.0 || std::all_of(coating.pores.begin(), coating.pores.end(),
                                                [&](const Pore& other) { return clearance(pore, other) >= p.gap; });
        }
        if (!placed)
            throw InvalidInput(fmt::format(
                "synth: {} find no room after {} pores ({:.1f} % of the volume); make gap, radius or porosity smaller",
                p.name, coating.pores.size() - first, 100.0 * filled / box));
        filled += volume_in(pore, size);
        centred += inside(pore.lobes.front().centre, size);
        coating.pores.push_back(std::move(pore));
    }
    if (p.count > 0) return;
    for (int round = 0; round < 4; ++round) {
        const double factor = std::cbrt(p.porosity * box / filled);
        filled = 0.0;
        for (std::size_t i = first; i < coating.pores.size(); ++i) {
            grow(coating.pores[i], factor);
            filled += volume_in(coating.pores[i], size);
        }
    }
}

// Cracks ------------------------------------------------------------------------------------------------------------

Crack shaped(const CrackPopulation& c, Random& random)
{
    Crack crack;
    const double radius = draw(c.radius, random);
    const double stretch = c.shape == CrackShape::disc ? 1.0 : std::sqrt(c.elongation);
    crack.a = radius * stretch;
    crack.b = radius / stretch;
    const double pick = random.uniform() * (c.normals[0] + c.normals[1] + c.normals[2]);
    Vec3 axis{};
    axis[pick < c.normals[0] ? 0 : pick < c.normals[0] + c.normals[1] ? 1 : 2] = 1.0;
    const Vec3 normal = scattered(axis, c.scatter, random);
    crack.frame = frame_about(normal, random.uniform(0.0, 2.0 * pi));
    crack.aperture = draw(c.aperture, random) * std::pow(radius / c.radius.median, c.aperture_growth);
    crack.aperture = std::clamp(crack.aperture, c.aperture.least, c.aperture.most);
    crack.profile = c.profile;
    if (c.shape == CrackShape::wavy)
        for (std::size_t k = 0; k < 2; ++k) {
            const double angle = random.uniform(0.0, 2.0 * pi), number = random.uniform(1.5, 4.0) / radius;
            crack.wave_height[k] = c.waviness * radius / (radius * number);  // equal slopes for all wavelengths
            crack.wave_u[k] = number * std::cos(angle);
            crack.wave_v[k] = number * std::sin(angle);
            crack.wave_phase[k] = random.uniform(0.0, 2.0 * pi);
        }
    if (c.shape == CrackShape::bent) crack.curvature = (random.uniform() < 0.5 ? -1.0 : 1.0) * c.bend / radius;
    return crack;
}

/// A point of the pore's wall, by walking from the middle of a lobe in a random direction until outside all lobes.
Vec3 wall_point(const Pore& pore, Random& random)
{
    const auto& lobe = pore.lobes[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(pore.lobes.size())))];
    const Vec3 way = direction(random);
    const double step = 0.02 * std::max({lobe.semi.x, lobe.semi.y, lobe.semi.z});
    Vec3 p = lobe.centre;
    while (contains(pore, p)) p += step * way;
    return p;
}

/// Scales the openings of the cracks from `first` on so that they take `share` of the box outside pores.
void open_to(double share, std::size_t first, Coating& coating)
{
    Coating alone{coating.size,
                  coating.pores,
                  {coating.cracks.begin() + static_cast<std::ptrdiff_t>(first), coating.cracks.end()}};
    const double grid = std::cbrt(coating.size.x * coating.size.y * coating.size.z) / 96.0;
    for (int round = 0; round < 2; ++round) {
        const double found = porosity(alone, grid).cracks;
        if (!(found > 0.0)) return;
        for (auto& crack : alone.cracks) crack.aperture *= share / found;
    }
    std::copy(alone.cracks.begin(), alone.cracks.end(), coating.cracks.begin() + static_cast<std::ptrdiff_t>(first));
}

void place_cracks(const CrackPopulation& c, std::int32_t number, const Settings& settings, Coating& coating)
{
    const Vec3& size = coating.size;
    const double box = size.x * size.y * size.z;
    const std::size_t first = coating.cracks.size();
    double cubes = 0.0, filled = 0.0;
    std::int64_t centred = 0;
    const auto enough = [&] {
        return c.count > 0       ? centred >= c.count
               : c.density > 0.0 ? cubes >= c.density * box
                                 : filled >= c.porosity * box;
    };
    for (std::uint64_t serial = 0; !enough(); ++serial) {
        Random random(static_cast<std::uint64_t>(settings.seed),
                      mixed(0x637261636b000000U + static_cast<std::uint64_t>(number)) + serial);
        Crack crack = shaped(c, random);
        crack.population = number;
        const double reach = std::max(crack.a, crack.b);
        bool placed = false;
        for (int tries = 0; tries < 2000 && !placed; ++tries) {
            const std::size_t earlier = coating.cracks.size() - first;
            crack.centre = anywhere(size, reach, random);
            const double way = random.uniform();
            if (way < c.at_pores) {
                const auto& pore =
                    coating
                        .pores[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(coating.pores.size())))];
                const double angle = random.uniform(0.0, 2.0 * pi);
                crack.centre = wall_point(pore, random) + 0.9 * (crack.a * std::cos(angle) * crack.frame.u +
                                                                 crack.b * std::sin(angle) * crack.frame.v);
            } else if (earlier > 0 && way < c.at_pores + (1.0 - c.at_pores) * c.clustered) {
                const auto parent = static_cast<std::size_t>(random.below(static_cast<std::int64_t>(earlier)));
                crack.centre = near(coating.cracks[first + parent].centre, c.cluster_radius, random);
            }
            placed = inside(crack.centre, size, reach) &&
                     (c.gap < 0.0 || std::all_of(coating.cracks.begin(), coating.cracks.end(), [&](const Crack& other) {
                          return norm(crack.centre - other.centre) >=
                                 c.gap * (std::sqrt(crack.a * crack.b) + std::sqrt(other.a * other.b));
                      }));
        }
        if (!placed)
            throw InvalidInput(
                fmt::format("synth: {} find no room after {} cracks; make gap, radius or density smaller", c.name,
                            coating.cracks.size() - first));
        if (inside(crack.centre, size)) {
            ++centred;
            cubes += std::pow(crack.a * crack.b, 1.5);
            filled += volume(crack);
        }
        coating.cracks.push_back(crack);
    }
    if (c.density > 0.0) {
        const double factor = std::cbrt(c.density * box / cubes);
        for (std::size_t i = first; i < coating.cracks.size(); ++i) {
            coating.cracks[i].a *= factor;
            coating.cracks[i].b *= factor;
        }
    }
    if (c.porosity > 0.0) open_to(c.porosity, first, coating);
}

}  // namespace

Coating make_coating(const Settings& settings)
{
    check(settings);
    if (settings.generator == Generator::splats)
        return spray(settings.splats, box_of(settings), static_cast<std::uint64_t>(settings.seed));
    Coating coating;
    coating.size = box_of(settings);
    for (const auto& p : settings.pores) coating.pore_names.push_back(p.name);
    for (const auto& c : settings.cracks) coating.crack_names.push_back(c.name);
    for (std::size_t i = 0; i < settings.pores.size(); ++i)
        place_pores(settings.pores[i], static_cast<std::int32_t>(i), settings, coating);
    for (std::size_t i = 0; i < settings.cracks.size(); ++i)
        place_cracks(settings.cracks[i], static_cast<std::int32_t>(i), settings, coating);
    return coating;
}

}  // namespace craze::synth
