#include "craze/mesh/mesh.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "support/masks.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::mesh {
namespace {

namespace fs = std::filesystem;

class Mesh : public testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
};

// A wall 3 px thick, perpendicular to x, in a box of 20 px.
Mask wall()
{
    return support::mask_of(Shape{20, 20, 20}, [](auto x, auto, auto) { return x >= 8 && x <= 10; });
}

TEST_F(Mesh, OfAWallIsItsMiddlePlaneInMetres)
{
    const double h = 23.6e-9;
    const CrackSurface surface = mesh_cracks(wall(), h, {});
    ASSERT_FALSE(surface.triangles.empty());
    for (const Vec3& v : surface.vertices) EXPECT_NEAR(v.x, 9.5 * h, 1e-20);
    const Json json = summary(surface, measure(surface, wall(), h));
    EXPECT_NEAR(json["opening_m"]["mean"].get<double>(), 3 * h, 1e-6 * h);
    EXPECT_TRUE(json["quality"]["manifold"].get<bool>());
    // Centres leave half a pixel on each side, and thinning takes at most the thickness from the ends of a line.
    EXPECT_GE(json["area_m2"].get<double>() / (h * h), 19.0 * 16.0 - 1e-9);
    EXPECT_LE(json["area_m2"].get<double>() / (h * h), 19.0 * 19.0 + 1e-9);
}

TEST_F(Mesh, SavedAndLoadedIsTheSame)
{
    const CrackSurface surface = mesh_cracks(support::random_mask(Shape{20, 20, 20}, 0.2, 1), 1e-6, {});
    const fs::path folder = fs::temp_directory_path() / "craze_mesh_test";
    save(surface, folder);
    const CrackSurface again = load_surface(folder);
    EXPECT_EQ(surface.vertices, again.vertices);
    EXPECT_EQ(surface.triangles, again.triangles);
    EXPECT_EQ(surface.sides, again.sides);
    fs::remove_all(folder);
    EXPECT_THROW(load_surface(folder), InvalidInput);
}

TEST_F(Mesh, OfNoCracksIsEmptyAndCanBeSaved)
{
    const CrackSurface surface = mesh_cracks(Mask(Shape{6, 6, 6}), 1e-6, {});
    EXPECT_TRUE(surface.triangles.empty());
    const fs::path folder = fs::temp_directory_path() / "craze_mesh_test_empty";
    save(surface, folder);
    EXPECT_TRUE(load_surface(folder).triangles.empty());
    const CrackMeasures measures = measure(surface, Mask(Shape{6, 6, 6}), 1e-6);
    save(surface, measures, {}, folder);
    EXPECT_EQ(summary(surface, measures)["area_m2"].get<double>(), 0.0);
    EXPECT_EQ(summary(surface, measures)["cracks"].get<int>(), 0);
    fs::remove_all(folder);
}

TEST_F(Mesh, RefusesWrongSettingsByName)
{
    Settings settings;
    for (const double alpha : {0.0, -1.0, 100.0, std::nan("")}) {
        settings.alpha = alpha;
        try {
            check(settings);
            FAIL() << alpha;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find("mesh.alpha"), std::string::npos);
        }
    }
    EXPECT_THROW(mesh_cracks(wall(), 0.0, {}), InvalidInput);
    EXPECT_THROW(mesh_cracks(wall(), std::nan(""), {}), InvalidInput);
}

}  // namespace
}  // namespace craze::mesh
