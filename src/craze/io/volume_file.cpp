#include "craze/io/volume_file.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/volume_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

namespace craze::io {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "plain files are written as they lie in memory");

std::string_view name_of(Sample sample)
{
    return sample == Sample::u8 ? "8-bit" : sample == Sample::u16 ? "16-bit" : "32-bit float";
}

void VolumeReader::read_slice(std::int64_t z, std::span<std::byte> to)
{
    assert(z >= 0 && z < info_.shape.nz && static_cast<std::int64_t>(to.size()) == info_.slice_bytes());
    read(z, to);
}

void VolumeReader::require(Sample sample) const
{
    if (info_.sample != sample)
        refuse(path_, fmt::format("needed {} values, got {} ones", name_of(sample), name_of(info_.sample)));
}

void VolumeWriter::append_slice(std::span<const std::byte> slice)
{
    assert(written_ < info_.shape.nz && static_cast<std::int64_t>(slice.size()) == info_.slice_bytes());
    append(written_++, slice);
}

void VolumeWriter::finish()
{
    assert(written_ == info_.shape.nz);
    close();
}

void refuse(const fs::path& file, std::string_view what)
{
    throw InvalidInput(fmt::format("{}: {}", file.string(), what));
}

fs::path temporary_beside(const fs::path& file)
{
    return file.parent_path() / fmt::format(".{}.part", file.filename().string());
}

void check_shape(const fs::path& file, const Shape& shape)
{
    constexpr std::int64_t most = 1'000'000;
    for (int axis = 0; axis < 3; ++axis)
        if (shape[axis] < 1 || shape[axis] > most)
            refuse(file, fmt::format("needed 1 to {} voxels along each axis, got {} x {} x {}", most, shape.nx,
                                     shape.ny, shape.nz));
    if (shape.nx * shape.ny > std::int64_t{1} << 31U)
        refuse(file, fmt::format("a slice of {} x {} pixels is too large", shape.nx, shape.ny));
}

void swap_bytes(std::span<std::byte> values, Sample sample)
{
    const auto width = static_cast<std::size_t>(bytes_of(sample));
    if (width == 1) return;
    for (std::size_t i = 0; i + width <= values.size(); i += width)
        std::reverse(values.begin() + static_cast<std::ptrdiff_t>(i),
                     values.begin() + static_cast<std::ptrdiff_t>(i + width));
}

namespace {

class PlainReader final : public VolumeReader {
public:
    PlainReader(const fs::path& path, const fs::path& data, const VolumeInfo& info, std::int64_t offset,
                bool big_endian)
        : VolumeReader(path, info), file_(data, RawFile::Mode::read), offset_(offset), big_endian_(big_endian)
    {
        check_shape(path, info.shape);
        const std::int64_t needed = offset + info.slice_bytes() * info.shape.nz;
        if (file_.size() < needed)
            refuse(data, fmt::format("truncated or not of the stated shape: {} x {} x {} {} voxels need {} bytes, "
                                     "the file has {}",
                                     info.shape.nx, info.shape.ny, info.shape.nz, name_of(info.sample), needed,
                                     file_.size()));
    }

private:
    void read(std::int64_t z, std::span<std::byte> to) override
    {
        file_.read_at(offset_ + z * info_.slice_bytes(), to);
        if (big_endian_) swap_bytes(to, info_.sample);
    }

    RawFile file_;
    std::int64_t offset_;
    bool big_endian_;
};

std::string lower_extension(const fs::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

}  // namespace

ReaderPtr read_plain(const fs::path& path, const fs::path& data, const VolumeInfo& info, std::int64_t offset,
                     bool big_endian)
{
    return std::make_unique<PlainReader>(path, data, info, offset, big_endian);
}

ReaderPtr open_raw(const fs::path& file, const OpenOptions& options)
{
    if (options.raw_shape.voxels() == 0)
        refuse(file, "a raw file does not say its shape; state it in the settings (raw shape, sample type)");
    const VolumeInfo info{options.raw_shape, options.raw_sample, {}};
    auto reader = read_plain(file, file, info, options.raw_header, options.raw_big_endian);
    const auto needed = static_cast<std::uintmax_t>(options.raw_header + info.slice_bytes() * info.shape.nz);
    if (const auto size = fs::file_size(file); size != needed)
        refuse(file, fmt::format("the stated shape, type and header need {} bytes, the file has {}", needed, size));
    return reader;
}

PlainWriter::PlainWriter(fs::path path, const VolumeInfo& info, fs::path data, std::string header, bool header_in_data)
    : VolumeWriter(std::move(path), info),
      data_(std::move(data)),
      temporary_(temporary_beside(data_)),
      header_(std::move(header)),
      header_in_data_(header_in_data),
      file_(temporary_, RawFile::Mode::create)
{
    if (header_in_data_) file_.write_at(0, std::as_bytes(std::span(header_)));
}

PlainWriter::~PlainWriter()
{
    if (closed_) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
}

void PlainWriter::append(std::int64_t z, std::span<const std::byte> slice)
{
    const auto start = header_in_data_ ? static_cast<std::int64_t>(header_.size()) : 0;
    file_.write_at(start + z * info_.slice_bytes(), slice);
}

void PlainWriter::close()
{
    file_.close();
    std::error_code ignored;
    if (!header_in_data_ && !header_.empty()) fs::remove(path_, ignored);  // never an old header beside new values
    fs::rename(temporary_, data_);
    closed_ = true;
    if (header_in_data_ || header_.empty()) return;
    const fs::path part = temporary_beside(path_);
    {
        RawFile head(part, RawFile::Mode::create);
        head.write_at(0, std::as_bytes(std::span(header_)));
    }
    fs::rename(part, path_);
}

WriterPtr create_raw(const fs::path& file, const VolumeInfo& info)
{
    return std::make_unique<PlainWriter>(file, info, file, "", false);
}

bool gray_of_channels(std::span<const std::byte> pixels, std::int64_t channels, Sample sample,
                      std::span<std::byte> gray)
{
    const auto width = static_cast<std::size_t>(bytes_of(sample)), step = width * static_cast<std::size_t>(channels);
    assert(pixels.size() / step == gray.size() / width);
    const std::byte* from = pixels.data();
    for (std::size_t i = 0; i < gray.size(); i += width, from += step) {
        if (channels >= 3 &&
            (std::memcmp(from, from + width, width) != 0 || std::memcmp(from, from + 2 * width, width) != 0))
            return false;
        std::memcpy(gray.data() + i, from, width);
    }
    return true;
}

namespace {

ReaderPtr open_by_name(const fs::path& path, const OpenOptions& options)
{
    std::error_code error;
    const auto status = fs::status(path, error);
    if (!fs::exists(status)) refuse(path, "does not exist");
    if (fs::is_directory(status)) return open_slice_folder(path);
    const std::string extension = lower_extension(path);
    if (extension == ".mhd" || extension == ".mha") return open_metaimage(path);
    if (extension == ".tif" || extension == ".tiff") return open_tiff(path);
    if (extension == ".png") return open_png(path);
    if (extension == ".nrrd" || extension == ".nhdr") return open_nrrd(path);
    if (extension == ".h5" || extension == ".hdf5" || extension == ".hdf") return open_hdf5(path, options.dataset);
    if (extension == ".raw" || extension == ".bin" || extension == ".dat") return open_raw(path, options);
    refuse(path,
           "unknown kind of volume; needed a folder of slices or .tif, .tiff, .mhd, .mha, .nrrd, .nhdr, .h5, "
           ".hdf5, .raw, .bin, .png");
}

}  // namespace

ReaderPtr open_volume(const fs::path& path, const OpenOptions& options)
{
    ReaderPtr reader = open_by_name(path, options);
    if (reader->info().colour)
        notice(fmt::format("{}: stored in colour; read as gray, which needs red = green = blue", path.string()));
    return reader;
}

WriterPtr create_volume(const fs::path& path, const VolumeInfo& info)
{
    check_shape(path, info.shape);
    const std::string extension = lower_extension(path);
    std::error_code error;
    const fs::path folder = extension.empty() ? path : path.parent_path();
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) refuse(folder, fmt::format("the folder cannot be made ({})", error.message()));
    if (extension.empty()) return create_slice_folder(path, info);
    if (extension == ".mhd" || extension == ".mha") return create_metaimage(path, info);
    if (extension == ".tif" || extension == ".tiff") return create_tiff(path, info);
    if (extension == ".png") return create_png(path, info);
    if (extension == ".nrrd") return create_nrrd(path, info);
    if (extension == ".h5" || extension == ".hdf5") return create_hdf5(path, info);
    if (extension == ".raw" || extension == ".bin") return create_raw(path, info);
    refuse(path,
           "unknown kind of volume; needed .mhd, .mha, .tif, .tiff, .nrrd, .h5, .hdf5, .raw, .bin, .png or a "
           "folder name without extension");
}

bool natural_less(std::string_view a, std::string_view b)
{
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (digit(a[i]) && digit(b[j])) {
            const std::size_t from_a = std::min(a.find_first_not_of('0', i), a.size());
            const std::size_t from_b = std::min(b.find_first_not_of('0', j), b.size());
            std::size_t end_a = from_a, end_b = from_b;
            while (end_a < a.size() && digit(a[end_a])) ++end_a;
            while (end_b < b.size() && digit(b[end_b])) ++end_b;
            if (end_a - from_a != end_b - from_b) return end_a - from_a < end_b - from_b;
            if (const int order = a.substr(from_a, end_a - from_a).compare(b.substr(from_b, end_b - from_b));
                order != 0)
                return order < 0;
            i = end_a, j = end_b;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i, ++j;
        }
    }
    if ((i < a.size()) != (j < b.size())) return j < b.size();
    return a < b;
}

}  // namespace craze::io
