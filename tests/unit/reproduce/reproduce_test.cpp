#include "craze/reproduce/settings.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/loading/specimen.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

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
    EXPECT_NEAR(equivalent_thickness(r, tried, 1.0), 43e-9, 0.1e-9);
    EXPECT_EQ(equivalent_thickness(r, {}, 1.0), 0.0);
}

TEST(EquivalentThickness, LooksAtTheCurveUpToTheDensityAskedFor)
{
    loading::Response r;
    auto open = curve("cracks", 25e-9);
    const auto later = curve("cracks", 50e-9);
    for (std::size_t p = 5; p < open.points.size(); ++p) open.points[p].pressure = later.points[p].pressure;
    r.curves.push_back(open);
    const std::vector<double> tried{60e-9, 20e-9, 40e-9};
    for (const double T : tried) r.curves.push_back(curve("cracks " + std::to_string(std::lround(T * 1e9)) + " nm", T));
    EXPECT_NEAR(equivalent_thickness(r, tried, 0.0015 * 4), 25e-9, 0.1e-9);
    const double whole = equivalent_thickness(r, tried, 1.0);
    EXPECT_GT(whole, 40e-9);
    EXPECT_LT(whole, 50e-9);
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

// The recipe that docs/reproduction.md speaks of is what the program does when none is given.
TEST(Recipe, InTheExamplesIsTheBuiltInOne)
{
    AllSettings file = read({CRAZE_SOURCE_DIR "/examples/coating.toml", {}}), built_in;
    const auto text = [](synth::Settings& s) {
        return pipeline::settings_json([&](Schema& schema) { describe(schema, s); }).dump(1);
    };
    EXPECT_EQ(text(file.synth), text(built_in.synth));
    EXPECT_THROW(read({"", {"reproduce.seeds=[1, 1]"}}), InvalidInput);
    EXPECT_THROW(read({"", {"reproduce.search=8"}}), InvalidInput);
    EXPECT_THROW(read({"", {"fit.targets=[\"E.both.q\"]"}}), InvalidInput);
}

// The short way of a small, coarse coating, stopped and gone on with: nothing is measured twice.
TEST(Reproduction, GoesOnFromWhatIsDoneAndWritesItsPages)
{
    const auto folder = std::filesystem::temp_directory_path() / ("craze_reproduce_" + std::to_string(getpid()));
    synth::Settings recipe;
    recipe.voxel_size = 47.2e-9;
    recipe.shape = {68, 68, 68};
    Study study;
    study.uniaxial_points = 1;
    study.triaxial_points = 3;
    study.strengths = {30e9};
    study.crossings = 2;
    study.cycles = {-1e-3};
    const Bench bench = make_bench(synth::box_of(recipe), study, 1, false);
    const Keep keep{folder / "seed_1", "key", true};
    const auto first = measure(recipe, bench, study, keep);
    std::filesystem::remove(folder / "seed_1" / "cycles_30_GPa" / "stamp.txt");
    const auto again = measure(recipe, bench, study, keep);
    EXPECT_EQ(first.numbers, again.numbers);
    EXPECT_TRUE(first.numbers.contains("UCS/UTS.30"));
    EXPECT_EQ(first.response.curves.size(), again.response.curves.size());

    // The same cracks closed: no thickness is left, and they are stiffer from the start.
    const auto openings = by_opening(recipe, bench, study, {0.0}, keep);
    ASSERT_EQ(openings.size(), 1U);
    EXPECT_EQ(openings[0].numbers.at("T2.most"), 0.0);
    EXPECT_GT(openings[0].numbers.at("K.start"), 1.1 * first.numbers.at("K.start"));
    EXPECT_TRUE(openings[0].numbers.contains("UCS/UTS.30"));

    // The less bending counts, the stronger.
    const auto bending = by_bending_share(recipe, bench, study, {0.5}, keep);
    EXPECT_GT(bending.at(0).numbers.at("UTS.30"), 1.1 * first.numbers.at("UTS.30"));

    Reproduction result;
    result.settings.seeds = {1};
    result.seeds = {first.numbers};
    result.curves = {first.response};
    result.openings = openings;
    result.bending = bending;
    save(result, folder);
    for (const char* file : {"reproduction.md", "reproduction.json", "fig18_stress_strain.svg", "fig21_bulk.svg",
                             "fig23_stress.svg", "fig25_cycles.svg", "table4_strengths.svg", "openings_ratio.svg",
                             "bending_share.svg", "fig19_compression_y.png", "fig24_tension.png", "figures.json"})
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    EXPECT_EQ(summary(result)["numbers"]["UTS.30"]["by_seed"], Json::array({first.numbers.at("UTS.30")}));
    EXPECT_NE(page(result).find("pores and cracks"), std::string::npos);
    EXPECT_NE(page(result).find("times a factor"), std::string::npos);
    EXPECT_NE(page(result).find("| 0.5 |"), std::string::npos);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace craze::reproduce
