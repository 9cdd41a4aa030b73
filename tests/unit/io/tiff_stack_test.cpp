// Every way of laying out a TIFF that microscopes and their programs use, written here by libtiff itself.

#include "craze/core/random.hpp"
#include "craze/core/volume.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <tiffio.h>

#include <algorithm>
#include <string>
#include <vector>

namespace craze::io {
namespace {

using support::TemporaryFolder;

constexpr Shape shape{77, 45, 3};  // no multiple of a tile or a strip

struct Layout {
    const char* mode;  // w: little, b: big endian, 8: BigTIFF
    std::uint16_t compression, predictor;
    std::uint32_t tile, strip;  // 0: not tiled
};

template <class T>
Volume<T> smooth_noise()
{
    Volume<T> volume(shape);
    Random random(3);
    for (std::size_t i = 0; i < volume.values().size(); ++i)
        volume.values()[i] = static_cast<T>((i * (sizeof(T) == 1 ? 1 : 211) + random.bits() % 7) & 0xffffU);
    return volume;
}

template <class T>
void write_tiff(const std::string& path, const Volume<T>& volume, const Layout& how)
{
    TIFF* file = TIFFOpen(path.c_str(), how.mode);
    ASSERT_NE(file, nullptr);
    const auto width = static_cast<std::uint32_t>(shape.nx), height = static_cast<std::uint32_t>(shape.ny);
    for (std::int64_t z = 0; z < shape.nz; ++z) {
        TIFFSetField(file, TIFFTAG_IMAGEWIDTH, width);
        TIFFSetField(file, TIFFTAG_IMAGELENGTH, height);
        TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, static_cast<std::uint16_t>(8 * sizeof(T)));
        TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, std::uint16_t{1});
        TIFFSetField(file, TIFFTAG_PHOTOMETRIC, std::uint16_t{PHOTOMETRIC_MINISBLACK});
        TIFFSetField(file, TIFFTAG_PLANARCONFIG, std::uint16_t{PLANARCONFIG_CONTIG});
        TIFFSetField(file, TIFFTAG_COMPRESSION, how.compression);
        if (how.predictor > 1) TIFFSetField(file, TIFFTAG_PREDICTOR, how.predictor);
        if (how.tile > 0) {
            TIFFSetField(file, TIFFTAG_TILEWIDTH, how.tile);
            TIFFSetField(file, TIFFTAG_TILELENGTH, how.tile);
            std::vector<T> tile(static_cast<std::size_t>(how.tile) * how.tile);
            for (std::uint32_t y0 = 0; y0 < height; y0 += how.tile)
                for (std::uint32_t x0 = 0; x0 < width; x0 += how.tile) {
                    for (std::uint32_t y = 0; y < how.tile; ++y)
                        for (std::uint32_t x = 0; x < how.tile; ++x)
                            tile[x + static_cast<std::size_t>(how.tile) * y] =
                                x0 + x < width && y0 + y < height ? volume(x0 + x, y0 + y, z) : T{9};
                    ASSERT_GT(TIFFWriteTile(file, tile.data(), x0, y0, 0, 0), 0);
                }
        } else {
            TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, how.strip);
            std::vector<T> row(static_cast<std::size_t>(shape.nx));
            for (std::uint32_t y = 0; y < height; ++y) {
                std::ranges::copy(volume.row(y, z), row.begin());
                ASSERT_EQ(TIFFWriteScanline(file, row.data(), y, 0), 1);
            }
        }
        ASSERT_EQ(TIFFWriteDirectory(file), 1);
    }
    TIFFClose(file);
}

template <class T>
void expect_read(const Layout& how)
{
    const TemporaryFolder folder;
    const auto volume = smooth_noise<T>();
    const std::string path = (folder / "stack.tif").string();
    write_tiff(path, volume, how);
    const auto back = read_volume<T>(path);
    const std::string what = std::string(how.mode) + " compression " + std::to_string(how.compression) + " predictor " +
                             std::to_string(how.predictor) + " tile " + std::to_string(how.tile);
    ASSERT_EQ(back.shape(), shape) << what;
    EXPECT_TRUE(std::ranges::equal(back.values(), volume.values())) << what;
}

TEST(TiffStack, IsReadInEveryLayoutByteOrderAndCompression)
{
    for (const char* mode : {"wl", "wb", "wl8", "wb8"})
        for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE})
            for (const int predictor : {1, 2})
                for (const std::uint32_t tile : {0U, 16U, 64U}) {
                    if (compression == COMPRESSION_NONE && predictor == 2) continue;
                    const Layout how{mode, static_cast<std::uint16_t>(compression),
                                     static_cast<std::uint16_t>(predictor), tile, 7};
                    expect_read<std::uint8_t>(how);
                    expect_read<std::uint16_t>(how);
                }
}

TEST(TiffStack, SaysItsByteOrderAndSizeInItsFirstBytes)
{
    const TemporaryFolder folder;
    const auto start = [&](const char* mode) {
        write_tiff((folder / "s.tif").string(), smooth_noise<std::uint8_t>(), {mode, COMPRESSION_NONE, 1, 0, 7});
        return read_text(folder / "s.tif").substr(0, 4);
    };
    // What the test above read was what it meant to read.
    EXPECT_EQ(start("wl"), std::string("II*\0", 4));
    EXPECT_EQ(start("wb"), std::string("MM\0*", 4));
    EXPECT_EQ(start("wl8"), std::string("II+\0", 4));
    EXPECT_EQ(start("wb8"), std::string("MM\0+", 4));
}

TEST(RawFile, IsReadInEitherByteOrderAndAfterAHeader)
{
    const TemporaryFolder folder;
    const auto volume = smooth_noise<std::uint16_t>();
    std::string bytes = "header";
    for (const std::uint16_t v : volume.values()) bytes += {static_cast<char>(v >> 8U), static_cast<char>(v & 255U)};
    write_text(folder / "v.raw", bytes);
    const auto back = read_volume<std::uint16_t>(*open_volume(
        folder / "v.raw",
        {.dataset = "", .raw_shape = shape, .raw_sample = Sample::u16, .raw_big_endian = true, .raw_header = 6}));
    EXPECT_TRUE(std::ranges::equal(back.values(), volume.values()));
}

TEST(MetaImageAndNrrd, AreReadInEitherByteOrderWithTheirVoxelSize)
{
    const TemporaryFolder folder;
    const auto volume = smooth_noise<std::uint16_t>();
    std::string big, little;
    for (const std::uint16_t v : volume.values()) {
        big += {static_cast<char>(v >> 8U), static_cast<char>(v & 255U)};
        little += {static_cast<char>(v & 255U), static_cast<char>(v >> 8U)};
    }
    write_text(folder / "b.mha",
               "ObjectType = Image\nNDims = 3\nDimSize = 77 45 3\nElementSpacing = 0.01 0.01 0.02\n"
               "ElementByteOrderMSB = True\nElementType = MET_USHORT\nElementDataFile = LOCAL\n" +
                   big);
    write_text(
        folder / "b.nrrd",
        "NRRD0004\n# a remark\ntype: unsigned short\ndimension: 3\nsizes: 77 45 3\nendian: big\nencoding: raw\n\n" +
            big);
    write_text(folder / "l.nrrd",
               "NRRD0004\ntype: uint16\ndimension: 3\nsizes: 77 45 3\nendian: little\nencoding: raw\n\n" + little);
    for (const char* name : {"b.mha", "b.nrrd", "l.nrrd"}) {
        const auto back = read_volume<std::uint16_t>(folder / name);
        EXPECT_EQ(back.shape(), shape) << name;
        EXPECT_TRUE(std::ranges::equal(back.values(), volume.values())) << name;
    }
    const Vec3 edge = open_volume(folder / "b.mha")->info().voxel_size;
    EXPECT_NEAR(edge.z, 2.0 * edge.x, 1e-9 * edge.x);
}

}  // namespace
}  // namespace craze::io
