#include "craze/domain/room.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/domain/vtkhdf.hpp"
#include "craze/io/atomic_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

namespace craze::domain {
namespace {

namespace fs = std::filesystem;

// 64^3 voxels: a spherical pore of 12 px, and a crack two voxels thick in the plane z = 40 with its sheet.
struct Sample {
    microstructure::Microstructure micro;
    mesh::CrackSurface surface;
    static constexpr double h = 50e-9, R_C = 4.0;

    Sample()
    {
        const Shape shape{64, 64, 64};
        micro.gray.level = Volume<std::uint8_t>(shape, 180);
        micro.gray.voxel_size = h;
        micro.threshold = 100;
        micro.pore = Mask(shape);
        micro.crack = Mask(shape);
        for (std::int64_t z = 0; z < 64; ++z)
            for (std::int64_t y = 0; y < 64; ++y)
                for (std::int64_t x = 0; x < 64; ++x) {
                    const auto square = [](std::int64_t v) { return static_cast<double>(v * v); };
                    if (square(x - 20) + square(y - 30) + square(z - 18) < 144) micro.pore.set(x, y, z, true);
                    if (z == 39 || z == 40) micro.crack.set(x, y, z, true);
                    if (micro.pore(x, y, z) || micro.crack(x, y, z)) micro.gray.level(x, y, z) = 25;
                }
        micro.matter = difference(complement(micro.pore), micro.crack);
        constexpr double edge = 64 * h, z = 40 * h;
        surface = {{{0, 0, z}, {edge, 0, z}, {edge, edge, z}, {0, edge, z}}, {{0, 1, 2}, {0, 2, 3}}, {2, 2}};
    }
};

void expect_same(const Discretisation& a, const Discretisation& b)
{
    EXPECT_EQ(a.dense.elements.x, b.dense.elements.x);
    EXPECT_EQ(a.dense.elements.y, b.dense.elements.y);
    EXPECT_EQ(a.dense.elements.z, b.dense.elements.z);
    EXPECT_EQ(a.dense.elements.r, b.dense.elements.r);
    EXPECT_EQ(a.dense.bonds.i, b.dense.bonds.i);
    EXPECT_EQ(a.dense.bonds.j, b.dense.bonds.j);
    EXPECT_EQ(a.dense.near.j, b.dense.near.j);
    EXPECT_EQ(a.dense.mean_radius, b.dense.mean_radius);
    EXPECT_EQ(a.dense.dense_volume, b.dense.dense_volume);
    EXPECT_EQ(a.in_pore, b.in_pore);
    EXPECT_EQ(a.bonds.cut, b.bonds.cut);
    EXPECT_EQ(a.bonds.T1, b.bonds.T1);
    EXPECT_EQ(a.bonds.T2, b.bonds.T2);
    EXPECT_EQ(a.near.cut, b.near.cut);
    EXPECT_EQ(a.near.T2, b.near.T2);
    EXPECT_EQ(a.p_vx, b.p_vx);
}

class Discretising : public ::testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    void TearDown() override { set_threads(0); }
    Sample sample;
};

TEST_F(Discretising, TakesTheElementsInPoresAndCutsTheBondsAtTheCrack)
{
    const Discretisation d = discretise(sample.micro, sample.surface, Sample::R_C, {});
    EXPECT_DOUBLE_EQ(d.dense.mean_radius, 4 * Sample::h);  // R_DE = R_C [Eq. 11]
    EXPECT_DOUBLE_EQ(d.dense.box.x, 64 * Sample::h);
    const auto& el = d.dense.elements;
    for (std::int32_t e = 0; e < el.size(); ++e) {
        const Vec3 c = el.centre(e) / Sample::h;
        EXPECT_EQ(d.in_pore[static_cast<std::size_t>(e)] != 0,
                  sample.micro.pore(std::int64_t(c.x), std::int64_t(c.y), std::int64_t(c.z)));
    }
    std::int64_t cut = 0, measured = 0;
    for (std::int32_t b = 0; b < d.dense.bonds.size(); ++b) {
        const auto k = static_cast<std::size_t>(b);
        const double z_i = el.z[static_cast<std::size_t>(d.dense.bonds.i[k])],
                     z_j = el.z[static_cast<std::size_t>(d.dense.bonds.j[k])];
        const bool crosses = (z_i < 40 * Sample::h) != (z_j < 40 * Sample::h);
        ASSERT_EQ(d.bonds.cut[k] != 0, crosses);
        cut += crosses;
        // A slab two voxels thick, seen along a bond that reaches well beyond it on both sides.
        const double slope = std::abs(z_j - z_i) / rest_length(d.dense, b);
        const double nearest = std::min(std::abs(z_i - 40 * Sample::h), std::abs(z_j - 40 * Sample::h));
        if (crosses && slope > 0.9 && nearest > 2 * Sample::h) {
            ++measured;
            EXPECT_NEAR(d.bonds.T1[k] / (2 * Sample::h / slope), 1.0, 0.35);
            EXPECT_NEAR(d.bonds.T2[k], 0.75 * d.bonds.T1[k], 1e-12);
        }
        if (!crosses) {
            ASSERT_EQ(d.bonds.T1[k], 0.0);
        }
    }
    EXPECT_GT(cut, 50);
    EXPECT_GT(measured, 5);
    std::int64_t near_cut = 0;
    for (std::size_t p = 0; p < d.dense.near.i.size(); ++p) {
        const double z_i = el.z[static_cast<std::size_t>(d.dense.near.i[p])],
                     z_j = el.z[static_cast<std::size_t>(d.dense.near.j[p])];
        const bool crosses = (z_i < 40 * Sample::h) != (z_j < 40 * Sample::h);
        ASSERT_EQ(d.near.cut[p] != 0, crosses);
        near_cut += crosses;
        EXPECT_EQ(d.near.T2[p] > 0.0, crosses);
    }
    EXPECT_GT(near_cut, 10);
}

TEST_F(Discretising, MeasuresCracksInACylinderOfRTildeMeanRadii)  // [Eq. 3]
{
    // One bond of 20 px through a sheet; void one px thick lies in a ring of 3 to 5 px around its line.
    Domain pair;
    constexpr double h = Sample::h;
    pair.box = Vec3{64, 64, 64} * h;
    pair.mean_radius = 10 * h;
    pair.elements = {{32.5 * h, 32.5 * h}, {30.5 * h, 30.5 * h}, {30 * h, 50 * h}, {10 * h, 10 * h}};
    pair.bonds = {{0}, {1}, {BondKind::beam}, {0.0}};
    sample.micro.pore = Mask(Shape{64, 64, 64});
    sample.micro.crack = Mask(Shape{64, 64, 64});
    std::int64_t ring = 0, disc = 0;
    for (std::int64_t x = 20; x < 45; ++x)
        for (std::int64_t y = 20; y < 45; ++y) {
            const auto r2 = (x - 32) * (x - 32) + (y - 30) * (y - 30);
            disc += r2 <= 25;
            if (r2 < 9 || r2 > 25) continue;
            ++ring;
            sample.micro.crack.set(x, y, 40, true);
            sample.micro.gray.level(x, y, 40) = 0;
        }
    const auto T = [&](double r_tilde) {
        Settings s;
        s.r_tilde = r_tilde;
        const Discretisation d = discretise(pair, sample.micro, sample.surface, s);
        EXPECT_EQ(d.bonds.cut[0], 1);
        EXPECT_EQ(d.bonds.T1[0], d.bonds.T2[0]);
        return d.bonds.T1[0] / h;
    };
    EXPECT_EQ(T(0.28), 0.0);
    EXPECT_NEAR(T(0.5), static_cast<double>(ring) / static_cast<double>(disc), 1e-9);
}

TEST_F(Discretising, TakesThePoresShareOfTheMass)
{
    // A pore of some 15 elements: one packing scatters by an eighth, the mean of nine by a third of that.
    double sum = 0.0;
    for (std::int64_t seed = 1; seed <= 9; ++seed) {
        Settings settings;
        settings.seed = seed;
        const Discretisation d = discretise(sample.micro, sample.surface, Sample::R_C, settings);
        sum += discrete_porosity(d) / d.p_vx;
    }
    EXPECT_NEAR(sum / 9, 1.0, 0.12);
}

TEST_F(Discretising, CutsBondsByVoxelsAsByTheSheet)
{
    Settings by_voxels;
    by_voxels.cut_by = CutBy::voxels;
    const Discretisation a = discretise(sample.micro, sample.surface, Sample::R_C, {}),
                         b = discretise(sample.micro, sample.surface, Sample::R_C, by_voxels);
    // What the sheet cuts the voxels cut; voxels are thicker, so they cut those that end inside the crack as well.
    std::int64_t more = 0;
    for (std::size_t k = 0; k < a.bonds.cut.size(); ++k) {
        if (a.bonds.cut[k] != 0) {
            ASSERT_NE(b.bonds.cut[k], 0);
        }
        more += a.bonds.cut[k] == 0 && b.bonds.cut[k] != 0;
    }
    EXPECT_GT(more, 0);
}

TEST_F(Discretising, GivesTheSameBitsOnAnyNumberOfThreads)
{
    set_threads(1);
    const Discretisation one = discretise(sample.micro, sample.surface, Sample::R_C, {});
    set_threads(2);
    expect_same(one, discretise(sample.micro, sample.surface, Sample::R_C, {}));
}

TEST_F(Discretising, IsReadBackAsItWasSaved)
{
    const fs::path folder = fs::path(::testing::TempDir()) / "craze_domain_room";
    const Discretisation d = discretise(sample.micro, sample.surface, Sample::R_C, {});
    save(d, {}, folder);
    expect_same(load_discretisation(folder), d);
    const Domain cracked = with_defects(d, {});
    write_vtkhdf(cracked, folder / "cracked.vtkhdf");
    const Domain back = read_vtkhdf(folder / "cracked.vtkhdf");
    EXPECT_EQ(back.bonds.kind, cracked.bonds.kind);
    EXPECT_EQ(back.bonds.thickness, cracked.bonds.thickness);
    EXPECT_EQ(back.near.thickness, cracked.near.thickness);
    // Taken through loading without its images it keeps its pores and cracks.
    Settings alone;
    alone.import_from.elements = (folder / "domain.vtkhdf").string();
    alone.import_from.alone = true;
    expect_same(import_domain(alone), d);
    alone.import_from.elements = (folder / "cracked.vtkhdf").string();
    EXPECT_EQ(with_defects(import_domain(alone), {}).bonds.thickness, cracked.bonds.thickness);
    Discretisation thick = d;
    thick.bonds.T2[0] = 1.0;
    write_vtkhdf(thick, folder / "domain.vtkhdf");
    EXPECT_THROW(load_discretisation(folder), InvalidInput);
    fs::remove_all(folder);
    EXPECT_THROW(load_discretisation(folder), InvalidInput);
}

TEST_F(Discretising, WritesTheWeightOfTheCeramicForOthers)
{
    const fs::path folder = fs::path(::testing::TempDir()) / "craze_domain_room_weight";
    Discretisation d = discretise(sample.micro, sample.surface, Sample::R_C, {});
    Settings s;
    s.write = {"lammps"};
    save(d, s, folder, 3950.0);
    const std::string text = io::read_text(folder / "specimen/lammps/domain.data");
    std::istringstream atoms(text.substr(text.find("bpm/sphere") + 10));
    double id = 0, type = 0, molecule = 0, diameter = 0, density = 0, x = 0, y = 0, z = 0, mass = 0.0;
    while (atoms >> id >> molecule >> type >> diameter >> density >> x >> y >> z)
        mass += density * 3.14159265358979 / 6.0 * diameter * diameter * diameter;
    const double box = d.dense.box.x * d.dense.box.y * d.dense.box.z;
    EXPECT_NEAR(mass / (3950.0 * box * (1.0 - discrete_porosity(d))), 1.0, 1e-9);
    fs::remove_all(folder);
}

TEST_F(Discretising, SumsUp)
{
    const Json json = summary(discretise(sample.micro, sample.surface, Sample::R_C, {}));
    EXPECT_GT(json["elements"], 500);
    EXPECT_EQ(json["specimen"]["contact_beams"].get<int>() > 0, true);
    EXPECT_NEAR(json["T2_m"]["median"].get<double>() / json["T1_m"]["median"].get<double>(), 0.75, 1e-9);
    EXPECT_NEAR(json["dense"]["interior_cardinality"].get<double>(), 6.2, 0.05);
}

TEST_F(Discretising, SaysWhenElementsAreSqueezed)
{
    take_notices();
    Settings s;
    s.density = 0.2;
    pack(Vec3{2e-6, 2e-6, 2e-6}, 200e-9, s);
    const auto notices = take_notices();
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices[0].find("squeezed"), std::string::npos);
    pack(Vec3{2e-6, 2e-6, 2e-6}, 200e-9, {});
    EXPECT_TRUE(take_notices().empty());
}

TEST_F(Discretising, SaysWhenElementsAreSmallerOrLargerThanTheClosingBall)
{
    Settings s;
    s.mean_radius = 3.5 * Sample::h;
    take_notices();
    discretise(sample.micro, sample.surface, Sample::R_C, s);
    ASSERT_EQ(take_notices().size(), 1U);
    s.mean_radius = 5 * Sample::h;
    discretise(sample.micro, sample.surface, Sample::R_C, s);
    EXPECT_NE(take_notices().at(0).find("Eq. 8"), std::string::npos);
}

TEST(DomainSettings, RefuseNonsense)
{
    const auto refuses = [](auto change) {
        Settings s;
        change(s);
        EXPECT_THROW(check(s), InvalidInput);
    };
    refuses([](Settings& s) { s.mean_radius = -1.0; });
    refuses([](Settings& s) { s.dispersion = std::nan(""); });
    refuses([](Settings& s) { s.cardinality = 20.0; });
    refuses([](Settings& s) { s.r_tilde = 0.0; });
    EXPECT_DOUBLE_EQ(recipe({}, 1.0).half_width, 0.125);
    Settings wide;
    wide.dispersion_means = DispersionMeans::each_side;
    EXPECT_DOUBLE_EQ(recipe(wide, 1.0).half_width, 0.25);
}

}  // namespace
}  // namespace craze::domain
