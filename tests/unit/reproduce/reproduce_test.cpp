#include "craze/reproduce/reproduce.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/loading/specimen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace craze::reproduce {
namespace {

TEST(Targets, AreThePapersNumbersOnce)
{
    std::set<std::string> keys;
    for (const auto& t : targets()) {
        EXPECT_TRUE(keys.insert(t.key).second) << t.key;
        EXPECT_GT(t.paper, 0.0);
        EXPECT_GT(t.goal, 0.0);
    }
    EXPECT_EQ(target("E.both.y").paper, 74.0);
    EXPECT_NEAR(target("UCS/UTS.10").paper, 2.8, 0.01);
    EXPECT_NEAR(target("UCS/UTS.50").paper, 3.25, 0.01);
    try {
        target("E.both.w");
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("E.both."), std::string::npos);
    }
}

TEST(Statistics, AreMeanAndSampleDeviationOfWhatIsThere)
{
    const auto s = statistics({{{"a", 1.0}, {"b", 5.0}}, {{"a", 3.0}}, {{"a", 5.0}}});
    EXPECT_DOUBLE_EQ(s.at("a").mean, 3.0);
    EXPECT_DOUBLE_EQ(s.at("a").deviation, 2.0);
    EXPECT_EQ(s.at("b").count, 1);
    EXPECT_EQ(s.at("b").deviation, 0.0);
}

loading::Curve curve(const std::string& specimen, double T)
{
    loading::Curve c;
    c.loading.kind = loading::Loading::Kind::triaxial;
    c.loading.specimen = loading::parse_specimen(specimen);
    for (int p = 0; p < 10; ++p) {
        loading::Point point;
        point.eta = 0.0015 * p;
        point.pressure = 1e9 * p - 3e15 * T * p;
        c.points.push_back(point);
    }
    return c;
}

TEST(EquivalentThickness, IsFoundBetweenThoseTried)
{
    loading::Response r;
    r.curves.push_back(curve("cracks", 43e-9));
    const std::vector<double> tried{20e-9, 30e-9, 40e-9, 60e-9};
    for (const double T : tried) r.curves.push_back(curve("cracks " + std::to_string(std::lround(T * 1e9)) + " nm", T));
    EXPECT_NEAR(equivalent_thickness(r, tried), 43e-9, 0.1e-9);
    EXPECT_EQ(equivalent_thickness(r, {}), 0.0);
}

TEST(Parameters, SetWhatTheyGetAndNothingElse)
{
    for (const auto& p : parameters()) {
        synth::Settings recipe;
        std::map<std::string, double> before;
        for (const auto& q : parameters()) before[q.name] = q.get(recipe);
        EXPECT_GE(before[p.name], p.least);
        EXPECT_LE(before[p.name], p.most);
        p.set(recipe, 1.2 * before[p.name]);
        for (const auto& q : parameters())
            EXPECT_NEAR(q.get(recipe) / before[q.name], q.name == p.name ? 1.2 : 1.0, 1e-12) << p.name << " " << q.name;
        EXPECT_NO_THROW(synth::check(recipe));
    }
}

TEST(FitSettings, ThatCannotWorkAreRefused)
{
    EXPECT_NO_THROW(check(FitSettings{}));
    const auto refused = [](auto change) {
        FitSettings s;
        change(s);
        EXPECT_THROW(check(s), InvalidInput);
    };
    refused([](FitSettings& s) { s.parameters = {"densty"}; });
    refused([](FitSettings& s) { s.targets = {"E.both.q"}; });
    refused([](FitSettings& s) { s.targets = {"E.both.x"}; });
    refused([](FitSettings& s) { s.seeds.clear(); });
    synth::Settings recipe;
    recipe.cracks.pop_back();
    EXPECT_THROW(fit_coating(recipe, FitSettings{}), InvalidInput);
}

// One tiny search: it must not make the misfit worse, and must say what hangs on what.
TEST(Fit, OfATinyCoatingDoesNotGetWorse)
{
    FitSettings s;
    s.parameters = {"aperture"};
    s.targets = {"T2.median", "porosity.cracks"};
    s.seeds = {1};
    s.box = s.slope_box = 3.2e-6;
    s.rounds = 1;
    s.triaxial_points = 3;
    synth::Settings recipe;
    recipe.voxel_size = 47.2e-9;
    for (auto& c : recipe.cracks) c.aperture.median = 50e-9;
    const Fit fit = fit_coating(recipe, s);
    EXPECT_LE(fit.path.back().misfit, fit.path.front().misfit);
    EXPECT_GT(fit.sensitivity.at("porosity.cracks")[0], 0.5);
    EXPECT_NE(page(fit).find("fitted"), std::string::npos);
}

}  // namespace
}  // namespace craze::reproduce
