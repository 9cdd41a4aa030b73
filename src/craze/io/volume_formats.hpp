// The formats behind volume_file.hpp, and what they share. For `io` only.

#pragma once

#include "craze/io/volume_file.hpp"

#include "craze/io/raw_file.hpp"

#include <vector>

namespace craze::io {

using ReaderPtr = std::unique_ptr<VolumeReader>;
using WriterPtr = std::unique_ptr<VolumeWriter>;

ReaderPtr open_metaimage(const std::filesystem::path& file);
ReaderPtr open_nrrd(const std::filesystem::path& file);
ReaderPtr open_tiff(const std::filesystem::path& file);
ReaderPtr open_png(const std::filesystem::path& file);
ReaderPtr open_hdf5(const std::filesystem::path& file, const std::string& dataset);
ReaderPtr open_slice_folder(const std::filesystem::path& folder);
ReaderPtr open_raw(const std::filesystem::path& file, const OpenOptions& options);

WriterPtr create_metaimage(const std::filesystem::path& file, const VolumeInfo& info);
WriterPtr create_nrrd(const std::filesystem::path& file, const VolumeInfo& info);
WriterPtr create_raw(const std::filesystem::path& file, const VolumeInfo& info);
WriterPtr create_tiff(const std::filesystem::path& file, const VolumeInfo& info);
WriterPtr create_png(const std::filesystem::path& file, const VolumeInfo& info);
WriterPtr create_hdf5(const std::filesystem::path& file, const VolumeInfo& info);
WriterPtr create_slice_folder(const std::filesystem::path& folder, const VolumeInfo& info);

/// "FILE: what"
[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view what);

/// Name of a file being written.
std::filesystem::path temporary_beside(const std::filesystem::path& file);

/// Sizes that a microscope's stack can have; anything else is a damaged header.
/// @throws InvalidInput
void check_shape(const std::filesystem::path& file, const Shape& shape);

/// Bytes to this machine's order.
void swap_bytes(std::span<std::byte> values, Sample sample);

/// Slices of values that lie one after the other in a file, from `offset` on.
ReaderPtr read_plain(const std::filesystem::path& path, const std::filesystem::path& data, const VolumeInfo& info,
                     std::int64_t offset, bool big_endian);

/// What a format that ends in plain values needs: `header` before them in the same file (empty: in a file of their
/// own).
class PlainWriter : public VolumeWriter {
public:
    PlainWriter(std::filesystem::path path, const VolumeInfo& info, std::filesystem::path data, std::string header,
                bool header_in_data);
    ~PlainWriter() override;

protected:
    void append(std::int64_t z, std::span<const std::byte> slice) override;
    void close() override;

private:
    std::filesystem::path data_, temporary_;
    std::string header_;
    bool header_in_data_;
    RawFile file_;
    bool closed_ = false;
};

/// One picture of a stack: the values of pages or files that hold a single slice.
/// Interleaved channels become gray: 1 or 2 (gray, alpha) as they are, 3 or 4 only where R = G = B.
/// @returns false if the picture has real colour
bool gray_of_channels(std::span<const std::byte> pixels, std::int64_t channels, Sample sample,
                      std::span<std::byte> gray);

}  // namespace craze::io
