#include "craze/loading/theory.hpp"
#include "craze/reproduce/reproduce.hpp"

#include <gtest/gtest.h>

namespace craze::reproduce {
namespace {

// The first seed of the small size, without images, at one bond strength. Bands are those of docs/reproduction.md.
class SmallSize : public testing::Test {
protected:
    static const Numbers& numbers()
    {
        static const Numbers measured = [] {
            synth::Settings recipe = reproduce::recipe();
            recipe.shape = shape_of(Size::small, recipe.voxel_size);
            Study study;
            study.triaxial_points = 10;
            study.strengths = {10e9};
            const Bench bench = make_bench(synth::box_of(recipe), study, recipe.seed, true);
            return measure(recipe, bench, study).numbers;
        }();
        return measured;
    }
    /// Within `share` of a stored value.
    static void expect(const std::string& key, double stored, double share)
    {
        EXPECT_NEAR(numbers().at(key) / stored, 1.0, share) << key << " is " << numbers().at(key);
    }
};

TEST_F(SmallSize, HasThePrintedPorosities)
{
    // True ones; the image chain reads 2.4 % more pores and 4 % less cracks, 5.91 and 3.03 % (docs/reproduction.md).
    expect("porosity.pores", target("porosity.pores").paper, 0.03);
    expect("porosity.cracks", 3.145, 0.01);
    expect("porosity.total", target("porosity.total").paper, 0.03);
    expect("p_DE", target("p_DE").paper, 0.03);
}

TEST_F(SmallSize, KeepsItsModuli)  // [Table 3]
{
    const std::pair<const char*, double> stored[] = {
        {"E.dense.x", 222.0},  {"E.dense.y", 223.1}, {"E.dense.z", 224.0},  {"E.pores.x", 184.6},
        {"E.pores.y", 185.4},  {"E.pores.z", 181.6}, {"E.cracks.x", 112.1}, {"E.cracks.y", 120.0},
        {"E.cracks.z", 147.9}, {"E.both.x", 75.8},   {"E.both.y", 90.7},    {"E.both.z", 112.0}};
    for (const auto& [key, value] : stored) expect(key, value, 0.05);
    const double p = numbers().at("p_DE") / 100.0;
    const double mean = (numbers().at("E.pores.x") + numbers().at("E.pores.y") + numbers().at("E.pores.z")) / 3.0;
    EXPECT_NEAR(1e9 * mean / loading::porous_modulus({223e9, 0.29}, p), 1.0, 0.10);  // [Eq. 18]
    EXPECT_LT(1e9 * mean, loading::hashin_shtrikman({223e9, 0.29}, p).E);
}

TEST_F(SmallSize, KeepsItsClosingAndThickness)  // [Figs. 16, 21]
{
    expect("ratio.pores", 0.801, 0.03);
    expect("ratio.cracks", 0.442, 0.05);
    expect("ratio.both", 0.305, 0.05);
    expect("T2.median", target("T2.median").paper, 0.20);
    EXPECT_GT(numbers().at("K.end"), 1.2 * numbers().at("K.start"));
}

TEST_F(SmallSize, IsStrongerInCompression)  // [Table 4]
{
    // Far from the paper's 171 MPa and 2.8: docs/reproduction.md, "Strengths".
    expect("UTS.10", 37.9, 0.15);
    expect("UCS.10", 61.9, 0.15);
    expect("UCS/UTS.10", 1.63, 0.10);
    EXPECT_GT(numbers().at("new.compression"), numbers().at("new.tension"));
}

}  // namespace
}  // namespace craze::reproduce
