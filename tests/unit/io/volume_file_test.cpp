#include "craze/io/volume_file.hpp"

#include "craze/core/random.hpp"
#include "craze/io/picture.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace craze::io {
namespace {

using support::TemporaryFolder;

constexpr Shape odd{37, 23, 5};

template <class T>
Volume<T> random_volume(Shape shape, std::uint64_t seed)
{
    Volume<T> volume(shape);
    Random random(seed);
    for (T& v : volume.values()) v = static_cast<T>(random.bits() & 0xffffU);
    return volume;
}

template <class T>
void expect_round_trip(const std::string& name, double voxel_size)
{
    const TemporaryFolder folder;
    const auto volume = random_volume<T>(odd, 1);
    write_volume(folder / name, volume, voxel_size);
    const auto reader = open_volume(folder / name);
    EXPECT_EQ(reader->info().shape, odd) << name;
    EXPECT_NEAR(reader->info().voxel_size.x, voxel_size, 1e-6 * voxel_size) << name;
    EXPECT_NEAR(reader->info().voxel_size.z, voxel_size, 1e-6 * voxel_size) << name;
    const auto back = read_volume<T>(*reader);
    EXPECT_TRUE(std::ranges::equal(volume.values(), back.values())) << name;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
}

TEST(VolumeFile, WrittenAndReadAgainIsTheSame)
{
    for (const char* name : {"v.mhd", "v.mha", "v.tif", "v.nrrd", "v.h5"}) {
        expect_round_trip<std::uint8_t>(name, 23.6e-9);
        expect_round_trip<std::uint16_t>(name, 23.6e-9);
        expect_round_trip<float>(name, 1e-6);
    }
}

TEST(VolumeFile, IsReadFromTheMiddleAndBackwards)
{
    const TemporaryFolder folder;
    const auto volume = random_volume<std::uint16_t>(odd, 2);
    for (const char* name : {"v.mhd", "v.tif", "v.h5", "slices"}) {
        write_volume(folder / name, volume);
        const auto reader = open_volume(folder / name);
        std::vector<std::uint16_t> slice(static_cast<std::size_t>(odd.nx * odd.ny));
        for (const std::int64_t z : {4, 1, 3, 0, 2}) {
            reader->read_slice(z, std::span(slice));
            EXPECT_TRUE(std::ranges::equal(slice, volume.slice(z))) << name << " " << z;
        }
    }
}

TEST(VolumeFile, AppearsOnlyWhenFinished)
{
    const TemporaryFolder folder;
    const auto volume = random_volume<std::uint8_t>(odd, 3);
    for (const char* name : {"v.mhd", "v.mha", "v.tif", "v.nrrd", "v.h5"}) {
        {
            const auto writer = create_volume(folder / name, {odd, Sample::u8, {}});
            writer->append_slice(volume.slice(0));
            EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
        }
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
    }
}

TEST(SliceFolder, IsReadInNaturalOrder)
{
    const TemporaryFolder folder;
    const auto volume = random_volume<std::uint8_t>({9, 7, 12}, 4);
    for (std::int64_t z = 0; z < 12; ++z)
        write_png(folder / ("cut " + std::to_string(z + 1) + ".png"), 9, 7, volume.slice(z));
    const auto back = read_volume<std::uint8_t>(folder.path());
    EXPECT_EQ(back.shape(), volume.shape());
    EXPECT_TRUE(std::ranges::equal(volume.values(), back.values()));
}

TEST(NaturalOrder, CountsAsPeopleDo)
{
    EXPECT_TRUE(natural_less("s2", "s10"));
    EXPECT_FALSE(natural_less("s10", "s2"));
    EXPECT_TRUE(natural_less("s002", "s10"));
    EXPECT_TRUE(natural_less("a9b2", "a9b11"));
    EXPECT_TRUE(natural_less("a", "a1"));
    EXPECT_TRUE(natural_less("s0", "s1"));
    EXPECT_FALSE(natural_less("x", "x"));
}

TEST(Picture, KeepsItsPixelsGrayAndInColour)
{
    const TemporaryFolder folder;
    for (const std::int64_t channels : {1, 3}) {
        Picture picture(31, 17, channels);
        Random random(5);
        for (auto& v : picture.pixels) v = static_cast<std::uint8_t>(random.bits() & 255U);
        write_png(folder / "p.png", picture);
        const Picture back = read_png(folder / "p.png");
        EXPECT_EQ(back.width, 31);
        EXPECT_EQ(back.channels, channels);
        EXPECT_EQ(back.pixels, picture.pixels);
    }
}

}  // namespace
}  // namespace craze::io
