#include "craze/io/atomic_file.hpp"
#include "craze/io/picture.hpp"
#include "craze/io/volume_formats.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

// libpng leaves by longjmp: nothing with a destructor may live in the functions it can leave.
struct Trouble {
    std::jmp_buf back;
    char message[200] = "";
};

void on_error(png_structp png, png_const_charp message)
{
    auto* trouble = static_cast<Trouble*>(png_get_error_ptr(png));
    std::strncpy(trouble->message, message, sizeof trouble->message - 1);
    std::longjmp(trouble->back, 1);
}

void on_warning(png_structp, png_const_charp) {}

struct Source {
    std::span<const std::byte> left;
};

void from_memory(png_structp png, png_bytep to, std::size_t count)
{
    auto* source = static_cast<Source*>(png_get_io_ptr(png));
    if (count > source->left.size()) png_error(png, "truncated");
    std::memcpy(to, source->left.data(), count);
    source->left = source->left.subspan(count);
}

struct PngHeader {
    std::int64_t width = 0, height = 0, channels = 0, bits = 0;
    double pixel_size_x = 0.0, pixel_size_y = 0.0;
};

struct PngHandle {
    Trouble trouble;
    Source source;
    png_structp png = nullptr;
    png_infop info = nullptr;

    explicit PngHandle(std::span<const std::byte> bytes) : source{bytes}
    {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &trouble, on_error, on_warning);
        info = png_create_info_struct(png);
    }
    ~PngHandle() { png_destroy_read_struct(&png, &info, nullptr); }
    PngHandle(const PngHandle&) = delete;
    PngHandle& operator=(const PngHandle&) = delete;
};

bool read_head(PngHandle& handle, PngHeader& head)
{
    if (setjmp(handle.trouble.back) != 0) return false;
    png_set_read_fn(handle.png, &handle.source, from_memory);
    png_read_info(handle.png, handle.info);
    if (png_get_color_type(handle.png, handle.info) == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(handle.png);
    if (png_get_bit_depth(handle.png, handle.info) < 8) png_set_expand_gray_1_2_4_to_8(handle.png);
    png_set_swap(handle.png);
    png_set_interlace_handling(handle.png);
    png_read_update_info(handle.png, handle.info);
    head.width = png_get_image_width(handle.png, handle.info);
    head.height = png_get_image_height(handle.png, handle.info);
    head.channels = png_get_channels(handle.png, handle.info);
    head.bits = png_get_bit_depth(handle.png, handle.info);
    const auto x = png_get_x_pixels_per_meter(handle.png, handle.info);
    const auto y = png_get_y_pixels_per_meter(handle.png, handle.info);
    if (x > 0 && y > 0) head.pixel_size_x = 1.0 / x, head.pixel_size_y = 1.0 / y;
    return true;
}

bool read_rows(PngHandle& handle, png_bytepp rows)
{
    if (setjmp(handle.trouble.back) != 0) return false;
    png_read_image(handle.png, rows);
    png_read_end(handle.png, nullptr);
    return true;
}

struct Decoded {
    PngHeader head;
    std::vector<std::byte> pixels;
};

Decoded decode(const fs::path& file, bool pixels_too)
{
    const RawFile raw(file, RawFile::Mode::read);
    std::vector<std::byte> bytes(static_cast<std::size_t>(std::min<std::int64_t>(raw.size(), std::int64_t{1} << 32U)));
    raw.read_at(0, bytes);
    PngHandle handle(bytes);
    Decoded out;
    const auto damaged = [&] {
        refuse(file, fmt::format("damaged or not a PNG picture ({})", handle.trouble.message));
    };
    if (!read_head(handle, out.head)) damaged();
    check_shape(file, {out.head.width, out.head.height, 1});
    const std::int64_t row = out.head.width * out.head.channels * out.head.bits / 8, size = row * out.head.height;
    // Deflate packs at most 1032 to 1: a header that says more lies.
    if (size / 1100 > static_cast<std::int64_t>(bytes.size()))
        refuse(file, fmt::format("truncated: {} bytes cannot hold {} x {} pixels", bytes.size(), out.head.width,
                                 out.head.height));
    if (!pixels_too) return out;
    out.pixels.resize(static_cast<std::size_t>(size));
    std::vector<png_bytep> rows(static_cast<std::size_t>(out.head.height));
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = reinterpret_cast<png_bytep>(out.pixels.data()) + y * static_cast<std::size_t>(row);
    if (!read_rows(handle, rows.data())) damaged();
    return out;
}

class PngReader final : public VolumeReader {
public:
    explicit PngReader(const fs::path& file) : VolumeReader(file, {})
    {
        const PngHeader head = decode(file, false).head;
        info_.shape = {head.width, head.height, 1};
        info_.sample = head.bits == 16 ? Sample::u16 : Sample::u8;
        info_.colour = head.channels >= 3;
        info_.voxel_size = {head.pixel_size_x, head.pixel_size_y, 0.0};
    }

private:
    void read(std::int64_t, std::span<std::byte> to) override
    {
        const Decoded picture = decode(path_, true);
        if (!gray_of_channels(picture.pixels, picture.head.channels, info_.sample, to))
            refuse(path_, "is in real colour; needed gray levels");
    }
};

// Memory grows here, outside of what libpng can leave.
struct Sink {
    std::string bytes;
};

void to_memory(png_structp png, png_bytep from, std::size_t count)
{
    auto* sink = static_cast<Sink*>(png_get_io_ptr(png));
    try {
        sink->bytes.append(reinterpret_cast<const char*>(from), count);
    } catch (...) {
        png_error(png, "out of memory");
    }
}

void no_flush(png_structp) {}

struct Plan {
    std::int64_t width, height;
    int bits, colour;
    double pixel_size_x, pixel_size_y;
};

bool encode(png_structp png, png_infop info, Trouble& trouble, Sink& sink, const Plan& plan, png_bytepp rows)
{
    if (setjmp(trouble.back) != 0) return false;
    png_set_write_fn(png, &sink, to_memory, no_flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(plan.width), static_cast<png_uint_32>(plan.height), plan.bits,
                 plan.colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (plan.pixel_size_x > 0.0 && 1.0 / plan.pixel_size_x < 2e9 && 1.0 / plan.pixel_size_y < 2e9)
        png_set_pHYs(png, info, static_cast<png_uint_32>(1.0 / plan.pixel_size_x + 0.5),
                     static_cast<png_uint_32>(1.0 / plan.pixel_size_y + 0.5), PNG_RESOLUTION_METER);
    png_set_compression_level(png, 6);
    png_write_info(png, info);
    png_set_swap(png);
    png_write_image(png, rows);
    png_write_end(png, nullptr);
    return true;
}

std::string encoded(const Plan& plan, std::span<const std::byte> pixels)
{
    Trouble trouble;
    Sink sink;
    std::vector<png_bytep> rows(static_cast<std::size_t>(plan.height));
    const std::size_t row = pixels.size() / rows.size();
    for (std::size_t y = 0; y < rows.size(); ++y)
        rows[y] = reinterpret_cast<png_bytep>(const_cast<std::byte*>(pixels.data())) + y * row;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &trouble, on_error, on_warning);
    png_infop info = png_create_info_struct(png);
    const bool done = encode(png, info, trouble, sink, plan, rows.data());
    png_destroy_write_struct(&png, &info);
    if (!done) throw InvalidInput(fmt::format("a PNG picture cannot be made ({})", trouble.message));
    return std::move(sink.bytes);
}

class PngWriter final : public VolumeWriter {
public:
    PngWriter(const fs::path& file, const VolumeInfo& info) : VolumeWriter(file, info)
    {
        if (info.shape.nz != 1 || info.sample == Sample::f32)
            refuse(file, "a PNG holds one slice of 8 or 16 bits; choose .tif or .mhd");
    }

private:
    void append(std::int64_t, std::span<const std::byte> slice) override
    {
        const Plan plan{info_.shape.nx,      info_.shape.ny,     info_.sample == Sample::u16 ? 16 : 8,
                        PNG_COLOR_TYPE_GRAY, info_.voxel_size.x, info_.voxel_size.y};
        write_text(path_, encoded(plan, slice));
    }
    void close() override {}
};

}  // namespace

ReaderPtr open_png(const fs::path& file) { return std::make_unique<PngReader>(file); }

WriterPtr create_png(const fs::path& file, const VolumeInfo& info) { return std::make_unique<PngWriter>(file, info); }

std::string png_bytes(const Picture& picture)
{
    if (picture.width < 1 || picture.height < 1 || (picture.channels != 1 && picture.channels != 3))
        throw InvalidInput(fmt::format("a picture of {} x {} pixels and {} channels cannot be a PNG", picture.width,
                                       picture.height, picture.channels));
    const int colour = picture.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB;
    return encoded({picture.width, picture.height, 8, colour, 0.0, 0.0}, std::as_bytes(std::span(picture.pixels)));
}

void write_png(const fs::path& file, const Picture& picture) { write_text(file, png_bytes(picture)); }

void write_png(const fs::path& file, std::int64_t width, std::int64_t height, std::span<const std::uint8_t> gray)
{
    write_text(file, encoded({width, height, 8, PNG_COLOR_TYPE_GRAY, 0.0, 0.0}, std::as_bytes(gray)));
}

Picture read_png(const fs::path& file)
{
    const Decoded from = decode(file, true);
    if (from.head.bits != 8) refuse(file, "needed an 8-bit picture, got a 16-bit one");
    Picture picture(from.head.width, from.head.height, from.head.channels < 3 ? 1 : 3);
    for (std::size_t i = 0, n = static_cast<std::size_t>(picture.width * picture.height); i < n; ++i)
        for (std::size_t c = 0; c < static_cast<std::size_t>(picture.channels); ++c)
            picture.pixels[i * static_cast<std::size_t>(picture.channels) + c] =
                static_cast<std::uint8_t>(from.pixels[i * static_cast<std::size_t>(from.head.channels) + c]);
    return picture;
}

}  // namespace craze::io
