// The loading room from outside: hopeless specimens end with advice, and a stopped loading goes on to the same bits.

#include "craze/domain/room.hpp"
#include "support/command.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

namespace craze {
namespace {

namespace fs = std::filesystem;
using support::content_of;
using support::run_craze;

class LoadingCommand : public testing::Test {
protected:
    int edge = 6;  ///< elements along each edge of a cube, 0.4 um apart

    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }

    /// Bonds to near neighbours along edges and some diagonals; those across the middle of x as `across` says.
    void write_cube(const std::string& across)
    {
        std::string elements = "x,y,z,r\n", bonds = "i,j,kind,T\n";
        const auto at = [this](int x, int y, int z) { return (x * edge + y) * edge + z; };
        constexpr int steps[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
        for (int x = 0; x < edge; ++x)
            for (int y = 0; y < edge; ++y)
                for (int z = 0; z < edge; ++z) {
                    elements += fmt::format("{},{},{},0.2\n", 0.2 + 0.4 * x, 0.2 + 0.4 * y, 0.2 + 0.4 * z);
                    for (const auto& s : steps) {
                        if (x + s[0] >= edge || y + s[1] >= edge || z + s[2] >= edge) continue;
                        const bool crosses = s[0] == 1 && x == edge / 2 - 1;
                        if (crosses && across.empty()) continue;
                        bonds += fmt::format("{},{},{}\n", at(x, y, z), at(x + s[0], y + s[1], z + s[2]),
                                             crosses ? across : "beam,0");
                    }
                }
        write("elements.csv", elements), write("bonds.csv", bonds);
    }
    support::Ran load(const std::string& more, const std::string& box = "2.4 2.4 2.4")
    {
        return run_craze(fmt::format(
            "domain --import {0}/elements.csv {0}/bonds.csv --unit um --box {1} --set loading.beam.calibrate=false "
            "--set loading.uniaxial.run=false --set loading.triaxial.run=false '--set=loading.specimens=[\"cracks\"]' "
            "{2} --out {0}/out",
            folder.string(), box, more));
    }
    void expect_ends(const support::Ran& ran, int code, const std::string& advice)
    {
        EXPECT_EQ(ran.code, code) << ran.out;
        EXPECT_NE(ran.out.find(advice), std::string::npos) << ran.out;
    }
    fs::path folder = fs::temp_directory_path() / fmt::format("craze_loading_command_{}", ::getpid());
};

TEST_F(LoadingCommand, OfNothingConnectedIsRefused)
{
    write_cube("beam,0");
    write("bonds.csv", "i,j\n");
    expect_ends(load(""), 2, "nothing is connected");
}

TEST_F(LoadingCommand, OfAFloatingSpecimenSaysWhichWallItMisses)
{
    write_cube("beam,0");
    expect_ends(load("", "9 9 9"), 1, "Does the matter reach the wall of the box?");
}

/// Parts that nothing joins bear nothing, which is said: no number comes of them.
TEST_F(LoadingCommand, OfASpecimenCutThroughGivesAdvice)
{
    for (const int layers : {6, 7})
        for (const char* across : {"", "contact_beam,0.01"}) {
            edge = layers;
            write_cube(across);
            expect_ends(load("--set loading.moduli.axes=x", fmt::format("{0} {0} {0}", 0.4 * layers)), 1,
                        "cuts it through");
        }
}

TEST_F(LoadingCommand, BeyondReasonIsRefused)
{
    write_cube("beam,0");
    expect_ends(load("--set loading.moduli.strain=0.9"), 2, "loading.moduli.strain");
    expect_ends(load("--set loading.moduli.strain=nan"), 2, "loading.moduli.strain");
    write("elements.csv", "x,y,z,r\n0.2,0.2,0.2,0.2\n0.6,nan,0.2,0.2\n");
    write("bonds.csv", "i,j\n0,1\n");
    expect_ends(load(""), 2, "elements.csv, line 3");
}

TEST_F(LoadingCommand, StoppedInMotionGoesOnToTheSameBits)
{
    const domain::Domain packing = domain::pack(Vec3{3e-6, 2.6e-6, 2.6e-6}, 200e-9, {});
    domain::write_domain(packing, "csv", folder / "packing");
    const auto command = [&](const std::string& out) {
        return fmt::format(
            "domain --import {0}/packing/elements.csv {0}/packing/bonds.csv --box \"3 um\" \"2.6 um\" \"2.6 um\" "
            "--set loading.beam.calibrate=false --set loading.moduli.run=false --set loading.uniaxial.run=false "
            "--set loading.triaxial.run=false --set loading.fracture.run=true --set loading.fracture.compression=0 "
            "--set loading.fracture.points=40 --set loading.fracture.crossings=4000 "
            "--set loading.output.checkpoint=0.01s --set=loading.specimens=[\\\"dense\\\"] "
            "--set=loading.fracture.specimens=[\\\"dense\\\"] --out {0}/{1}",
            folder.string(), out);
    };
    ASSERT_EQ(run_craze(command("straight")).code, 0);

    const std::string partial = (folder / "stopped/loading/partial").string();
    write("stop.sh", std::string(CRAZE_APP) + " " + command("stopped") +
                         " & child=$!; while kill -0 $child 2>/dev/null && ! ls " + partial +
                         "/*.restart >/dev/null 2>&1; do sleep 0.01; done; kill -INT $child; wait $child; exit $?\n");
    const int status = std::system(("sh " + (folder / "stop.sh").string() + " >/dev/null 2>&1").c_str());
    ASSERT_TRUE(WIFEXITED(status));
    ASSERT_EQ(WEXITSTATUS(status), 130);
    ASSERT_FALSE(fs::is_empty(partial));
    ASSERT_EQ(run_craze(command("stopped")).code, 0);
    int curves = 0;
    for (const auto& file : fs::directory_iterator(folder / "straight/loading/curves")) {
        const auto twin = folder / "stopped/loading/curves" / file.path().filename();
        EXPECT_EQ(content_of(file.path()), content_of(twin)) << file.path();
        ++curves;
    }
    EXPECT_GE(curves, 2);
}

}  // namespace
}  // namespace craze
