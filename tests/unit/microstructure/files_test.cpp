#include "craze/microstructure/analysis.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/microstructure/figures.hpp"
#include "support/random_masks.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <tuple>

namespace craze::microstructure {
namespace {

struct MicrostructureFiles : testing::Test {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("craze_microstructure_" + std::to_string(getpid()));
    Settings settings;
    Microstructure micro;

    void SetUp() override
    {
        const Mask matter = complement(support::random_balls({47, 33, 29}, 25, 7.0, 5));
        images::Gray gray{Volume<std::uint8_t>(matter.shape()), 23.6e-9};
        Random random(1);
        for (std::int64_t z = 0; z < 29; ++z)
            for (std::int64_t y = 0; y < 33; ++y)
                for (std::int64_t x = 0; x < 47; ++x)
                    gray.level(x, y, z) = static_cast<std::uint8_t>((matter(x, y, z) ? 150 : 40) + random.below(20));
        io::write_volume(folder / "images" / "gray.mhd", gray.level, gray.voxel_size);
        settings.R_C = 4.5, settings.R_E = 2.5;
        micro = classify(std::move(gray), settings);
        save(micro, folder / "microstructure");
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
};

TEST_F(MicrostructureFiles, ReadBackAreTheSame)
{
    const Microstructure again = load_microstructure(folder / "microstructure", folder / "images");
    EXPECT_EQ(again.threshold, micro.threshold);
    EXPECT_EQ(again.matter, micro.matter);
    EXPECT_EQ(again.pore, micro.pore);
    EXPECT_EQ(again.crack, micro.crack);
    EXPECT_DOUBLE_EQ(again.gray.voxel_size, 23.6e-9);
    EXPECT_TRUE(std::equal(again.gray.level.values().begin(), again.gray.level.values().end(),
                           micro.gray.level.values().begin()));
}

TEST_F(MicrostructureFiles, ThatDoNotFitAreRefused)
{
    io::write_volume(folder / "images" / "gray.mhd", Volume<std::uint8_t>({9, 8, 7}, 3), 1e-6);
    EXPECT_THROW(load_microstructure(folder / "microstructure", folder / "images"), InvalidInput);
    std::filesystem::remove(folder / "images" / "gray.mhd");
    EXPECT_THROW(load_microstructure(folder / "microstructure", folder / "images"), InvalidInput);
    io::write_volume(folder / "images" / "gray.mhd", micro.gray.level, 1e-6);
    io::write_text(folder / "microstructure" / "threshold.json", "{}");
    EXPECT_THROW(load_microstructure(folder / "microstructure", folder / "images"), InvalidInput);
    io::write_volume(folder / "microstructure" / "phase.mhd", micro.gray.level, 1e-6);
    EXPECT_THROW(load_microstructure(folder / "microstructure", folder / "images"), InvalidInput);
}

TEST_F(MicrostructureFiles, IntermediatesAreTheClosedAndTheEnlargedPores)
{
    save_intermediates(micro, settings, folder);
    const auto closed = io::read_volume<std::uint8_t>(folder / "closed.mhd");
    const auto enlarged = io::read_volume<std::uint8_t>(folder / "enlarged.mhd");
    std::int64_t pores = 0;
    for (std::int64_t z = 0; z < 29; ++z)
        for (std::int64_t y = 0; y < 33; ++y)
            for (std::int64_t x = 0; x < 47; ++x) {
                EXPECT_GE(closed(x, y, z), enlarged(x, y, z));
                const bool pore = enlarged(x, y, z) == 0 && !micro.matter(x, y, z);
                ASSERT_EQ(pore, micro.pore(x, y, z));
                pores += closed(x, y, z) == 0 ? 1 : 0;
            }
    EXPECT_GT(pores, 0);
}

TEST_F(MicrostructureFiles, LabelsAreThoseOfTheTables)
{
    const Analysis analysis = analyse(micro, settings);
    save_intermediates(micro, settings, folder);
    for (const auto& [file, mask, objects] : {std::tuple{"pore_labels.mhd", &micro.pore, &analysis.pores},
                                              {"crack_labels.mhd", &micro.crack, &analysis.cracks}}) {
        const auto label = io::read_volume<std::uint16_t>(folder / file);
        std::vector<std::int64_t> voxels(objects->size() + 1, 0);
        for (std::int64_t z = 0; z < 29; ++z)
            for (std::int64_t y = 0; y < 33; ++y)
                for (std::int64_t x = 0; x < 47; ++x) {
                    ASSERT_EQ(label(x, y, z) != 0, (*mask)(x, y, z));
                    ASSERT_LE(label(x, y, z), objects->size());
                    ++voxels[label(x, y, z)];
                }
        for (std::size_t k = 0; k < objects->size(); ++k) EXPECT_EQ(voxels[k + 1], (*objects)[k].volume) << file << k;
    }
}

TEST_F(MicrostructureFiles, TheSummaryAddsUp)
{
    const Analysis analysis = analyse(micro, settings);
    const Json json = summary(micro, analysis);
    EXPECT_EQ(json["threshold"]["used"], micro.threshold);
    EXPECT_EQ(json["threshold"]["used"], json["threshold"]["moments"]);
    EXPECT_DOUBLE_EQ(json["porosity"]["total"].get<double>(), porosity(complement(micro.matter)));
    std::int64_t pores = 0, cracks = 0;
    for (const Object& o : analysis.pores) pores += o.volume;
    for (const Object& o : analysis.cracks) cracks += o.volume;
    EXPECT_EQ(pores, micro.pore.count());
    EXPECT_EQ(cracks, micro.crack.count());
    save(analysis, micro, folder / "microstructure");
    const std::string csv = io::read_text(folder / "microstructure" / "pores.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(analysis.pores.size()) + 1);
    for (const char* name :
         {"histogram", "porosity_x", "porosity_y", "porosity_z", "porosity_scatter", "cracks", "thickness"})
        EXPECT_TRUE(std::filesystem::exists(folder / "microstructure" / (std::string(name) + ".csv"))) << name;
}

TEST_F(MicrostructureFiles, ThePoreTableHasAllThatIsMeasured)
{
    const Analysis analysis = analyse(micro, settings);
    save(analysis, micro, folder / "microstructure");
    const std::string csv = io::read_text(folder / "microstructure" / "pores.csv");
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "label,volume_px3,surface_px2,equivalent_radius_px,inscribed_radius_px,mean_thickness_px,sphericity,"
              "centroid_x_px,centroid_y_px,centroid_z_px,semi_axis_a_px,semi_axis_b_px,semi_axis_c_px,major_x,major_y,"
              "major_z,minor_x,minor_y,minor_z,at_border");
    for (std::size_t at = 0; at < csv.size(); at = csv.find('\n', at) + 1)
        ASSERT_EQ(std::count(csv.begin() + static_cast<std::ptrdiff_t>(at),
                             csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n', at)), ','),
                  19);
    for (const Object& o : analysis.pores) {
        EXPECT_GE(o.mean_thickness, 1.0);
        EXPECT_LE(o.mean_thickness, 2 * o.inscribed_radius);
    }
}

TEST_F(MicrostructureFiles, TablesAreTheSameOnAnyNumberOfThreads)
{
    const std::vector<const char*> names{"histogram", "porosity_x",       "porosity_y", "porosity_z",
                                         "pores",     "porosity_scatter", "cracks",     "thickness"};
    for (const int threads : {1, 2}) {
        set_threads(threads);
        save(analyse(micro, settings), micro, folder / std::to_string(threads));
    }
    set_threads(0);
    for (const char* name : names)
        EXPECT_EQ(io::read_text(folder / "1" / (std::string(name) + ".csv")),
                  io::read_text(folder / "2" / (std::string(name) + ".csv")))
            << name;
}

}  // namespace
}  // namespace craze::microstructure
