// Files that are not what they say: each is refused by name, without a crash or a huge allocation.

#include "craze/io/volume_file.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/picture.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>

namespace craze::io {
namespace {

using support::TemporaryFolder;

void expect_refused(const std::filesystem::path& path, const std::string& named, const OpenOptions& options = {})
{
    try {
        const auto reader = open_volume(path, options);
        std::vector<std::byte> slice(static_cast<std::size_t>(reader->info().slice_bytes()));
        for (std::int64_t z = 0; z < reader->info().shape.nz; ++z) reader->read_slice(z, slice);
        ADD_FAILURE() << path << " was accepted";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
}

Volume<std::uint8_t> ramp(Shape shape)
{
    Volume<std::uint8_t> v(shape);
    std::uint32_t state = 1;
    for (auto& value : v.values()) value = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24U);
    return v;
}

class BadVolume : public testing::Test {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
    TemporaryFolder folder;
};

TEST_F(BadVolume, CutShortIsRefusedInEveryFormatAndAtEveryLength)
{
    for (const char* name : {"v.tif", "v.mha", "v.nrrd", "v.h5", "v.png"}) {
        const bool one = std::string(name) == "v.png";
        write_volume(folder / name, ramp({64, 48, one ? 1 : 4}));
        const std::string whole = read_text(folder / name);
        for (const double share : {0.0, 0.01, 0.1, 0.5, 0.9, 0.99}) {
            const std::string cut = std::string("cut") + name;
            write_text(folder / cut,
                       whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
            expect_refused(folder / cut, cut);
        }
    }
    write_volume(folder / "w.mhd", ramp({64, 48, 4}));
    std::filesystem::resize_file(folder / "w.raw", 64 * 48 * 3);
    expect_refused(folder / "w.mhd", "w.raw");
}

TEST_F(BadVolume, LyingSizesAreRefusedBeforeAnythingIsAllocated)
{
    const auto mha = [&](const std::string& size) {
        write_text(folder / "lie.mha",
                   "NDims = 3\nDimSize = " + size + "\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nabc");
        expect_refused(folder / "lie.mha", "lie.mha");
    };
    for (const char* size :
         {"100000 100000 100000", "-1 4 4", "0 4 4", "4 4", "x y z", "9223372036854775807 2 2", "1000000 1000000 1"})
        mha(size);
    write_text(folder / "lie.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 90000 90000 9\nencoding: raw\n\nabc");
    expect_refused(folder / "lie.nrrd", "lie.nrrd");
    write_volume(folder / "v.tif", ramp({64, 48, 2}));
    std::string tiff = read_text(folder / "v.tif");
    const std::string width{'\x00', '\x01', '\x04', '\x00', '\x01', '\x00', '\x00', '\x00', '\x40', '\x00'};
    const auto at = tiff.find(width);  // the width tag of the first page: 64 as a long
    if (at != std::string::npos) {
        tiff[at + 11] = '\x30';
        write_text(folder / "wide.tif", tiff);
        expect_refused(folder / "wide.tif", "wide.tif");
    }
}

TEST_F(BadVolume, WhatIsNoVolumeIsRefused)
{
    for (const char* name : {"text.tif", "text.png", "text.mhd", "text.mha", "text.nrrd", "text.h5", "text.doc"}) {
        write_text(folder / name, "this is no picture, whatever its name says; it goes on for a while all the same\n");
        expect_refused(folder / name, name);
    }
    expect_refused(folder / "absent.tif", "absent.tif");
    write_text(folder / "v.raw", std::string(1000, 'x'));
    expect_refused(folder / "v.raw", "v.raw");
    expect_refused(folder / "v.raw", "v.raw", {.dataset = "", .raw_shape = {10, 10, 11}});
    expect_refused(folder / "v.raw", "v.raw", {.dataset = "", .raw_shape = {10, 10, 9}});
    EXPECT_NO_THROW(open_volume(folder / "v.raw", {.dataset = "", .raw_shape = {10, 10, 10}}));
    write_volume(folder / "v.h5", ramp({8, 8, 2}));
    expect_refused(folder / "v.h5", "none", {.dataset = "none", .raw_shape = {}});
}

TEST_F(BadVolume, FolderThatIsEmptyOrMixedIsRefusedNamingTheSlice)
{
    std::filesystem::create_directories(folder / "empty");
    expect_refused(folder / "empty", "empty");
    write_png(folder / "sizes/s1.png", Picture(8, 8));
    write_png(folder / "sizes/s2.png", Picture(8, 9));
    expect_refused(folder / "sizes", "s2.png");
    write_volume(folder / "depths/s1.tif", Volume<std::uint8_t>({8, 8, 1}, 1));
    write_volume(folder / "depths/s2.tif", Volume<std::uint16_t>({8, 8, 1}, 1));
    expect_refused(folder / "depths", "s2.tif");
    write_volume(folder / "pages/s1.tif", Volume<std::uint8_t>({8, 8, 1}, 1));
    write_volume(folder / "pages/s2.tif", Volume<std::uint8_t>({8, 8, 2}, 1));
    expect_refused(folder / "pages", "s2.tif");
    write_png(folder / "kinds/s1.png", Picture(8, 8));
    write_volume(folder / "kinds/s2.tif", Volume<std::uint8_t>({8, 8, 1}, 1));
    expect_refused(folder / "kinds", "both");
}

TEST_F(BadVolume, RealColourIsRefusedAndGrayInColourIsReadWithANotice)
{
    Picture colour(8, 8, 3, 100);
    write_png(folder / "gray/s1.png", colour);
    take_notices();
    const auto gray = read_volume<std::uint8_t>(folder / "gray");
    EXPECT_EQ(gray(3, 3, 0), 100);
    EXPECT_EQ(take_notices().size(), 1U);
    colour.at(5, 5)[1] = 101;
    write_png(folder / "colour/s1.png", colour);
    expect_refused(folder / "colour", "s1.png");
}

TEST_F(BadVolume, MissingNumbersAreReported)
{
    for (const char* name : {"s1.png", "s2.png", "s5.png", "s7.png"}) write_png(folder / "gap" / name, Picture(8, 8));
    take_notices();
    EXPECT_EQ(open_volume(folder / "gap")->info().shape.nz, 4);
    const auto notices = take_notices();
    ASSERT_EQ(notices.size(), 1U);
    EXPECT_NE(notices[0].find("3 to 4, 6"), std::string::npos) << notices[0];
}

}  // namespace
}  // namespace craze::io
