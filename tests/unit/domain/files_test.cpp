#include "craze/domain/files.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/domain/packing.hpp"
#include "craze/domain/room.hpp"
#include "craze/io/atomic_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace craze::domain {
namespace {

namespace fs = std::filesystem;

class DomainFiles : public ::testing::Test {
protected:
    void SetUp() override
    {
        set_verbosity(Verbosity::quiet);
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    fs::path write(const std::string& name, const std::string& text) const
    {
        io::write_text(folder / name, text);
        return folder / name;
    }
    /// What reading these elements and bonds is refused with.
    std::string refusal(const std::string& elements, const std::string& bonds, const std::string& near = "") const
    {
        Source source;
        source.elements = write("e.csv", elements);
        source.bonds = write("b.csv", bonds);
        if (!near.empty()) source.near = write("n.csv", near);
        try {
            read_domain(source);
        } catch (const InvalidInput& error) {
            return error.what();
        }
        return "";
    }

    fs::path folder = fs::path(::testing::TempDir()) / ("craze_domain_files_" + std::to_string(getpid()));
};

/// A packing with some bonds cut and thick.
Domain cracked()
{
    constexpr double R = 200e-9;
    const Vec3 box{9.1 * R, 8.3 * R, 10.7 * R};
    Domain d = join(pack_elements(box, {}), box, R, {});
    for (std::size_t b = 0; b < d.bonds.i.size(); b += 7) {
        d.bonds.kind[b] = BondKind::contact_beam;
        d.bonds.thickness[b] = 37.1e-9 / (1.0 + static_cast<double>(b));
    }
    for (std::size_t p = 0; p < d.near.i.size(); p += 5) d.near.thickness[p] = 1e-8 / (3.0 + static_cast<double>(p));
    return d;
}

void expect_same(const Domain& a, const Domain& b)
{
    EXPECT_EQ(a.box, b.box);
    EXPECT_EQ(a.mean_radius, b.mean_radius);
    EXPECT_EQ(a.dense_volume, b.dense_volume);
    EXPECT_EQ(a.elements.x, b.elements.x);
    EXPECT_EQ(a.elements.y, b.elements.y);
    EXPECT_EQ(a.elements.z, b.elements.z);
    EXPECT_EQ(a.elements.r, b.elements.r);
    EXPECT_EQ(a.bonds.i, b.bonds.i);
    EXPECT_EQ(a.bonds.j, b.bonds.j);
    EXPECT_EQ(a.bonds.kind, b.bonds.kind);
    EXPECT_EQ(a.bonds.thickness, b.bonds.thickness);
    EXPECT_EQ(a.near.i, b.near.i);
    EXPECT_EQ(a.near.j, b.near.j);
    EXPECT_EQ(a.near.thickness, b.near.thickness);
}

TEST_F(DomainFiles, KeepTheDomainBitForBitInEveryFormat)
{
    const Domain d = cracked();
    for (const std::string& format : written_formats()) {
        SCOPED_TRACE(format);
        const fs::path at = folder / format;
        write_domain(d, format, at);
        Source source;
        source.elements = at / (format == "csv"      ? "elements.csv"
                                : format == "yade"   ? "spheres.txt"
                                : format == "vtkhdf" ? "domain.vtkhdf"
                                                     : "domain.data");
        if (format == "csv") source.bonds = at / "bonds.csv";
        if (format == "yade") source.bonds = at / "bonds.txt";
        if (format != "vtkhdf") source.near = at / "near.csv";
        expect_same(read_domain(source), d);
    }
}

TEST_F(DomainFiles, AreRefusedWithTheirLine)
{
    const std::string four = "x,y,z,r\n1,1,1,1\n3,1,1,1\n5,1,1,1\n7,1,1,1\n", bonds = "i,j\n0,1\n1,2\n";
    EXPECT_EQ(refusal(four, bonds), "");
    const auto says = [&](const std::string& message, const std::string& where, const std::string& what) {
        EXPECT_NE(message.find(where), std::string::npos) << message;
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    says(refusal(four, "i,j\n0,1\n1,4\n"), "b.csv, line 3", "names element 4; there are 0 to 3");
    says(refusal(four, "i,j\n0,1\n-1,2\n"), "b.csv, line 3", "names element -1");
    says(refusal(four, "i,j\n2,2\n"), "b.csv, line 2", "itself");
    says(refusal(four, "i,j\n0,1\n# again\n1,0\n"), "b.csv, line 4", "after line 2");
    says(refusal(four, "i,j\n0,x\n"), "b.csv, line 2", "whole number");
    says(refusal(four, "i,j\n0\n"), "b.csv, line 2", "the line has 1");
    says(refusal(four, "i,j,kind,T\n0,1,glue,0\n"), "b.csv, line 2", "glue");
    says(refusal(four, "i,j,kind,T\n0,1,contact_beam,2.5\n"), "b.csv, line 2", "L_0");
    says(refusal(four, "i,j,kind,T\n0,1,contact_beam,-1\n"), "b.csv, line 2", "L_0");
    says(refusal(four, "i,j,kind,T\n0,1,contact_beam,nan\n"), "b.csv, line 2", "L_0");
    says(refusal(four, "i,j,kind,T\n0,1,beam,0.1\n"), "b.csv, line 2", "contact_beam");
    says(refusal("x,y,z,r\n1,1,1,1\n3,nan,1,1\n", "i,j\n"), "e.csv, line 3", "not finite");
    says(refusal("x,y,z,r\n1,1,1,1\n3,1,1,0\n", "i,j\n"), "e.csv, line 3", "positive radius");
    says(refusal("x,y,z,r\n1,1,1,1\n3,1,1,-2\n", "i,j\n"), "e.csv, line 3", "positive radius");
    says(refusal("# box_m = 4 2 2\nx,y,z,r\n1,1,1,1\n30,1,1,1\n", "i,j\n"), "e.csv, line 4", "outside the box");
    says(refusal("x,y,z,r\n1,1,1,1\n1.5,1,1,1\n", "i,j\n"), "e.csv, line 3", "overlaps");
    says(refusal("x,y,r\n1,1,1\n", "i,j\n"), "e.csv, line 1", "column \"z\"");
    says(refusal("x,y,z,r\n", "i,j\n"), "e.csv", "no element");
    says(refusal(four, bonds, "i,j,T\n0,2,0\n0,9,0\n"), "n.csv, line 3", "near pair names element 9");
    Source absent;
    absent.elements = folder / "nothing.csv";
    EXPECT_THROW(read_domain(absent), InvalidInput);
    EXPECT_THROW(write_domain(cracked(), "lamps", folder), InvalidInput);
}

TEST_F(DomainFiles, WhoseRadiusOrVolumeIsNotThatOfTheElementsAreRefused)
{
    const std::string rows = "x,y,z,r\n1,1,1,1\n3,1,1,1\n", bonds = "i,j\n0,1\n";
    const auto refused = [&](const std::string& remark, const std::string& what) {
        const std::string message = refusal("# " + remark + "\n" + rows, bonds);
        EXPECT_NE(message.find(what), std::string::npos) << remark << ": " << message;
    };
    for (const char* radius : {"0", "-1", "nan", "0.4", "2.1"})
        refused(std::string("mean_radius_m = ") + radius, "mean radius");
    for (const char* volume : {"0", "-1", "nan", "inf", "8.37"})  // two spheres have 8.378
        refused(std::string("dense_volume_m3 = ") + volume, "dense volume");
    EXPECT_EQ(refusal("# mean_radius_m = 1.1; dense_volume_m3 = 8.4\n" + rows, bonds), "");
}

TEST_F(DomainFiles, OfLammpsAreRefusedWithTheirLine)
{
    const std::string head = "of someone\n\n3 atoms\n2 bonds\n2 bond types\n0 6 xlo xhi\n0 2 ylo yhi\n0 2 zlo zhi\n";
    const std::string atoms = "\nAtoms # bpm/sphere\n\n3 1 1 2 1 5 1 1\n1 1 1 2 1 1 1 1\n2 1 1 2 1 3 1 1\n";
    const auto read = [&](const std::string& text) {
        Source source;
        source.elements = write("l.data", text);
        return read_domain(source);
    };
    const Domain d = read(head + atoms + "\nBonds\n\n1 1 3 2\n2 2 1 2 # T = 0.5\n");
    EXPECT_EQ(d.elements.x, (std::vector<double>{1, 3, 5}));
    EXPECT_EQ(d.bonds.i, (std::vector<std::int32_t>{0, 1}));
    EXPECT_EQ(d.bonds.thickness, (std::vector<double>{0.5, 0}));
    EXPECT_EQ(d.bonds.kind, (std::vector{BondKind::contact_beam, BondKind::beam}));
    const auto refused = [&](const std::string& text, const std::string& where, const std::string& what) {
        try {
            read(text);
            FAIL() << "read: " << what;
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find(where), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
        }
    };
    refused(head + atoms + "\nBonds\n\n1 1 3 2\n2 1 1 4\n", "line 19", "names atom 4; there are 1 to 3");
    refused(head + atoms + "\nBonds\n\n1 1 0 2\n2 1 1 2\n", "line 18", "names atom 0");
    refused(head + atoms + "\nBonds\n\n1 1 3 3\n2 1 1 2\n", "line 18", "joins atom 3 to itself");
    refused(head + atoms + "\nBonds\n\n1 3 3 2\n2 1 1 2\n", "line 18", "bond type 1");
    refused(head + atoms + "\nBonds\n\n1 1 3 2\n", "l.data", "after 1 of 2 bonds");
    refused(head + atoms, "l.data", "after 0 of 2 bonds");
    refused(head + "\nAtoms # bpm/sphere\n\n3 1 1 2 1 5 1 1\n", "l.data", "after 1 of 3 atoms");
    refused(head + "1 0 0 xy xz yz\n" + atoms, "line 9", "right angles");
}

TEST_F(DomainFiles, OfOneFileTakeNoSecondFileAndVtkhdfIsInMetres)
{
    const Domain d = cracked();
    write_domain(d, "vtkhdf", folder);
    write_domain(d, "csv", folder);
    Source source;
    source.elements = folder / "domain.vtkhdf";
    const auto refused = [&](auto change) {
        Source changed = source;
        change(changed);
        EXPECT_THROW(read_domain(changed), InvalidInput);
    };
    refused([&](Source& s) { s.bonds = folder / "bonds.csv"; });
    refused([&](Source& s) { s.near = folder / "near.csv"; });
    refused([](Source& s) { s.unit = 1e-6; });
    refused([&](Source& s) { s.box = 0.5 * d.box; });
    refused([&](Source& s) { s.mean_radius = 3 * d.mean_radius; });
    source.box = 2.0 * d.box;
    EXPECT_EQ(read_domain(source).box, 2.0 * d.box);
}

TEST_F(DomainFiles, OfOthersMayHaveAnyUnitOrderAndColumns)
{
    Source source;
    source.elements = write("e.csv", "r;z;y;x\n1;1;1;7\n1;1;1;1\n1;1;1;5\n1;1;1;3\n");
    source.bonds = write("b.csv", "j,i\n0,2\n1,3\n");
    source.unit = 1e-6;
    source.box = Vec3{8e-6, 2e-6, 2e-6};
    const Domain d = read_domain(source);
    EXPECT_EQ(d.elements.x, (std::vector<double>{1 * 1e-6, 3 * 1e-6, 5 * 1e-6, 7 * 1e-6}));  // along a Morton curve
    EXPECT_EQ(d.bonds.i, (std::vector<std::int32_t>{0, 2}));
    EXPECT_EQ(d.bonds.j, (std::vector<std::int32_t>{1, 3}));
    EXPECT_EQ(d.near.i, std::vector<std::int32_t>{1});  // touching, not bonded
    EXPECT_DOUBLE_EQ(d.mean_radius, 1e-6);
    EXPECT_EQ(d.box.x, 8e-6);
}

TEST_F(DomainFiles, ListingsAreReadGzipped)
{
    write("p.txt", "3 1\n1 1 1 1\n3 1 1 1\n5 1 1 1\n0 1\n");
    ASSERT_EQ(std::system(("gzip " + (folder / "p.txt").string()).c_str()), 0);
    Source source;
    source.elements = folder / "p.txt.gz";
    const Domain d = read_domain(source);
    EXPECT_EQ(d.elements.size(), 3);
    EXPECT_EQ(d.bonds.size(), 1);
    EXPECT_EQ(d.box, (Vec3{6, 2, 2}));
    source.elements = write("short.txt", "3 1\n1 1 1 1\n3 1 1 1\n");
    EXPECT_THROW(read_domain(source), InvalidInput);
}

TEST_F(DomainFiles, ImportedContactBeamsAreCutBondsOfTheDiscretisation)
{
    const Domain d = cracked();
    write_domain(d, "csv", folder);
    Settings s;
    s.import_from.elements = (folder / "elements.csv").string();
    s.import_from.bonds = (folder / "bonds.csv").string();
    s.import_from.near = (folder / "near.csv").string();
    const Discretisation imported = import_domain(s);
    expect_same(with_defects(imported, {}), d);
    EXPECT_EQ(std::ranges::count(with_defects(imported, {.pores = false, .cracks = false}).bonds.kind, BondKind::beam),
              d.bonds.size());
    s.import_from.bonds = (folder / "nothing.csv").string();
    EXPECT_THROW(check(s), InvalidInput);
    Settings misspelt;
    misspelt.write = {"lamps"};
    EXPECT_THROW(check(misspelt), InvalidInput);
}

TEST_F(DomainFiles, OfLammpsAreReadByLammps)
{
    if (std::system("command -v lmp > /dev/null 2>&1") != 0) GTEST_SKIP() << "no lmp: install the package lammps";
    // Bonded particles are an optional package: without it, spheres with bonds are read in the hybrid style.
    ASSERT_EQ(std::system(("lmp -h > " + (folder / "help").string() + " 2>&1").c_str()), 0);
    const bool bpm = io::read_text(folder / "help").find("bpm/sphere") != std::string::npos;
    const Domain d = cracked();
    write_domain(d, bpm ? "lammps" : "lammps_hybrid", folder);
    write("in.craze", std::string("units si\natom_style ") + (bpm ? "bpm/sphere" : "hybrid bond sphere") +
                          "\nboundary f f f\nnewton on off\nread_data domain.data\n"
                          "print \"$(count(all)) $(mass(all):%.17g) $(bound(all,xmax):%.17g)\" file said.txt\n");
    const int status = std::system(("cd " + folder.string() + " && lmp -in in.craze > out.txt 2>&1").c_str());
    ASSERT_EQ(status, 0) << io::read_text(folder / "out.txt");
    std::istringstream said(io::read_text(folder / "said.txt"));
    double atoms = 0.0, mass = 0.0, x_most = 0.0;
    said >> atoms >> mass >> x_most;
    EXPECT_EQ(atoms, d.elements.size());
    EXPECT_NEAR(mass / (6060.0 * d.box.x * d.box.y * d.box.z), 1.0, 1e-9);  // the box is full of matter
    EXPECT_DOUBLE_EQ(x_most, *std::ranges::max_element(d.elements.x));
    EXPECT_NE(io::read_text(folder / "out.txt").find(std::to_string(d.bonds.size()) + " bonds"), std::string::npos);
}

TEST_F(DomainFiles, OfYadeAreReadByYade)
{
    if (std::system("command -v yade > /dev/null 2>&1") != 0) GTEST_SKIP() << "no yade: install the package yade";
    const Domain d = cracked();
    write_domain(d, "yade", folder);
    write("read.py",
          "from yade import ymport\nb = ymport.text('spheres.txt')\n"
          "open('said.txt', 'w').write('%d %.17g' % (len(b), sum(s.shape.radius for s in b)))\n");
    ASSERT_EQ(std::system(("cd " + folder.string() + " && yade -x -n read.py > out.txt 2>&1").c_str()), 0);
    std::istringstream said(io::read_text(folder / "said.txt"));
    double bodies = 0.0, radii = 0.0, sum = 0.0;
    said >> bodies >> radii;
    for (const double r : d.elements.r) sum += r;
    EXPECT_EQ(bodies, d.elements.size());
    EXPECT_NEAR(radii / sum, 1.0, 1e-9);
}

}  // namespace
}  // namespace craze::domain
