// A dataset of three dimensions (z, y, x) in an HDF5 file.

#include "craze/io/volume_formats.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <cmath>
#include <utility>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

/// An HDF5 identifier and the call that gives it back.
class Id {
public:
    Id() = default;
    Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Id()
    {
        if (id_ >= 0) close_(id_);
    }
    Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Id& operator=(Id&& other) noexcept
    {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    operator hid_t() const { return id_; }
    bool good() const { return id_ >= 0; }

private:
    hid_t id_ = -1;
    herr_t (*close_)(hid_t) = nullptr;
};

// The library prints its error stack unless told not to.
void be_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

hid_t memory_type(Sample sample)
{
    return sample == Sample::u8 ? H5T_NATIVE_UINT8 : sample == Sample::u16 ? H5T_NATIVE_UINT16 : H5T_NATIVE_FLOAT;
}

constexpr const char* voxel_size_name = "element_size_um";  // z, y, x: as ilastik and others write it

herr_t collect(hid_t, const char* name, const H5O_info_t* info, void* all)
{
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(all)->emplace_back(name);
    return 0;
}

class Hdf5Reader final : public VolumeReader {
public:
    Hdf5Reader(const fs::path& file, const std::string& dataset) : VolumeReader(file, {})
    {
        be_quiet();
        file_ = Id(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
        if (!file_.good()) refuse(file, "truncated, damaged or not an HDF5 file");
        const std::string name = dataset.empty() ? only_volume() : dataset;
        data_ = Id(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
        if (!data_.good()) refuse(file, fmt::format("has no dataset \"{}\"", name));
        const Id space(H5Dget_space(data_), H5Sclose);
        std::array<hsize_t, 3> size{};
        if (H5Sget_simple_extent_ndims(space) != 3)
            refuse(file, fmt::format("dataset \"{}\": needed 3 dimensions (z, y, x)", name));
        H5Sget_simple_extent_dims(space, size.data(), nullptr);
        for (const hsize_t n : size)
            if (n > 1'000'000) refuse(file, fmt::format("dataset \"{}\" has an impossible size", name));
        info_.shape = {static_cast<std::int64_t>(size[2]), static_cast<std::int64_t>(size[1]),
                       static_cast<std::int64_t>(size[0])};
        check_shape(file, info_.shape);
        info_.sample = sample_of_data(name);
        find_voxel_size();
    }

private:
    std::string only_volume() const
    {
        std::vector<std::string> all, volumes;
        H5Ovisit1(file_, H5_INDEX_NAME, H5_ITER_INC, collect, &all);
        for (const std::string& name : all) {
            const Id data(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
            const Id space(H5Dget_space(data), H5Sclose);
            if (H5Sget_simple_extent_ndims(space) == 3) volumes.push_back(name);
        }
        if (volumes.size() != 1)
            refuse(path_, fmt::format("needed one dataset of 3 dimensions, found {}; name one of: {}", volumes.size(),
                                      fmt::join(all, ", ")));
        return volumes.front();
    }

    Sample sample_of_data(const std::string& name) const
    {
        const Id type(H5Dget_type(data_), H5Tclose);
        const auto size = H5Tget_size(type);
        const bool whole = H5Tget_class(type) == H5T_INTEGER && H5Tget_sign(type) == H5T_SGN_NONE;
        if (whole && size == 1) return Sample::u8;
        if (whole && size == 2) return Sample::u16;
        if (H5Tget_class(type) == H5T_FLOAT && size == 4) return Sample::f32;
        refuse(path_, fmt::format("dataset \"{}\": needed uint8, uint16 or float32 values", name));
    }

    void find_voxel_size()
    {
        if (H5Aexists(data_, voxel_size_name) <= 0) return;
        const Id attribute(H5Aopen(data_, voxel_size_name, H5P_DEFAULT), H5Aclose);
        const Id space(H5Aget_space(attribute), H5Sclose);
        std::array<double, 3> um{};
        if (H5Sget_simple_extent_npoints(space) != 3 || H5Aread(attribute, H5T_NATIVE_DOUBLE, um.data()) < 0) return;
        if (std::isfinite(um[0] + um[1] + um[2])) info_.voxel_size = {um[2] * 1e-6, um[1] * 1e-6, um[0] * 1e-6};
    }

    void read(std::int64_t z, std::span<std::byte> to) override
    {
        const std::array<hsize_t, 3> start{static_cast<hsize_t>(z), 0, 0},
            count{1, static_cast<hsize_t>(info_.shape.ny), static_cast<hsize_t>(info_.shape.nx)};
        const Id space(H5Dget_space(data_), H5Sclose), memory(H5Screate_simple(3, count.data(), nullptr), H5Sclose);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
        if (H5Dread(data_, memory_type(info_.sample), memory, space, H5P_DEFAULT, to.data()) < 0)
            refuse(path_, fmt::format("truncated or damaged: slice {} cannot be read", z));
    }

    Id file_, data_;
};

class Hdf5Writer final : public VolumeWriter {
public:
    Hdf5Writer(const fs::path& file, const VolumeInfo& info)
        : VolumeWriter(file, info), temporary_(temporary_beside(file))
    {
        be_quiet();
        file_ = Id(H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
        if (!file_.good()) refuse(file, "cannot be written; does the folder exist?");
        const std::array<hsize_t, 3> size{static_cast<hsize_t>(info.shape.nz), static_cast<hsize_t>(info.shape.ny),
                                          static_cast<hsize_t>(info.shape.nx)};
        const std::array<hsize_t, 3> chunk{1, size[1], size[2]};
        const Id space(H5Screate_simple(3, size.data(), nullptr), H5Sclose);
        const Id plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        H5Pset_obj_track_times(plan, false);  // the same content gives the same bytes, whenever it is written
        H5Pset_chunk(plan, 3, chunk.data());
        H5Pset_deflate(plan, 1);
        data_ =
            Id(H5Dcreate2(file_, "volume", memory_type(info.sample), space, H5P_DEFAULT, plan, H5P_DEFAULT), H5Dclose);
        if (!data_.good()) refuse(file, "cannot be written");
        const hsize_t three = 3;
        const Id line(H5Screate_simple(1, &three, nullptr), H5Sclose);
        const Id attribute(H5Acreate2(data_, voxel_size_name, H5T_NATIVE_DOUBLE, line, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
        const std::array<double, 3> um{info.voxel_size.z * 1e6, info.voxel_size.y * 1e6, info.voxel_size.x * 1e6};
        H5Awrite(attribute, H5T_NATIVE_DOUBLE, um.data());
    }
    ~Hdf5Writer() override
    {
        if (!file_.good()) return;
        close_all();
        std::error_code ignored;
        fs::remove(temporary_, ignored);
    }

private:
    void close_all()
    {
        data_ = Id();
        file_ = Id();
    }

    void append(std::int64_t z, std::span<const std::byte> slice) override
    {
        const std::array<hsize_t, 3> start{static_cast<hsize_t>(z), 0, 0},
            count{1, static_cast<hsize_t>(info_.shape.ny), static_cast<hsize_t>(info_.shape.nx)};
        const Id space(H5Dget_space(data_), H5Sclose), memory(H5Screate_simple(3, count.data(), nullptr), H5Sclose);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
        if (H5Dwrite(data_, memory_type(info_.sample), memory, space, H5P_DEFAULT, slice.data()) < 0)
            refuse(path_, "cannot be written; is the disk full?");
    }

    void close() override
    {
        if (H5Fflush(file_, H5F_SCOPE_LOCAL) < 0) refuse(path_, "cannot be written; is the disk full?");
        close_all();
        fs::rename(temporary_, path_);
    }

    fs::path temporary_;
    Id file_, data_;
};

}  // namespace

ReaderPtr open_hdf5(const fs::path& file, const std::string& dataset)
{
    return std::make_unique<Hdf5Reader>(file, dataset);
}

WriterPtr create_hdf5(const fs::path& file, const VolumeInfo& info) { return std::make_unique<Hdf5Writer>(file, info); }

}  // namespace craze::io
