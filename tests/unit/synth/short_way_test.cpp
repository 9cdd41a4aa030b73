#include "craze/synth/short_way.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"
#include "craze/synth/cutter.hpp"
#include "craze/synth/synth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::synth {
namespace {

/// Points anywhere, bonded at random within reach: the short way asks nothing more of a domain.
domain::Domain scattered(const Vec3& box, int n, double length)
{
    domain::Domain d;
    d.box = box;
    Random random(5);
    for (int e = 0; e < n; e += 2) {
        const Vec3 a{random.uniform(0, box.x), random.uniform(0, box.y), random.uniform(0, box.z)};
        const Vec3 way = normalized({random.normal(), random.normal(), random.normal()});
        for (const Vec3& p : {a, a + length * random.uniform(0.6, 1.0) * way}) {
            d.elements.x.push_back(std::clamp(p.x, 0.0, box.x));
            d.elements.y.push_back(std::clamp(p.y, 0.0, box.y));
            d.elements.z.push_back(std::clamp(p.z, 0.0, box.z));
            d.elements.r.push_back(0.5 * length);
        }
        auto& pairs = e % 4 == 0 ? d.bonds.i : d.near.i;
        pairs.push_back(e);
        (e % 4 == 0 ? d.bonds.j : d.near.j).push_back(e + 1);
    }
    d.bonds.kind.assign(d.bonds.i.size(), domain::BondKind::beam);
    d.bonds.thickness.assign(d.bonds.i.size(), 0.0);
    d.near.thickness.assign(d.near.i.size(), 0.0);
    return d;
}

TEST(Cutter, FindsTheCrossingsThatWalkingAlongTheSegmentFinds)
{
    Settings s;
    s.shape = {100, 90, 80};
    s.voxel_size = 50e-9;
    const Coating coating = make_coating(s);
    const domain::Domain d = scattered(coating.size, 4800, 0.4e-6);
    const Cutter cutter(coating, 0.3e-6);
    int crossed = 0;
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) {
        const Vec3 from = d.elements.centre(d.bonds.i[b]), to = d.elements.centre(d.bonds.j[b]);
        std::vector<Crossing> found;
        cutter.cross(0.5 * (from + to), from, to, found);
        std::size_t walked = 0;
        for (const auto& crack : coating.cracks) {
            double before = view(crack, from).distance;
            for (int p = 1; p <= 400; ++p) {
                const CrackView seen = view(crack, from + (p / 400.0) * (to - from));
                if ((before < 0.0) != (seen.distance < 0.0) && seen.opening > 0.0 &&
                    !in_pore(coating, from + (p / 400.0) * (to - from)))
                    ++walked;
                before = seen.distance;
            }
        }
        EXPECT_NEAR(static_cast<double>(found.size()), static_cast<double>(walked), found.empty() ? 1.0 : 0.0) << b;
        crossed += !found.empty();
        for (const auto& crossing : found) EXPECT_FALSE(in_pore(coating, crossing.point));
    }
    EXPECT_GT(crossed, 100);
}

TEST(ShortWay, GivesASlabItsThicknessOverTheCosine)
{
    Coating coating{{4e-6, 4e-6, 4e-6}, {}, {}};
    Crack slab{.centre = {2e-6, 2e-6, 2e-6}, .frame = frame_about({0, 0, 1}, 0.0), .a = 9e-6, .b = 9e-6};
    slab.aperture = 40e-9;
    slab.profile = ApertureProfile::flat;
    coating.cracks.push_back(slab);
    const auto cut = discretise(coating, scattered(coating.size, 4000, 0.4e-6), 30e-9);
    int seen = 0;
    for (std::size_t b = 0; b < cut.bonds.cut.size(); ++b) {
        const Vec3 from = cut.dense.elements.centre(cut.dense.bonds.i[b]),
                   to = cut.dense.elements.centre(cut.dense.bonds.j[b]);
        EXPECT_EQ(cut.bonds.cut[b] > 0, (from.z < 2e-6) != (to.z < 2e-6));
        if (cut.bonds.cut[b] == 0) continue;
        const double cosine = std::abs(to.z - from.z) / norm(to - from);
        const bool deep = std::min(std::abs(from.z - 2e-6), std::abs(to.z - 2e-6)) > 30e-9;  // all lines cross
        if (!deep || cosine < 0.2) continue;
        EXPECT_NEAR(cut.bonds.T1[b], 40e-9 / cosine, 1e-15);
        EXPECT_NEAR(cut.bonds.T2[b], 40e-9 / cosine, 1e-15);
        ++seen;
    }
    EXPECT_GT(seen, 20);
}

TEST(ShortWay, CarvesByCentresAndHasTheSameBitsOnAnyNumberOfThreads)
{
    Settings s;
    s.shape = {100, 90, 80};
    s.voxel_size = 50e-9;
    const Coating coating = make_coating(s);
    set_threads(1);
    const auto one = discretise(coating, scattered(coating.size, 6000, 0.4e-6), 69e-9);
    set_threads(2);
    const auto two = discretise(coating, scattered(coating.size, 6000, 0.4e-6), 69e-9);
    set_threads(0);
    EXPECT_EQ(one.in_pore, two.in_pore);
    EXPECT_EQ(one.bonds.cut, two.bonds.cut);
    EXPECT_EQ(one.bonds.T2, two.bonds.T2);
    EXPECT_EQ(one.near.T1, two.near.T1);
    for (std::int32_t e = 0; e < one.dense.elements.size(); ++e)
        EXPECT_EQ(one.in_pore[static_cast<std::size_t>(e)] != 0, in_pore(coating, one.dense.elements.centre(e)));
    const auto carved = static_cast<double>(std::ranges::count(one.in_pore, 1));
    EXPECT_NEAR(carved / one.dense.elements.size(), one.p_vx, 0.012);
}

TEST(ShortWay, NeedsTheCoatingsBox)
{
    const Coating coating{{4e-6, 4e-6, 4e-6}, {}, {}};
    EXPECT_THROW(discretise(coating, scattered({4e-6, 4e-6, 5e-6}, 10, 0.4e-6), 69e-9), InvalidInput);
}

TEST(Sight, OfNothingIsTheOpening)
{
    const Sight sight;
    EXPECT_EQ(sight.width(37e-9), 37e-9);
    EXPECT_EQ(sight.intensity(37e-9), 37e-9);
    EXPECT_EQ(sight.least_opening(), 0.0);
}

// Twin: voxel rows across a flat crack, rendered and recorded at many positions, measured by Eqs. 14 and 15.
TEST(Sight, IsWhatVoxelsAcrossAFlatCrackMeasure)
{
    const double S = 111.0, h = 1.0;
    for (const double blur : {0.0, 0.5}) {
        const Microscope m{.blur = blur, .noise = 0, .stripes = 0, .shading_y = 0};
        const Sight sight(m, h, S);
        for (const double t : {0.3, 0.6, 1.0, 1.7, 4.0, 15.0}) {
            double width = 0.0, intensity = 0.0;
            constexpr int positions = 200, n = 40;
            for (int p = 0; p < positions; ++p) {
                const double middle = 0.5 * n + (p + 0.5) / positions;
                std::vector<float> share(n * 9), work(n * 9);
                for (int x = 0; x < n; ++x)
                    for (std::size_t y = 0; y < 9; ++y)
                        share[static_cast<std::size_t>(x) + n * y] = static_cast<float>(
                            std::max(0.0, std::min(x + 1.0, middle + t / 2) - std::max(x + 0.0, middle - t / 2)));
                std::vector<std::uint8_t> gray(n * 9);
                record_slice(m, share, n, 9, 0, 1, 1, work, gray);
                for (std::size_t x = 0; x < n; ++x) {
                    const double level = gray[x + n * 4];
                    if (level >= S) continue;
                    width += 1.0 / positions;
                    intensity += (1.0 - level / S) / positions;
                }
            }
            EXPECT_NEAR(sight.width(t), width, 0.02) << t << " blur " << blur;
            EXPECT_NEAR(sight.intensity(t), intensity, 0.01) << t << " blur " << blur;
            EXPECT_EQ(width > 0.5, t > sight.least_opening());
        }
    }
    EXPECT_THROW(Sight(Microscope{}, h, 200.0), InvalidInput);
}

}  // namespace
}  // namespace craze::synth
