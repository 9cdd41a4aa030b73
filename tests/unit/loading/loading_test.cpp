#include "craze/loading/loading.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/calibration.hpp"
#include "craze/loading/response_json.hpp"
#include "craze/loading/rig.hpp"
#include "craze/loading/specimen.hpp"
#include "support/cracked.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace craze::loading {
namespace {

const domain::Domain& packing()
{
    static const domain::Domain once = support::small_packing(700, 7);
    return once;
}

domain::Discretisation cracked(double aperture)
{
    const Vec3 box = packing().box;
    auto pennies = support::random_pennies(box, 0.8e-6, 0.25, aperture, 3);
    for (std::size_t k = 0; k < pennies.size(); ++k) pennies[k].aperture *= static_cast<double>(k % 3);  // some closed
    return support::with_pennies(packing(), pennies, {{0.5 * box, 0.6e-6}});
}

Settings quick()
{
    Settings s;
    s.uniaxial.points = 3;
    s.uniaxial.axes = "z";
    s.triaxial.points = 6;
    s.beam.tolerance = 1e-3;
    return s;
}

TEST(Rig, AffineDisplacementIsMeasuredAsItsStrain)
{
    const Rig rig(packing(), {}, {}, {});
    const Vec3 strain{1e-3, -2e-4, 5e-4};
    const auto d = rig.gauge().measure(mechanics::affine_state(rig.lattice(), strain));
    EXPECT_GT(rig.gauge().interior_elements(), 20);
    for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(d.face[a], strain[a], 1e-12);
        EXPECT_NEAR(d.interior[a], strain[a], 1e-12);
        EXPECT_LT(std::abs(d.box[a]), std::abs(strain[a]));  // centres lie a radius inside the walls
        EXPECT_GT(std::abs(d.box[a]), 0.8 * std::abs(strain[a]));
    }
}

TEST(Rig, OppositeSidesBearTheSameForce)
{
    Rig rig(packing(), {}, {}, {.residual = 1e-9, .curve_residual = 1e-9});
    Loading loading;
    loading.drive[2] = {false, 1.0};
    loading.path = {1e-3};
    const Curve curve = rig.rest(loading);
    ASSERT_EQ(curve.points.size(), 2U);
    EXPECT_LT(curve.points[1].imbalance, 1e-6);
    EXPECT_EQ(curve.points[1].stress.x, 0.0);
    EXPECT_GT(curve.points[1].stress.z, 0.0);
    EXPECT_LT(curve.points[1].strain.x, 0.0);
}

TEST(Rig, WorkOfTheSidesIsStoredInTheBeams)
{
    Rig rig(packing(), {}, {}, {.residual = 1e-9, .curve_residual = 1e-9});
    Loading loading;
    loading.drive[0] = {false, 1.0}, loading.drive[1] = {false, -0.5};
    loading.axis = 0;
    loading.path = {5e-4, 1e-3, 0.0, -1e-3};
    const Curve curve = rig.rest(loading);
    for (std::size_t k = 1; k < curve.points.size(); ++k)
        EXPECT_NEAR(curve.points[k].work, curve.points[k].elastic,
                    2e-3 * curve.points[1].elastic + 1e-3 * curve.points[k].elastic);
}

TEST(Triaxial, BulkModulusOfALinearAndOfAParabolicCurve)
{
    std::vector<Point> points(5);
    for (std::size_t k = 0; k < 5; ++k) {
        const double eta = 0.001 * static_cast<double>(k * k + k);  // uneven on purpose
        points[k].eta = eta;
        points[k].pressure = 50e9 * eta + 400e9 * eta * eta;
    }
    fill_bulk_modulus(points);
    for (const auto& p : points)
        EXPECT_NEAR(p.bulk, (1.0 + p.eta) * (50e9 + 800e9 * p.eta), 1e-9 * p.bulk);  // [Eq. 22]
}

TEST(Calibration, MeetsItsTargetAndScalesWithIt)
{
    const mechanics::DenseMaterial target{100e9, 0.25, 3000.0};
    CalibrationOptions options;
    const Calibration c = calibrate(packing(), target, options);
    EXPECT_LE(c.error, 1e-3);
    EXPECT_LE(c.path.size(), 8U);
    // The beams found give E and nu in a loading of their own.
    const Calibration again = measure_given(packing(), target, c.beam, options);
    EXPECT_NEAR(again.E / 100e9, 1.0, 1e-3);
    EXPECT_NEAR(again.nu / 0.25, 1.0, 1e-3);
    // E is proportional to E_B.
    mechanics::BeamMaterial twice = c.beam;
    twice.E_B *= 2.0;
    EXPECT_NEAR(measure_given(packing(), target, twice, options).E / again.E, 2.0, 1e-5);
}

TEST(Calibration, OfAnImpossibleRatioSaysWhatThereIs)
{
    try {
        calibrate(packing(), {223e9, 0.449, 6060.0}, {});
        FAIL();
    } catch (const ComputationFailed& error) {
        EXPECT_NE(std::string(error.what()).find("nu_D"), std::string::npos) << error.what();
    }
}

TEST(Load, GivesTheTableOfModuliAndTheCurves)
{
    const Response r = load(cracked(4e-9), quick());
    ASSERT_EQ(r.moduli.size(), 12U);
    const auto E = [&](const std::string& specimen, int axis) {
        for (const auto& m : r.moduli)
            if (m.specimen == specimen && m.axis == axis) return m.tension;
        return 0.0;
    };
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(E("pores", axis), E("dense", axis));
        EXPECT_LT(E("cracks", axis), E("dense", axis));
        EXPECT_LT(E("both", axis), E("cracks", axis));
        EXPECT_GT(E("both", axis), 0.1 * E("dense", axis));
    }
    EXPECT_NEAR((E("dense", 0) + E("dense", 1) + E("dense", 2)) / 3.0, 223e9, 0.002 * 223e9);
    const Json s = summary(r);
    EXPECT_EQ(s["moduli"]["both"]["tension_Pa"]["z"].get<double>(), E("both", 2));
    EXPECT_GT(s["triaxial"]["both"]["K_last_Pa"].get<double>(), s["triaxial"]["both"]["K_first_Pa"].get<double>());
    EXPECT_GT(s["triaxial"]["both"]["closure_last"].get<double>(), 0.2);
}

TEST(Load, SavedAndLoadedIsTheSame)
{
    Settings s = quick();
    s.moduli.specimens = {"both"};
    s.uniaxial.run = false;
    s.triaxial.specimens = {"cracks closed"};
    const Response r = load(cracked(4e-9), s);
    const auto folder = std::filesystem::temp_directory_path() / "craze_loading_round_trip";
    std::filesystem::remove_all(folder);
    save(r, folder);
    const Response again = load_response(folder);
    EXPECT_EQ(as_json(again), as_json(r));
    EXPECT_TRUE(std::filesystem::exists(folder / "curves" / "cracks_closed_triaxial.csv"));
    std::filesystem::remove_all(folder);
    EXPECT_THROW(load_response(folder), InvalidInput);
}

TEST(Load, GivesTheSameBitsOnAnyNumberOfThreads)
{
    Settings s = quick();
    s.moduli.specimens = {"both"};
    s.moduli.axes = "x";
    s.uniaxial.run = false;
    const auto with = [&](int count) {
        set_threads(count);
        Response r = load(cracked(4e-9), s);
        r.seconds = 0.0;
        for (auto& c : r.curves) c.seconds = 0.0;
        return as_json(r).dump();
    };
    const std::string one = with(1), two = with(2);
    set_threads(0);
    EXPECT_EQ(one, two);
}

TEST(Library, KeepsACalibrationForTheSameRecipeOnly)
{
    const auto file = std::filesystem::temp_directory_path() / "craze_materials_test.json";
    std::filesystem::remove(file);
    Settings s = quick();
    s.moduli.run = s.uniaxial.run = s.triaxial.run = false;
    s.beam.library = file.string();
    const auto first = load(cracked(4e-9), s).calibration, second = load(cracked(1e-9), s).calibration;
    EXPECT_FALSE(first.from_library);
    EXPECT_TRUE(second.from_library);
    EXPECT_EQ(first.beam.E_B, second.beam.E_B);
    EXPECT_EQ(first.beam.r_tilde, second.beam.r_tilde);
    s.dense.E_D = 200e9;
    EXPECT_FALSE(load(cracked(4e-9), s).calibration.from_library);
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace craze::loading
