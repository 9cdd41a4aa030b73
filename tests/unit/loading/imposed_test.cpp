#include "craze/loading/imposed.hpp"

#include "craze/core/errors.hpp"
#include "craze/loading/loading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace craze::loading {
namespace {

TEST(Density, IsReachedByTheStrainFoundForIt)
{
    const std::array<Drive, 3> equal{{{false, 1.0}, {false, 1.0}, {false, 1.0}}};
    const std::array<Drive, 3> uneven{{{false, 1.2}, {false, 0.7}, {false, 1.1}}};
    const std::array<Drive, 3> one{{{}, {}, {false, 1.0}}};
    for (const double eta : {0.0, 1e-6, 0.015, 0.2}) {
        EXPECT_NEAR(strain_at_density(equal, eta), std::cbrt(1.0 / (1.0 + eta)) - 1.0, 1e-15);
        EXPECT_NEAR(strain_at_density(one, eta), 1.0 / (1.0 + eta) - 1.0, 1e-15);
        const double s = strain_at_density(uneven, eta);
        EXPECT_NEAR((1 + 1.2 * s) * (1 + 0.7 * s) * (1 + 1.1 * s), 1.0 / (1.0 + eta), 1e-14);
    }
    EXPECT_THROW(strain_at_density({}, 0.01), InvalidInput);
    EXPECT_THROW(strain_at_density(equal, -0.1), InvalidInput);
    EXPECT_THROW(strain_at_density(equal, std::nan("")), InvalidInput);
}

TEST(Plan, MakesTheTwelveModuliAndAllCurvesOfOneSettings)
{
    Settings s;
    s.fracture.run = true;
    s.fracture.strengths = {10e9, 20e9};
    s.fracture.halvings = 1;
    s.fracture.cycles = {1e-3, 2e-3};
    s.programs.resize(1);
    const auto loadings = plan(s, {17.6e-6, 13.2e-6, 21.2e-6});
    std::set<std::string> names;
    std::array<int, 6> kinds{};
    for (const auto& loading : loadings) {
        names.insert(loading.name);
        ++kinds[static_cast<std::size_t>(loading.kind)];
    }
    EXPECT_EQ(names.size(), loadings.size()) << "names are unique";
    EXPECT_EQ(kinds, (std::array<int, 6>{24, 6, 4, 8, 2, 1}));
}

TEST(Plan, OfATriaxialTestMovesAllSidesAlikeAndSpacesDensityEvenly)
{
    Settings s;
    s.moduli.run = s.uniaxial.run = false;
    s.specimens = {"dense"};
    const Vec3 box{17.6e-6, 13.2e-6, 21.2e-6};
    const auto loadings = plan(s, box);
    ASSERT_EQ(loadings.size(), 1U);
    const Loading& loading = loadings[0];
    ASSERT_EQ(loading.path.size(), 30U);
    for (std::size_t k = 0; k < 30; ++k) {
        double volume = 1.0;
        for (int a = 0; a < 3; ++a) {
            const double strain = loading.drive[static_cast<std::size_t>(a)].factor * loading.path[k];
            EXPECT_NEAR(strain * box[a], loading.drive[0].factor * loading.path[k] * box.x, 1e-20);
            volume *= 1.0 + strain;
        }
        EXPECT_NEAR(1.0 / volume - 1.0, 0.015 * static_cast<double>(k + 1) / 30.0, 1e-13);
    }
}

TEST(Settings, OfNoMeaningAreRefusedBeforeAnyWork)
{
    const auto refused = [](auto&& spoil) {
        Settings s;
        spoil(s);
        EXPECT_THROW(check(s), InvalidInput);
    };
    EXPECT_NO_THROW(check(Settings{}));
    refused([](Settings& s) { s.specimens = {}; });
    refused([](Settings& s) { s.specimens = {"dense", "dense"}; });
    refused([](Settings& s) { s.specimens = {"crack"}; });
    refused([](Settings& s) { s.moduli.axes = "xw"; });
    refused([](Settings& s) { s.uniaxial.axes = "xx"; });
    refused([](Settings& s) { s.fracture.run = true, s.fracture.strengths.clear(); });
    refused([](Settings& s) { s.dense.material = "unobtainium"; });
    refused([](Settings& s) { s.programs.resize(1), s.programs[0].axes = {"free", "free", "free"}; });
    refused([](Settings& s) { s.programs.resize(1), s.programs[0].axes = {"free", "1"}; });
    refused([](Settings& s) { s.programs.resize(1), s.programs[0].turns.clear(); });
    refused([](Settings& s) { s.programs.resize(1), s.programs[0].strength = 1e10; });
    refused([](Settings& s) { s.programs.resize(2); });
}

TEST(Settings, TakeTheDenseCeramicFromTheLibraryUnlessGiven)
{
    Settings s;
    EXPECT_EQ(dense_material(s).E_D, 223e9);  // [Table 1]
    EXPECT_EQ(dense_material(s).nu_D, 0.29);
    EXPECT_EQ(dense_material(s).rho_D, 6060.0);
    s.dense.E_D = 100e9;
    EXPECT_EQ(dense_material(s).E_D, 100e9);
    EXPECT_EQ(dense_material(s).nu_D, 0.29);
}

}  // namespace
}  // namespace craze::loading
