#include "craze/core/errors.hpp"
#include "craze/io/vtu_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>

namespace craze::io {
namespace {

namespace fs = std::filesystem;

class VtuPointsTest : public testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }

    fs::path written() const
    {
        const std::vector<double> points{0, 1, 2, 3, 4, 5};
        const std::vector<std::int32_t> lines{0, 1};
        const std::vector<float> radius{0.5F, 0.25F}, displacement{1, 2, 3, 4, 5, 6}, thickness{9};
        VtuGrid grid{points, lines, {}, {}};
        grid.on_points = {{"radius", 1, std::span<const float>(radius)},
                          {"displacement", 3, std::span<const float>(displacement)}};
        grid.on_lines = {{"thickness", 1, std::span<const float>(thickness)}};
        write_vtu(folder / "state.vtu", grid);
        return folder / "state.vtu";
    }

    fs::path folder = fs::temp_directory_path() / ("craze_vtu_" + std::to_string(getpid()));
};

TEST_F(VtuPointsTest, ComeBackAsTheyWereWritten)
{
    const auto seen = read_vtu_points(written());
    EXPECT_EQ(seen.points, (std::vector<double>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(seen.radius, (std::vector<float>{0.5F, 0.25F}));
    EXPECT_EQ(seen.displacement, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST_F(VtuPointsTest, OfAMissingOrDamagedFileAreRefused)
{
    EXPECT_THROW(read_vtu_points(folder / "none.vtu"), InvalidInput);
    const fs::path file = written();
    // The header alone; then cuts through the arrays that are read.
    for (const double share : {0.3, 0.6, 0.75}) {
        written();
        fs::resize_file(file, static_cast<std::uintmax_t>(share * static_cast<double>(fs::file_size(file))));
        EXPECT_THROW(read_vtu_points(file), InvalidInput) << share;
    }
    std::ofstream(file) << "<VTKFile><AppendedData encoding=\"raw\">\n_";
    EXPECT_THROW(read_vtu_points(file), InvalidInput);
}

}  // namespace
}  // namespace craze::io
