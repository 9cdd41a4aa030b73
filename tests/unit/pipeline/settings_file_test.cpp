#include "craze/pipeline/settings_file.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace craze::pipeline {

struct Lens {
    double radius = 1e-6;
    std::int64_t count = 3;
};

inline void describe(Schema& schema, Lens& lens)
{
    schema.quantity("radius", lens.radius, Dimension::length, {1e-9, 1e-3}, "radius of the disc");
    schema.integer("count", lens.count, {0, 100}, "how many");
}

namespace {

enum class Method { moments, otsu, entropy };

struct Everything {
    double voxel_size = 23.6e-9, share = 0.25, plain = 2.0;
    std::optional<double> sigma;
    std::vector<double> thicknesses{2e-9, 40e-9};
    std::vector<std::int64_t> slices{1, 2};
    std::int64_t search = 21;
    bool enabled = true;
    std::string title = "a \"coating\"", source = "stack.tif";
    std::vector<std::string> words{"both", "dense"};
    Method method = Method::moments;
    std::vector<Lens> lenses{Lens{2e-6, 5}};

    Describe describe()
    {
        return [this](Schema& schema) {
            schema.group("images", "what the microscope saw", [&] {
                schema.quantity("voxel_size", voxel_size, Dimension::length, {1e-10, 1e-2}, "edge of a voxel");
                schema.quantity("share", share, Dimension::fraction, {0, 1}, "a share");
                schema.number("plain", plain, {-1e3, 1e3}, "a number");
                schema.path("source", source, "the stack");
                schema.group("denoise", "non-local means", [&] {
                    schema.integer("search", search, {3, 63}, "search window");
                    schema.quantity("sigma", sigma, Dimension::pure, {0, 255}, "noise; auto measures it");
                    schema.flag("enabled", enabled, "on or off");
                    schema.option("method", method, {"moments", "otsu", "entropy"}, "how");
                });
            });
            schema.quantities("thicknesses", thicknesses, Dimension::length, {0, 1e-6}, "thicknesses");
            schema.integers("slices", slices, {0, 1e6}, "slices");
            schema.text("title", title, "title");
            schema.texts("words", words, "words");
            schema.items("lens", lenses, "a population of cracks");
        };
    }
};

std::string error_of(const std::string& toml, const std::vector<std::string>& overrides = {})
{
    Everything s;
    try {
        read_settings_text(toml, "a/file.toml", overrides, s.describe());
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

TEST(SettingsFile, WrittenAndReadAgainIsTheSame)
{
    Everything s;
    s.voxel_size = 1.0 / 3.0;
    s.voxel_size = 1e-9 / 3.0;
    s.sigma = 12.5;
    s.lenses = {Lens{1e-7, 1}, Lens{3e-7, 2}};
    const std::string text = write_settings(s.describe());
    Everything t;
    read_settings_text(text, "file.toml", {}, t.describe());
    t.source = s.source;
    EXPECT_EQ(settings_json(s.describe()), settings_json(t.describe()));
}

TEST(SettingsFile, DefaultsStandWhereNothingIsSaid)
{
    Everything s, t;
    read_settings_text("", "file.toml", {}, t.describe());
    EXPECT_EQ(settings_json(s.describe()), settings_json(t.describe()));
}

TEST(SettingsFile, RefusalsNameFileLineKeyNeedAndNearestName)
{
    const std::string unknown = error_of("[images]\nvoxel_size = \"20 nm\"\nvoxelsize = \"20 nm\"\n");
    EXPECT_EQ(unknown, "a/file.toml:3: images.voxelsize: unknown key; did you mean \"voxel_size\"?");
    EXPECT_EQ(error_of("[image]\n"), "a/file.toml:1: image: unknown key; did you mean \"images\"?");
    EXPECT_NE(
        error_of("[images]\nvoxel_size = 20\n").find("a/file.toml:2: images.voxel_size: needs a number with its unit"),
        std::string::npos);
    EXPECT_NE(error_of("[images]\nvoxel_size = \"20 mn\"\n").find("unknown unit \"mn\""), std::string::npos);
    EXPECT_NE(error_of("[images]\nvoxel_size = \"2 m\"\n").find("needs a value from 0.1 nm to 10 mm, got \"2 m\""),
              std::string::npos);
    EXPECT_NE(error_of("[images]\nplain = nan\n").find("needs a value from"), std::string::npos);
    EXPECT_NE(error_of("[images.denoise]\nsearch = 2\n").find("from 3 to 63, got 2"), std::string::npos);
    EXPECT_NE(error_of("[images.denoise]\nsearch = 21.0\n").find("needs a whole number"), std::string::npos);
    EXPECT_NE(error_of("[images.denoise]\nmethod = \"moment\"\n").find("did you mean \"moments\"?"), std::string::npos);
    EXPECT_NE(
        error_of("[[lens]]\nradius = \"1 um\"\n[[lens]]\nradios = \"1 um\"\n").find("a/file.toml:4: lens[2].radios"),
        std::string::npos);
    EXPECT_NE(error_of("images = 3\n").find("needs a section"), std::string::npos);
    EXPECT_NE(error_of("lens = 3\n").find("needs a list of sections"), std::string::npos);
    EXPECT_NE(error_of("[images\n").find("a/file.toml:1: not valid TOML"), std::string::npos);
}

TEST(SettingsFile, OneValueIsAListOfOne)
{
    Everything s;
    read_settings_text("slices = 7\nthicknesses = \"3 nm\"\n", "f.toml", {}, s.describe());
    EXPECT_EQ(s.slices, (std::vector<std::int64_t>{7}));
    EXPECT_EQ(s.thicknesses, (std::vector<double>{3e-9}));
}

TEST(SettingsFile, AllWrongLinesAreToldAtOnce)
{
    const std::string both = error_of("slics = [1]\n[images]\nplain = 1e9\n");
    EXPECT_NE(both.find("file.toml:1: slics"), std::string::npos) << both;
    EXPECT_NE(both.find("file.toml:3: images.plain"), std::string::npos) << both;
}

TEST(SettingsFile, OverridesLieOverTheFileAndNameThemselves)
{
    Everything s;
    read_settings_text("[images.denoise]\nsearch = 15\n", "f.toml",
                       {"images.denoise.search=17", "images.voxel_size=20 nm", "images.source=here.tif", "slices=[4,5]",
                        "images.denoise.sigma=auto"},
                       s.describe());
    EXPECT_EQ(s.search, 17);
    EXPECT_EQ(s.voxel_size, 20e-9);
    EXPECT_EQ(s.source, "here.tif");
    EXPECT_EQ(s.slices, (std::vector<std::int64_t>{4, 5}));
    EXPECT_FALSE(s.sigma.has_value());
    EXPECT_EQ(error_of("", {"images.denoise.serach=15"}),
              "--set images.denoise.serach: unknown key; did you mean \"search\"?");
    EXPECT_NE(error_of("", {"nothing"}).find("needs KEY=VALUE"), std::string::npos);
}

TEST(SettingsFile, PathsAreTakenFromTheFileAndStayOutOfContentHashes)
{
    Everything s;
    read_settings_text("[images]\nsource = \"../data/x.tif\"\n", "a/b/file.toml", {}, s.describe());
    EXPECT_EQ(s.source, "a/data/x.tif");
    EXPECT_FALSE(settings_json(s.describe(), false)["images"].contains("source"));
}

TEST(SettingsFile, TheManualShowsEveryKey)
{
    Everything s;
    s.lenses.clear();
    const std::string manual = settings_manual(s.describe());
    for (const char* key :
         {"`voxel_size`", "`search`", "`[[lens]]`", "`radius`", "0.1 nm ... 10 mm", "moments, otsu, entropy"})
        EXPECT_NE(manual.find(key), std::string::npos) << key << "\n" << manual;
}

TEST(SettingsFile, AMissingFileIsRefused)
{
    Everything s;
    EXPECT_THROW(read_settings({"no/such/file.toml", {}}, s.describe()), InvalidInput);
}

}  // namespace
}  // namespace craze::pipeline
