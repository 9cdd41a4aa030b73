// Multi-page TIFF and BigTIFF through libtiff, one page a slice.

#include "craze/io/volume_formats.hpp"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

struct Trouble {
    std::string message;
};

int keep_message(TIFF*, void* user, const char*, const char* format, va_list arguments)
{
    char text[300];
    std::vsnprintf(text, sizeof text, format, arguments);
    auto& message = static_cast<Trouble*>(user)->message;
    if (message.empty()) message = text;
    return 1;
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

struct Closer {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Handle = std::unique_ptr<TIFF, Closer>;

Handle open_handle(const fs::path& file, const char* mode, Trouble& trouble)
{
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, &trouble);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, nullptr);
    Handle handle(TIFFOpenExt(file.c_str(), mode, options));
    TIFFOpenOptionsFree(options);
    return handle;
}

struct Page {
    std::uint64_t offset = 0;
    std::int64_t nx = 0, ny = 0;
    int bits = 0, channels = 1, format = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG, photometric = 0;
    bool tiled = false, palette_is_gray = false;
    double size_x = 0.0, size_y = 0.0;
};

template <class T>
T tag(TIFF* tiff, std::uint32_t name, T otherwise)
{
    T value = otherwise;
    return TIFFGetFieldDefaulted(tiff, name, &value) == 1 ? value : otherwise;
}

// Packed bytes of the page: what a decoder has to work from.
std::uint64_t stored_bytes(TIFF* tiff, bool tiled)
{
    const std::uint32_t pieces = tiled ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < pieces; ++i) sum += TIFFGetStrileByteCount(tiff, i);
    return sum;
}

Page describe_page(TIFF* tiff, const fs::path& file, std::uint64_t file_bytes)
{
    Page page;
    page.offset = TIFFCurrentDirOffset(tiff);
    page.nx = tag<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
    page.ny = tag<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
    page.bits = tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
    page.channels = tag<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    page.format = tag<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    page.planar = tag<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    page.photometric = tag<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    page.tiled = TIFFIsTiled(tiff) != 0;
    check_shape(file, {page.nx, page.ny, 1});
    if (page.channels < 1 || page.channels > 4)
        refuse(file, fmt::format("needed gray levels, got {} channels", page.channels));
    const std::uint64_t needed = static_cast<std::uint64_t>(page.nx * page.ny) *
                                 static_cast<std::uint64_t>(page.channels) *
                                 static_cast<std::uint64_t>(std::max(1, page.bits / 8));
    // LZW and deflate pack at most a few thousand to one: a header that says more lies.
    const std::uint64_t stored = std::min(stored_bytes(tiff, page.tiled), file_bytes);
    const bool plain = tag<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
    if (stored < (plain ? needed : needed / 4096))
        refuse(file,
               fmt::format("truncated or damaged: {} bytes cannot hold {} x {} pixels", stored, page.nx, page.ny));
    const auto unit = tag<std::uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
    const float x = tag<float>(tiff, TIFFTAG_XRESOLUTION, 0.0F), y = tag<float>(tiff, TIFFTAG_YRESOLUTION, 0.0F);
    if (unit == RESUNIT_CENTIMETER && std::isfinite(x) && std::isfinite(y) && x > 0 && y > 0)
        page.size_x = 1e-2 / x, page.size_y = 1e-2 / y;
    return page;
}

// ImageJ writes pixels per its own unit, and the unit and the step along z in the description.
void read_imagej(const char* description, Page& page, TIFF* tiff, double& size_z)
{
    const std::string text = description;
    const auto value = [&](std::string_view key) -> std::string {
        const auto at = text.find(key);
        if (at == std::string::npos) return "";
        const auto from = at + key.size();
        return text.substr(from, text.find('\n', from) - from);
    };
    const std::string unit = value("\nunit=");
    const double metre = unit == "nm"                                             ? 1e-9
                         : unit == "um" || unit == "micron" || unit == "\\u00B5m" ? 1e-6
                         : unit == "mm"                                           ? 1e-3
                                                                                  : 0.0;
    const float x = tag<float>(tiff, TIFFTAG_XRESOLUTION, 0.0F), y = tag<float>(tiff, TIFFTAG_YRESOLUTION, 0.0F);
    page.size_x = page.size_y = 0.0;
    if (metre <= 0.0 || !(x > 0) || !(y > 0)) return;
    page.size_x = metre / x, page.size_y = metre / y;
    size_z = std::strtod(value("\nspacing=").c_str(), nullptr) * metre;
    if (!(std::isfinite(size_z) && size_z > 0.0)) size_z = 0.0;
}

class TiffReader final : public VolumeReader {
public:
    explicit TiffReader(const fs::path& file) : VolumeReader(file, {}), tiff_(open_handle(file, "r", trouble_))
    {
        if (!tiff_) damaged();
        const std::uint64_t file_bytes = fs::file_size(file);
        do {
            pages_.push_back(describe_page(tiff_.get(), file, file_bytes));
            const Page &first = pages_.front(), &page = pages_.back();
            if (page.nx != first.nx || page.ny != first.ny || page.bits != first.bits || page.format != first.format)
                refuse(file, fmt::format("pages differ: page 1 is {} x {}, {} bits, page {} is {} x {}, {} bits",
                                         first.nx, first.ny, first.bits, pages_.size(), page.nx, page.ny, page.bits));
        } while (TIFFReadDirectory(tiff_.get()) == 1);
        if (!trouble_.message.empty()) damaged();
        const Page first = pages_.front();
        info_.shape = {first.nx, first.ny, static_cast<std::int64_t>(pages_.size())};
        if (first.bits == 8 && first.format == SAMPLEFORMAT_UINT)
            info_.sample = Sample::u8;
        else if (first.bits == 16 && first.format == SAMPLEFORMAT_UINT)
            info_.sample = Sample::u16;
        else if (first.bits == 32 && first.format == SAMPLEFORMAT_IEEEFP)
            info_.sample = Sample::f32;
        else
            refuse(file, fmt::format("needed 8 or 16 bits or 32-bit floats, got {} bits of another kind", first.bits));
        check_shape(file, info_.shape);
        info_.colour = first.channels >= 3;
        find_voxel_size();
    }

private:
    [[noreturn]] void damaged() const
    {
        refuse(path_, fmt::format("truncated, damaged or not a TIFF file ({})", trouble_.message));
    }

    void find_voxel_size()
    {
        Page page = pages_.front();
        double size_z = 0.0;
        TIFFSetSubDirectory(tiff_.get(), page.offset);
        char* description = nullptr;
        if (TIFFGetField(tiff_.get(), TIFFTAG_IMAGEDESCRIPTION, &description) == 1 && description != nullptr &&
            std::strncmp(description, "ImageJ=", 7) == 0)
            read_imagej(description, page, tiff_.get(), size_z);
        info_.voxel_size = {page.size_x, page.size_y, size_z};
    }

    void read(std::int64_t z, std::span<std::byte> to) override
    {
        const Page& page = pages_[static_cast<std::size_t>(z)];
        trouble_.message.clear();
        if (TIFFSetSubDirectory(tiff_.get(), page.offset) != 1) damaged();
        const bool separate = page.channels > 1 && page.planar == PLANARCONFIG_SEPARATE;
        const std::int64_t channels = separate ? 1 : page.channels;
        if (channels == 1) decode_plane(page, 0, 1, to);
        if (separate && page.channels >= 3) {
            std::vector<std::byte> other(to.size());
            for (int plane = 1; plane < 3; ++plane) {
                decode_plane(page, plane, 1, other);
                if (!std::equal(to.begin(), to.end(), other.begin())) colour();
            }
        }
        if (channels > 1) {
            std::vector<std::byte> pixels(to.size() * static_cast<std::size_t>(channels));
            decode_plane(page, 0, channels, pixels);
            if (!gray_of_channels(pixels, channels, info_.sample, to)) colour();
        }
        if (page.photometric == PHOTOMETRIC_PALETTE) look_up(to);
        if (page.photometric == PHOTOMETRIC_MINISWHITE && info_.sample != Sample::f32)
            for (std::byte& b : to) b = ~b;
    }

    [[noreturn]] void colour() const { refuse(path_, "is in real colour; needed gray levels"); }

    // Strips or tiles of one plane, `channels` values a pixel, laid out as rows.
    void decode_plane(const Page& page, int plane, std::int64_t channels, std::span<std::byte> to)
    {
        TIFF* tiff = tiff_.get();
        const std::int64_t pixel = channels * bytes_of(info_.sample), row = page.nx * pixel;
        if (!page.tiled) {
            const std::int64_t rows =
                std::clamp<std::int64_t>(tag<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, 1), 1, page.ny);
            for (std::int64_t y = 0; y < page.ny; y += rows) {
                const std::uint32_t strip =
                    TIFFComputeStrip(tiff, static_cast<std::uint32_t>(y), static_cast<std::uint16_t>(plane));
                const std::int64_t bytes = std::min(rows, page.ny - y) * row;
                if (TIFFReadEncodedStrip(tiff, strip, to.data() + y * row, bytes) != bytes) damaged();
            }
            return;
        }
        const std::int64_t w = tag<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0),
                           h = tag<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0);
        if (w < 1 || h < 1 || w > 65536 || h > 65536 ||
            TIFFTileSize64(tiff) != static_cast<std::uint64_t>(w * h * pixel))
            damaged();
        std::vector<std::byte> tile(static_cast<std::size_t>(w * h * pixel));
        for (std::int64_t y = 0; y < page.ny; y += h)
            for (std::int64_t x = 0; x < page.nx; x += w) {
                const std::uint32_t which =
                    TIFFComputeTile(tiff, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0,
                                    static_cast<std::uint16_t>(plane));
                if (TIFFReadEncodedTile(tiff, which, tile.data(), static_cast<tmsize_t>(tile.size())) !=
                    static_cast<tmsize_t>(tile.size()))
                    damaged();
                const auto length = static_cast<std::size_t>(std::min(w, page.nx - x) * pixel);
                for (std::int64_t j = 0; j < std::min(h, page.ny - y); ++j)
                    std::memcpy(to.data() + (y + j) * row + x * pixel, tile.data() + j * w * pixel, length);
            }
    }

    void look_up(std::span<std::byte> to) const
    {
        std::uint16_t *r = nullptr, *g = nullptr, *b = nullptr;
        if (info_.sample != Sample::u8 || TIFFGetField(tiff_.get(), TIFFTAG_COLORMAP, &r, &g, &b) != 1) damaged();
        if (!std::equal(r, r + 256, g) || !std::equal(r, r + 256, b)) colour();
        const bool wide = std::any_of(r, r + 256, [](std::uint16_t v) { return v > 255; });
        for (std::byte& v : to)
            v = static_cast<std::byte>(wide ? r[std::to_integer<int>(v)] >> 8 : r[std::to_integer<int>(v)]);
    }

    Trouble trouble_;
    Handle tiff_;
    std::vector<Page> pages_;
};

class TiffWriter final : public VolumeWriter {
public:
    TiffWriter(const fs::path& file, const VolumeInfo& info)
        : VolumeWriter(file, info), temporary_(temporary_beside(file))
    {
        const bool big = info.slice_bytes() * info.shape.nz > std::int64_t{3'900'000'000};
        tiff_ = open_handle(temporary_, big ? "w8" : "w", trouble_);
        if (!tiff_) failed();
    }
    ~TiffWriter() override
    {
        if (!tiff_) return;
        tiff_.reset();
        std::error_code ignored;
        fs::remove(temporary_, ignored);
    }

private:
    [[noreturn]] void failed() const { refuse(path_, fmt::format("cannot be written ({})", trouble_.message)); }

    void append(std::int64_t z, std::span<const std::byte> slice) override
    {
        TIFF* tiff = tiff_.get();
        const auto bits = static_cast<int>(8 * bytes_of(info_.sample));
        const std::int64_t row = info_.shape.nx * bytes_of(info_.sample);
        const std::int64_t rows = std::clamp<std::int64_t>(65536 / row, 1, info_.shape.ny);
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(info_.shape.nx));
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(info_.shape.ny));
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, info_.sample == Sample::f32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(rows));
        if (z == 0) describe_voxel(tiff);
        // libtiff takes a buffer it may change.
        buffer_.assign(slice.begin(), slice.end());
        for (std::int64_t y = 0, strip = 0; y < info_.shape.ny; y += rows, ++strip) {
            const std::int64_t bytes = std::min(rows, info_.shape.ny - y) * row;
            if (TIFFWriteEncodedStrip(tiff, static_cast<std::uint32_t>(strip), buffer_.data() + y * row, bytes) !=
                bytes)
                failed();
        }
        if (TIFFWriteDirectory(tiff) != 1) failed();
    }

    void describe_voxel(TIFF* tiff) const
    {
        const Vec3& size = info_.voxel_size;
        const auto slices = info_.shape.nz;
        std::string text = fmt::format("ImageJ=1.53\nimages={}\nslices={}\n", slices, slices);
        if (size.x > 0.0 && size.y > 0.0) {
            text += fmt::format("unit=um\nspacing={}\n", size.z * 1e6);
            TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1e-6 / size.x);
            TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 1e-6 / size.y);
            TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
        }
        TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, text.c_str());
    }

    void close() override
    {
        tiff_.reset();
        if (!trouble_.message.empty()) failed();
        fs::rename(temporary_, path_);
    }

    fs::path temporary_;
    Trouble trouble_;
    Handle tiff_;
    std::vector<std::byte> buffer_;
};

}  // namespace

ReaderPtr open_tiff(const fs::path& file) { return std::make_unique<TiffReader>(file); }

WriterPtr create_tiff(const fs::path& file, const VolumeInfo& info) { return std::make_unique<TiffWriter>(file, info); }

}  // namespace craze::io
