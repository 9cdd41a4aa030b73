#include "craze/mesh/mesh.hpp"
#include "craze/reproduce/candidate.hpp"
#include "craze/synth/short_way.hpp"

#include <gtest/gtest.h>

namespace craze::reproduce {
namespace {

/// The first reading of a coating: photographed without noise, told apart, meshed, and put into the bench's packing.
domain::Discretisation by_images(synth::Settings recipe, const Bench& bench, const Study& study)
{
    auto& m = recipe.microscope;
    m.noise = m.stripes = m.shading_x = m.shading_y = m.shading_z = m.drift = m.thickness_jitter = 0.0;
    const auto micro = microstructure::classify(synth::observe(synth::make_coating(recipe), recipe).stack, {});
    mesh::Settings sheets;  // slice by slice, cracks that lie in the slices would be lost
    sheets.skeleton = mesh::SkeletonKind::medial_surface;
    const auto sheet = mesh::mesh_cracks(micro.crack, recipe.voxel_size, sheets);
    domain::Settings cutting = study.domain;
    cutting.r_tilde = bench.calibration.beam.r_tilde;
    return domain::discretise(bench.dense, micro, sheet, cutting);
}

TEST(TwoWays, GiveTheSameModuliForTheSameDefects)
{
    synth::Settings recipe;
    recipe.shape = {276, 276, 276};
    Study study;
    study.triaxial_points = 0;
    const Bench bench = make_bench(synth::box_of(recipe), study, 1, false);
    const Candidate short_way = measure(recipe, bench, study);
    const auto seen = by_images(recipe, bench, study);
    const auto numbers = numbers_of(seen, loading::load(seen, laboratory(study, bench.calibration)), study);
    for (const char* specimen : {"pores", "cracks", "both"})
        for (const char axis : {'x', 'y', 'z'}) {
            const auto key = std::string("E.") + specimen + "." + axis;
            EXPECT_NEAR(numbers.at(key) / short_way.numbers.at(key), 1.0, 0.05) << key;
            RecordProperty(key, std::to_string(numbers.at(key) / short_way.numbers.at(key)));
        }
    EXPECT_NEAR(numbers.at("T2.median") / short_way.numbers.at("T2.median"), 1.0, 0.10);
}

}  // namespace
}  // namespace craze::reproduce
