#include "craze/domain/voxel_size_study.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace craze::domain {
namespace {

struct Levels {
    double matter = 170, empty = 0;
    int threshold = 150;
};

/// A stack of n^3 voxels with one slab from x_0 to x_0 + T (voxels), imaged with exact partial volumes.
microstructure::Microstructure slab(std::int64_t n, double x_0, double T, const Levels& levels)
{
    microstructure::Microstructure m;
    const Shape shape{n, n, n};
    m.gray.level = Volume<std::uint8_t>(shape);
    m.gray.voxel_size = 1.0;
    m.threshold = levels.threshold;
    m.pore = Mask(shape), m.crack = Mask(shape), m.matter = Mask(shape);
    for (std::int64_t z = 0; z < n; ++z)
        for (std::int64_t y = 0; y < n; ++y)
            for (std::int64_t x = 0; x < n; ++x) {
                const auto left = static_cast<double>(x);
                const double share = std::clamp(std::min(left + 1, x_0 + T) - std::max(left, x_0), 0.0, 1.0);
                const double gray = levels.matter - share * (levels.matter - levels.empty);
                m.gray.level(x, y, z) = static_cast<std::uint8_t>(std::lround(gray));
                const bool dark = std::lround(gray) < levels.threshold;
                m.crack.set(x, y, z, dark);
                m.matter.set(x, y, z, !dark);
            }
    return m;
}

double measured_T2(const microstructure::Microstructure& m, double L_0)
{
    const double n = static_cast<double>(m.crack.shape().nx), y = 0.5 * n;
    const auto voxels =
        voxels_in_cylinder({0.5 * (n - L_0), y, y}, {0.5 * (n + L_0), y, y}, 3.0, m, CountedVoid::crack);
    return intensity_thickness(voxels, L_0);
}

TEST(SubVoxelSlab, IsRecoveredWithTheStatedBias)
{
    for (const Levels& levels : {Levels{170, 0, 150}, Levels{170, 20, 150}, Levels{165, 45, 110}})
        for (const double T : {0.2, 0.5, 0.8, 1.0}) {
            double sum = 0.0;
            constexpr int offsets = 40;
            for (int k = 0; k < offsets; ++k) sum += measured_T2(slab(16, 8.0 + (k + 0.5) / offsets, T, levels), 12.0);
            const double expected = expected_T2_of_slab(T, 1.0, levels.matter, levels.empty, levels.threshold);
            EXPECT_NEAR(sum / offsets, expected, 0.01) << levels.empty << " " << T;
        }
    // Unbiased where void is black and S is the matter's level; 30 % at most with S at 15/17 of it.
    EXPECT_NEAR(expected_T2_of_slab(0.3, 1.0, 170, 0, 170), 0.3, 1e-12);
    for (const double T : {0.5, 0.75, 1.0}) EXPECT_NEAR(expected_T2_of_slab(T, 1.0, 170, 0, 150) / T, 1.0, 0.3);
    EXPECT_THROW(expected_T2_of_slab(1.5, 1.0, 170, 0, 150), InvalidInput);
}

TEST(SubVoxelSlab, ThinnerThanTheThresholdSeesIsLost)
{
    // A share of (matter - S) / (matter - empty) must be void before a voxel is dark.
    EXPECT_EQ(expected_T2_of_slab(0.4, 1.0, 165, 45, 110), 0.0);
    EXPECT_GT(expected_T2_of_slab(0.5, 1.0, 165, 45, 110), 0.0);
}

/// Bonds across the middle of a box of n^3, each of two elements of its own.
Domain bonds_across(std::int64_t n, double L_0, double mean_radius)
{
    Domain d;
    const double edge = static_cast<double>(n), middle = 0.5 * edge;
    d.box = {edge, edge, edge};
    for (std::int32_t k = 0; k < 60; ++k) {
        Random random(4, static_cast<std::uint64_t>(k));
        const Vec3 c{middle + random.uniform(-2, 2), random.uniform(20, 44), random.uniform(20, 44)};
        const Vec3 t = normalized({1.0, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)});
        for (const double end : {-0.5, 0.5}) {
            const Vec3 p = c + end * L_0 * t;
            d.elements.x.push_back(p.x), d.elements.y.push_back(p.y), d.elements.z.push_back(p.z);
            d.elements.r.push_back(mean_radius);
        }
        d.bonds.i.push_back(2 * k), d.bonds.j.push_back(2 * k + 1);
    }
    d.bonds.kind.assign(60, BondKind::beam);
    d.bonds.thickness.assign(60, 0.0);
    d.mean_radius = mean_radius;
    return d;
}

TEST(VoxelSizeStudy, MovesTheIntensityThicknessLittleAndLetsTheBinaryGrow)  // [Fig. 16]
{
    set_verbosity(Verbosity::quiet);
    microstructure::Settings classes;
    classes.threshold = microstructure::ThresholdMethod::fixed;
    classes.level = 165;
    const auto micro = microstructure::classify(slab(64, 30.3, 3.0, {170, 0, 165}).gray, classes);
    const auto d = discretise(bonds_across(64, 34.0, 17.0), micro, mesh::mesh_cracks(micro.crack, 1.0, {}), {});
    const auto study = voxel_size_study(d, micro, std::array<std::int64_t, 2>{2, 4}, classes, {}, {});
    ASSERT_EQ(study.size(), 3U);
    std::array<double, 3> T1{}, T2{};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(study[k].T1.size(), 60U);
        EXPECT_EQ(study[k].T2, study[k].same_T2);  // no bond is lost
        EXPECT_DOUBLE_EQ(study[k].voxel_size, static_cast<double>(1U << k));
        T1[k] = five_numbers(study[k].T1)[2], T2[k] = five_numbers(study[k].T2)[2];
    }
    EXPECT_NEAR(T2[1] / T2[0], 1.0, 0.10);
    EXPECT_NEAR(T2[2] / T2[0], 1.0, 0.10);
    EXPECT_GT(T1[1], T1[0]);
    EXPECT_GT(T1[2], 1.2 * T1[0]);
    const Json json = as_json(study);
    EXPECT_EQ(json.size(), 3U);
    EXPECT_EQ(json[2]["cut_bonds"], 60);
    EXPECT_THROW(coarsened(micro.gray, 0), InvalidInput);
    EXPECT_THROW(coarsened(micro.gray, 65), InvalidInput);
}

TEST(Coarsened, IsTheMeanOfEachBlockAndCutsOffTheRest)
{
    images::Gray gray{Volume<std::uint8_t>(Shape{11, 8, 7}), 2.0};
    Random random(8);
    for (auto& g : gray.level.values()) g = static_cast<std::uint8_t>(random.below(256));
    for (const std::int64_t factor : {1, 2, 3}) {
        const auto coarse = coarsened(gray, factor);
        const Shape s = coarse.level.shape();
        EXPECT_EQ(s, (Shape{11 / factor, 8 / factor, 7 / factor}));
        EXPECT_DOUBLE_EQ(coarse.voxel_size, 2.0 * static_cast<double>(factor));
        for (std::int64_t z = 0; z < s.nz; ++z)
            for (std::int64_t y = 0; y < s.ny; ++y)
                for (std::int64_t x = 0; x < s.nx; ++x) {
                    double sum = 0.0;
                    for (std::int64_t k = 0; k < factor * factor * factor; ++k)
                        sum += gray.level(x * factor + k % factor, y * factor + k / factor % factor,
                                          z * factor + k / factor / factor);
                    EXPECT_NEAR(coarse.level(x, y, z), sum / static_cast<double>(factor * factor * factor), 0.5);
                }
    }
}

}  // namespace
}  // namespace craze::domain
