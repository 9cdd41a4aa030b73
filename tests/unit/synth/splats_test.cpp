#include "craze/synth/splats.hpp"

#include "craze/core/errors.hpp"
#include "craze/synth/height_field.hpp"
#include "craze/synth/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include <cmath>

namespace craze::synth {
namespace {

HeightField rough()
{
    HeightField field(3e-6, 2e-6, 0.1e-6);
    Random random(3);
    for (auto& z : field.z) z = random.uniform(0.0, 1e-6);
    return field;
}

TEST(ClosingByParabola, EqualsItsDefinitionAndIsIdempotent)
{
    const HeightField field = rough(), closed = closed_by_parabola(field, 0.3e-6);
    const auto fall = [&](std::size_t i, std::size_t j) {
        return field.distance(i, j) * field.distance(i, j) / (2.0 * 0.3e-6);
    };
    std::vector<double> dilated(field.z.size(), -1.0);
    for (std::size_t i = 0; i < dilated.size(); ++i)
        for (std::size_t j = 0; j < dilated.size(); ++j) dilated[i] = std::max(dilated[i], field.z[j] - fall(i, j));
    for (std::size_t i = 0; i < dilated.size(); ++i) {
        double least = 1.0;
        for (std::size_t j = 0; j < dilated.size(); ++j) least = std::min(least, dilated[j] + fall(i, j));
        EXPECT_NEAR(closed.z[i], least, 1e-18);
        EXPECT_GE(closed.z[i], field.z[i]);
    }
    const HeightField again = closed_by_parabola(closed, 0.3e-6);
    for (std::size_t i = 0; i < again.z.size(); ++i) EXPECT_NEAR(again.z[i], closed.z[i], 1e-18);
}

TEST(PatchShape, OfATiltedEllipseIsThatEllipse)
{
    const HeightField field(8e-6, 8e-6, 0.05e-6);
    std::vector<std::size_t> patch;
    for (std::size_t i = 0; i < field.z.size(); ++i) {
        const auto p = field.place(i);
        const double x = p[0] - 4e-6, y = p[1] - 4e-6, u = 0.6 * x + 0.8 * y, v = -0.8 * x + 0.6 * y;
        if (u * u / 9e-12 + v * v / 2.25e-12 < 1.0) patch.push_back(i);
    }
    const auto shape = shape_of(field, patch, [&](std::size_t i) { return 1e-6 + 0.1 * field.place(i)[0]; });
    EXPECT_NEAR(shape.a, 3e-6, 0.03e-6);
    EXPECT_NEAR(shape.b, 1.5e-6, 0.03e-6);
    EXPECT_NEAR(shape.centre.z, 1.4e-6, 1e-9);
    EXPECT_NEAR(std::abs(dot(shape.frame.u, normalized({0.6, 0.8, 0.06}))), 1.0, 1e-3);
    EXPECT_NEAR(dot(shape.frame.n, normalized({-0.1, 0.0, 1.0})), 1.0, 1e-6);
}

TEST(ConnectedPatches, AreToldApart)
{
    HeightField field(4, 3, 1);
    const auto patches = connected_patches(field, {1, 1, 0, 1, 0, 1, 0, 1, 1, 0, 1, 0});
    ASSERT_EQ(patches.size(), 4U);  // diagonal neighbours do not touch
    EXPECT_EQ(patches[0].size(), 3U);
    EXPECT_EQ(patches[1].size(), 2U);
}

TEST(SprayedCoating, HasPoresAndCracksOfBothKinds)
{
    const Vec3 size{12e-6, 10e-6, 9e-6};
    const Coating coating = spray({}, size, 1);
    std::array<int, 2> pores{}, cracks{};
    double across = 0.0, along = 0.0;
    for (const auto& pore : coating.pores) ++pores[static_cast<std::size_t>(pore.population)];
    for (const auto& crack : coating.cracks) {
        ++cracks[static_cast<std::size_t>(crack.population)];
        (crack.population == 0 ? across : along) += std::abs(crack.frame.n.z);
    }
    for (const int n : {pores[0], pores[1], cracks[0], cracks[1]}) EXPECT_GT(n, 10);
    EXPECT_LT(across / cracks[0], 0.3);  // intra-splat cracks stand upright, inter-splat cracks lie
    EXPECT_GT(along / cracks[1], 0.7);
    const Porosity found = porosity(coating, 0.15e-6);
    EXPECT_GT(found.pores, 0.01);
    EXPECT_LT(found.pores, 0.25);
    EXPECT_GT(found.cracks, 0.002);
}

TEST(SprayedCoating, HasTheBubblesItIsAskedFor)
{
    Splats splats;
    splats.unbonded = splats.cracked = 0.0;
    splats.bubbles = 0.05;
    Coating coating = spray(splats, {16e-6, 16e-6, 12e-6}, 4);
    EXPECT_TRUE(coating.cracks.empty());
    std::erase_if(coating.pores, [](const Pore& pore) { return pore.population != 0; });
    EXPECT_NEAR(porosity(coating, 0.15e-6).pores, 0.05, 0.012);
}

TEST(SprayedCoating, DependsOnItsSeedOnly)
{
    const Vec3 size{6e-6, 6e-6, 5e-6};
    const Coating one = spray({}, size, 1), again = spray({}, size, 1), other = spray({}, size, 2);
    ASSERT_EQ(one.cracks.size(), again.cracks.size());
    for (std::size_t i = 0; i < one.cracks.size(); ++i) EXPECT_EQ(one.cracks[i].centre, again.cracks[i].centre);
    EXPECT_NE(one.cracks[0].centre, other.cracks[0].centre);
}

TEST(SplatSettings, OutOfOrderAreRefused)
{
    Splats splats;
    splats.thickness.least = 5e-6;
    EXPECT_THROW(check(splats), InvalidInput);
}

}  // namespace
}  // namespace craze::synth
