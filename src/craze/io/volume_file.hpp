// Volumes on disk, read and written slab by slab: nothing here holds more than a few slices.
//
// | read and written      | path                    | note                                                       |
// |-----------------------|-------------------------|------------------------------------------------------------|
// | MetaImage             | .mhd (+ .raw), .mha     | the rooms' own format; opens in ParaView, ITK, ImageJ      |
// | TIFF, BigTIFF         | .tif, .tiff             | multi-page; strips or tiles; none, LZW, deflate; any endian|
// | numbered slices       | a folder                | of .tif or .png, in natural order                          |
// | NRRD                  | .nrrd, .nhdr            | raw encoding                                               |
// | HDF5                  | .h5, .hdf5              | a dataset of 3 dimensions (z, y, x)                        |
// | raw                   | .raw, .bin              | shape, sample and byte order stated by the caller          |
// | PNG                   | .png                    | one slice                                                  |
//
// Colour pictures that are gray (R = G = B) are read as gray with a notice; real colour is refused.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/core/volume.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace craze::io {

/// Type of one voxel value.
enum class Sample { u8, u16, f32 };

constexpr std::int64_t bytes_of(Sample sample) { return sample == Sample::u8 ? 1 : sample == Sample::u16 ? 2 : 4; }
std::string_view name_of(Sample sample);

template <class T>
constexpr Sample sample_of()
{
    static_assert(std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t> || std::is_same_v<T, float>);
    return std::is_same_v<T, std::uint8_t> ? Sample::u8 : std::is_same_v<T, std::uint16_t> ? Sample::u16 : Sample::f32;
}

struct VolumeInfo {
    Shape shape;
    Sample sample = Sample::u8;
    Vec3 voxel_size;      ///< m, along x, y, z; 0 where the file does not say
    bool colour = false;  ///< stored as red, green, blue, read as gray where the three agree

    std::int64_t slice_bytes() const { return shape.nx * shape.ny * bytes_of(sample); }
};

/// A volume open for reading. Not for two threads at once.
class VolumeReader {
public:
    virtual ~VolumeReader() = default;
    VolumeReader(const VolumeReader&) = delete;
    VolumeReader& operator=(const VolumeReader&) = delete;

    const VolumeInfo& info() const { return info_; }
    /// Where it comes from, for messages.
    const std::filesystem::path& path() const { return path_; }
    /// Slice z, in this machine's byte order. `to` holds slice_bytes().
    /// @throws InvalidInput  naming the file, when it is truncated, damaged or not what it said it was
    void read_slice(std::int64_t z, std::span<std::byte> to);
    /// The same for values of the volume's own type.
    template <class T>
    void read_slice(std::int64_t z, std::span<T> to)
    {
        require(sample_of<T>());
        read_slice(z, std::as_writable_bytes(to));
    }
    /// @throws InvalidInput  when the volume's values are of another type
    void require(Sample sample) const;

protected:
    VolumeReader(std::filesystem::path path, VolumeInfo info) : path_(std::move(path)), info_(info) {}
    virtual void read(std::int64_t z, std::span<std::byte> to) = 0;

    std::filesystem::path path_;
    VolumeInfo info_;
};

/// What a path alone does not tell.
struct OpenOptions {
    std::string dataset;  ///< HDF5: path of the dataset; empty: the only one of 3 dimensions
    Shape raw_shape;      ///< raw: needed
    Sample raw_sample = Sample::u8;
    bool raw_big_endian = false;
    std::int64_t raw_header = 0;  ///< raw: bytes to skip
};

/// Opens a volume and checks its headers: sizes that agree with the file, slices that agree with each other.
/// @throws InvalidInput  naming the file and what is wrong with it
std::unique_ptr<VolumeReader> open_volume(const std::filesystem::path& path, const OpenOptions& options = {});

/// A volume being written, slice after slice. The file appears under its name when finish() returns, not before.
class VolumeWriter {
public:
    virtual ~VolumeWriter() = default;
    VolumeWriter(const VolumeWriter&) = delete;
    VolumeWriter& operator=(const VolumeWriter&) = delete;

    const VolumeInfo& info() const { return info_; }
    /// The next slice, slice_bytes() long.
    /// @throws InvalidInput  naming the file, when it cannot be written
    void append_slice(std::span<const std::byte> slice);
    template <class T>
    void append_slice(std::span<const T> slice)
    {
        append_slice(std::as_bytes(slice));
    }
    /// Call once, after shape.nz slices.
    void finish();

protected:
    VolumeWriter(std::filesystem::path path, VolumeInfo info) : path_(std::move(path)), info_(info) {}
    virtual void append(std::int64_t z, std::span<const std::byte> slice) = 0;
    virtual void close() = 0;

    std::filesystem::path path_;
    VolumeInfo info_;

private:
    std::int64_t written_ = 0;
};

/// Starts a file (or a folder of numbered slices, for a path without extension) of the format its name says.
/// TIFF is deflated and becomes BigTIFF by itself where it must.
std::unique_ptr<VolumeWriter> create_volume(const std::filesystem::path& path, const VolumeInfo& info);

/// A whole volume at once.
template <class T>
Volume<T> read_volume(VolumeReader& from)
{
    from.require(sample_of<T>());
    Volume<T> volume(from.info().shape);
    for (std::int64_t z = 0; z < from.info().shape.nz; ++z) from.read_slice(z, volume.slice(z));
    return volume;
}
template <class T>
Volume<T> read_volume(const std::filesystem::path& path)
{
    return read_volume<T>(*open_volume(path));
}
/// @param voxel_size  edge of a cubic voxel, m; 0 if not known
template <class T>
void write_volume(const std::filesystem::path& path, const Volume<T>& volume, double voxel_size = 0.0)
{
    const auto to = create_volume(path, {volume.shape(), sample_of<T>(), {voxel_size, voxel_size, voxel_size}});
    for (std::int64_t z = 0; z < volume.shape().nz; ++z) to->append_slice(volume.slice(z));
    to->finish();
}

/// Order in which people number things: "slice 2" before "slice 10".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace craze::io
