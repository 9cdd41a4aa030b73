#include "craze/core/json.hpp"
#include "craze/domain/room.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/loading/calibration.hpp"
#include "support/command.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <regex>
#include <sstream>

namespace craze {
namespace {

namespace fs = std::filesystem;
using support::content_of;
using support::run_craze;

// A coating of a few seconds: every room works, none is a formality.
constexpr const char* small_settings = R"(
[synth]
shape = [96, 96, 96]
voxel_size = "47.2 nm"

[images.denoise]
search = 7

[microstructure]
R_C = "4.5 px"
R_E = "2.5 px"

[loading]
specimens = ["dense", "both"]

[loading.uniaxial]
points = 3

[loading.triaxial]
points = 4
)";

class CommandLine : public testing::Test {
protected:
    void SetUp() override
    {
        fs::create_directories(folder);
        write("small.toml", small_settings);
    }
    void TearDown() override { fs::remove_all(folder); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
    std::string path(const std::string& name) const { return (folder / name).string(); }

    void expect_refused(const std::string& arguments, const std::string& needle)
    {
        const auto ran = run_craze(arguments + " --out " + path("out"));
        EXPECT_EQ(ran.code, 2) << arguments << "\n" << ran.out;
        EXPECT_NE(ran.out.find(needle), std::string::npos) << ran.out;
        EXPECT_FALSE(fs::exists(path("out"))) << "work had started: " << arguments;
    }

    fs::path folder = fs::temp_directory_path() / ("craze_command_line_" + std::to_string(getpid()));
};

TEST_F(CommandLine, RefusesWrongInputBeforeAnyWorkStarts)
{
    write("key.toml", "[images]\nvoxelsize = \"20 nm\"\n");
    expect_refused("run " + path("key.toml"),
                   "key.toml:2: images.voxelsize: unknown key; did you mean \"voxel_size\"?");
    write("unit.toml", "[images]\nvoxel_size = \"20 mn\"\n");
    expect_refused("run " + path("unit.toml"), "unknown unit \"mn\"");
    write("range.toml", "[loading]\nrho_D = \"-5 kg/m3\"\n");
    expect_refused("run " + path("range.toml"), "range.toml:2");
    write("stack.toml", "[images]\nsource = \"nowhere.tif\"\n");
    expect_refused("run " + path("stack.toml"), "nowhere.tif");
    expect_refused("run " + path("none.toml"), "no such settings file");
    expect_refused("run " + path("small.toml") + " --set mesh.alpa=3",
                   "--set mesh.alpa: unknown key; did you mean \"alpha\"?");
    expect_refused("run", "SETTINGS is required");
    expect_refused("mesh " + path("small.toml"), "needs the results of microstructure");
    expect_refused("rum", "rum: no such verb; did you mean \"run\"?");
    expect_refused("analyse " + path("small.toml"), "analyse: no such verb; 'craze --help' lists them");
    write("recipe.toml", "[fit]\nparameters = [\"densty\"]\n");
    expect_refused("fit-coating " + path("recipe.toml"), "did you mean \"density\"?");
    expect_refused("reproduce --size big", "big not in");
    expect_refused("reproduce --set reproduce.sede=1", "did you mean \"seeds\"?");
    EXPECT_EQ(run_craze("--help").code, 0);
    EXPECT_EQ(run_craze("--version").code, 0);
}

TEST_F(CommandLine, InitWritesAFileThatIsReadBack)
{
    EXPECT_EQ(run_craze("init " + path("all.toml")).code, 0);
    EXPECT_EQ(run_craze("init " + path("all.toml")).code, 2) << "wrote over a file";
    // Every key is known and every default in range: the first thing missing is the room before.
    EXPECT_NE(run_craze("mesh " + path("all.toml") + " --out " + path("out")).out.find("needs the results of"),
              std::string::npos);
}

TEST_F(CommandLine, TheManualInTheDocsIsTheProgramsOwn)
{
    EXPECT_EQ(run_craze("settings").out, content_of(fs::path(CRAZE_SOURCE_DIR) / "docs" / "settings.md"))
        << "run: craze settings > docs/settings.md";
}

// What the README says of the demo, on a smaller coating with the demo's voxels and the microscope's default faults.
TEST_F(CommandLine, RecoversTheTruthOfASyntheticCoating)
{
    write("coating.toml", R"(
[synth]
shape = [144, 144, 144]
voxel_size = "35.4 nm"

[microstructure]
R_C = "5.65 px"
R_E = "3 px"
)");
    for (const char* room : {"synth ", "images ", "microstructure "}) {
        const auto ran = run_craze(room + path("coating.toml") + " --out " + path("out"));
        ASSERT_EQ(ran.code, 0) << ran.out;
    }
    const auto truth = io::read_volume<std::uint8_t>(folder / "out" / "synth" / "truth.mhd");
    const auto found = io::read_volume<std::uint8_t>(folder / "out" / "microstructure" / "phase.mhd");
    const auto crop = Json::parse(content_of(folder / "out" / "images" / "summary.json"))
                          .at("alignment")
                          .at("common_crop")
                          .get<std::vector<std::int64_t>>();
    constexpr std::uint8_t crack = 128, matter = 255;
    std::int64_t truly_void = 0, found_void = 0, both_void = 0, truly_crack = 0, crack_found = 0;
    for (std::int64_t z = 0; z < found.shape().nz; ++z)
        for (std::int64_t y = 0; y < found.shape().ny; ++y)
            for (std::int64_t x = 0; x < found.shape().nx; ++x) {
                const std::uint8_t t = truth(x + crop[0], y + crop[2], z), f = found(x, y, z);
                truly_void += t != matter, found_void += f != matter, both_void += t != matter && f != matter;
                truly_crack += t == crack, crack_found += t == crack && f != matter;
            }
    EXPECT_GE(2.0 * static_cast<double>(both_void), 0.97 * static_cast<double>(truly_void + found_void));
    EXPECT_GE(static_cast<double>(crack_found), 0.95 * static_cast<double>(truly_crack));
    EXPECT_GT(truly_crack, 10000);
}

// Times, memory, paths and the thread count differ between runs; all else must not.
std::string without_circumstances(const std::string& text)
{
    static const std::regex key(R"re("(peak_memory_bytes|[a-z_]*seconds|time|threads)")re");
    std::istringstream in(text);
    std::string kept;
    for (std::string line; std::getline(in, line);)
        if (line.size() > 1000 || !std::regex_search(line, key)) kept += line + "\n";
    return kept;
}

TEST_F(CommandLine, OneAndTwoThreadsGiveTheSameBitsInEveryRoom)
{
    ASSERT_EQ(run_craze("run " + path("small.toml") + " --threads 1 --out " + path("one")).code, 0);
    ASSERT_EQ(run_craze("run " + path("small.toml") + " --threads 2 --out " + path("two")).code, 0);
    int files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(path("one"))) {
        // The page shows times; its figures are files of their own and are compared.
        if (!entry.is_regular_file() || entry.path().filename() == "run.json" || entry.path().extension() == ".html")
            continue;
        const fs::path twin = path("two") / fs::relative(entry.path(), path("one"));
        std::string a = content_of(entry.path()), b = content_of(twin);
        if (entry.path().extension() == ".json") {
            a = without_circumstances(a);
            b = without_circumstances(b);
        }
        EXPECT_TRUE(a == b) << entry.path();
        ++files;
    }
    EXPECT_GT(files, 20);
}

TEST_F(CommandLine, APackingMadeElsewhereGoesThroughLoadingAndReport)
{
    const Vec3 box{4e-6, 3.6e-6, 3.8e-6};
    const domain::Domain packing = domain::pack(box, 200e-9, {});
    domain::write_domain(packing, "csv", folder / "packing");
    const std::string files = path("packing/elements.csv") + " " + path("packing/bonds.csv");
    const auto ran = run_craze(
        "domain --import " + files +
        " --box '4 um' '3.6 um' '3.8 um' --set loading.beam.calibrate=false --set loading.uniaxial.points=2 --set "
        "loading.triaxial.points=2 '--set=loading.specimens=[\"dense\"]' --out " +
        path("taken"));
    ASSERT_EQ(ran.code, 0) << ran.out;
    const Json taken = Json::parse(content_of(path("taken/domain/summary.json")));
    EXPECT_EQ(taken["elements"], packing.elements.size());
    EXPECT_EQ(taken["bonds"], packing.bonds.size());
    EXPECT_EQ(taken["p_DE"], 0.0);
    const Json loading = Json::parse(content_of(path("taken/loading/summary.json")));
    // The same packing loaded without files in between.
    const auto given = loading::measure_given(packing, {}, {}, {});
    const auto& modulus = loading["moduli"]["dense"]["tension_Pa"];
    EXPECT_NEAR(modulus["x"].get<double>() / given.path.back().E.x, 1.0, 1e-4);
    EXPECT_NEAR(modulus["z"].get<double>() / given.path.back().E.z, 1.0, 1e-4);
    EXPECT_TRUE(fs::exists(path("taken/report/index.html")));
    EXPECT_FALSE(fs::exists(path("taken/images")));

    // Plain numbers count the unit of the files.
    write("in_um.csv", "x,y,z,r\n1,1,1,1\n2.9,1,1,1\n");
    write("bonds.csv", "i,j\n0,1\n");
    const std::string um = "domain --import " + path("in_um.csv") + " " + path("bonds.csv") + " --unit um --box 4 2 ";
    EXPECT_NE(run_craze(um + "2000e-6 --out " + path("thin")).out.find("lies outside the box"), std::string::npos);
    EXPECT_NE(run_craze(um + "'2 kg' --out " + path("kg")).out.find("kg"), std::string::npos);
}

TEST_F(CommandLine, ABadPackingIsRefusedByFileAndLine)
{
    const auto expect = [&](const std::string& elements, const std::string& bonds, const std::string& needle) {
        write("e.csv", elements);
        write("b.csv", bonds);
        const auto ran = run_craze("domain --import " + path("e.csv") + " " + path("b.csv") +
                                   " --box '8 m' '2 m' '2 m' --out " + path("bad"));
        EXPECT_EQ(ran.code, 2) << ran.out;
        EXPECT_NE(ran.out.find(needle), std::string::npos) << ran.out;
    };
    const std::string two = "x,y,z,r\n1,1,1,1\n3,1,1,1\n";
    expect(two, "i,j\n0,1\n0,2\n", "b.csv, line 3");
    expect(two, "i,j\n1,1\n", "b.csv, line 2");
    expect(two, "i,j\n0,1\n1,0\n", "b.csv, line 3");
    expect("x,y,z,r\n1,1,1,1\n3,nan,1,1\n", "i,j\n0,1\n", "e.csv, line 3");
    expect("x,y,z,r\n1,1,1,1\n3,1,1,0\n", "i,j\n0,1\n", "e.csv, line 3");
    expect("x,y,z,r\n1,1,1,1\n1.2,1,1,1\n", "i,j\n0,1\n", "beyond reason");
    EXPECT_EQ(run_craze("domain").code, 2);
    EXPECT_EQ(run_craze("domain --box 1 1 1").code, 2);
    EXPECT_NE(run_craze("domain --import " + path("nowhere.csv")).out.find("nowhere.csv is not there"),
              std::string::npos);
}

TEST_F(CommandLine, AnInterruptKeepsFinishedRoomsAndResumeGoesOn)
{
    const std::string out = path("stopped");
    const std::string command =
        std::string("sh -c '") + CRAZE_APP + " run " + path("small.toml") + " --out " + out +
        " & child=$!; while [ ! -e " + out +
        "/images/stamp.json ]; do sleep 0.02; done; kill -INT $child; wait $child; echo code $?'";
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string text;
    for (int c = 0; (c = fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    pclose(pipe);
    ASSERT_NE(text.find("code 130"), std::string::npos) << text;
    EXPECT_TRUE(fs::exists(out + "/images/stamp.json"));
    EXPECT_FALSE(fs::exists(out + "/report/stamp.json"));

    const auto resumed = run_craze("run " + path("small.toml") + " --resume --out " + out);
    EXPECT_EQ(resumed.code, 0) << resumed.out;
    EXPECT_NE(resumed.out.find("images: unchanged, skipped"), std::string::npos) << resumed.out;
    EXPECT_TRUE(fs::exists(out + "/report/index.html"));
}

}  // namespace
}  // namespace craze
