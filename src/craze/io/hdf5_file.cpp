#include "craze/io/hdf5_file.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <type_traits>
#include <utility>

namespace craze::io {

namespace fs = std::filesystem;

namespace {

/// An HDF5 identifier, closed with its owner.
class Owned {
public:
    Owned(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Owned()
    {
        if (id_ >= 0) close_(id_);
    }
    Owned(const Owned&) = delete;
    Owned& operator=(const Owned&) = delete;
    operator hid_t() const { return id_; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

template <class T>
hid_t type_of()
{
    if constexpr (std::is_same_v<T, std::uint8_t>)
        return H5T_NATIVE_UINT8;
    else if constexpr (std::is_same_v<T, std::int32_t>)
        return H5T_NATIVE_INT32;
    else if constexpr (std::is_same_v<T, std::int64_t>)
        return H5T_NATIVE_INT64;
    else
        return H5T_NATIVE_DOUBLE;
}

}  // namespace

struct Hdf5File::Handle {
    fs::path path;
    hid_t file = -1;
    ~Handle()
    {
        if (file >= 0) H5Fclose(file);
    }
    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InvalidInput(fmt::format("{}: {}", path.string(), why));
    }
    void must(bool good, const std::string& name) const
    {
        if (!good) refuse(fmt::format("\"{}\" cannot be written; is the disk full?", name));
    }
};

Hdf5File::Hdf5File(std::unique_ptr<Handle> handle) : handle_(std::move(handle)) {}
Hdf5File::Hdf5File(Hdf5File&&) noexcept = default;
Hdf5File::~Hdf5File() = default;

Hdf5File Hdf5File::create(const fs::path& file)
{
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    auto handle = std::make_unique<Handle>();
    handle->path = file;
    handle->file = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (handle->file < 0) handle->refuse("cannot be written; is the disk full or the folder read-only?");
    return Hdf5File(std::move(handle));
}

Hdf5File Hdf5File::open(const fs::path& file)
{
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    auto handle = std::make_unique<Handle>();
    handle->path = file;
    if (!fs::exists(file)) handle->refuse("not found");
    handle->file = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (handle->file < 0) handle->refuse("truncated, damaged or not an HDF5 file");
    return Hdf5File(std::move(handle));
}

template <class T>
void Hdf5File::write(const std::string& name, std::span<const T> values, std::int64_t columns)
{
    const std::array<hsize_t, 2> shape{values.size() / static_cast<std::size_t>(columns),
                                       static_cast<hsize_t>(columns)};
    const Owned space(H5Screate_simple(columns == 1 ? 1 : 2, shape.data(), nullptr), H5Sclose);
    const Owned links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    const Owned plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(plan, false);  // the same content gives the same bytes, whenever it is written
    const Owned data(H5Dcreate2(handle_->file, name.c_str(), type_of<T>(), space, links, plan, H5P_DEFAULT), H5Dclose);
    handle_->must(data >= 0, name);
    if (!values.empty())
        handle_->must(H5Dwrite(data, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, name);
}

void Hdf5File::attribute(const std::string& group, const std::string& name, std::span<const std::int64_t> values)
{
    const Owned links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    if (!has(group)) H5Gclose(H5Gcreate2(handle_->file, group.c_str(), links, H5P_DEFAULT, H5P_DEFAULT));
    const hsize_t size = values.size();
    const Owned space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Owned made(H5Acreate_by_name(handle_->file, group.c_str(), name.c_str(), H5T_NATIVE_INT64, space, H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
    handle_->must(made >= 0 && H5Awrite(made, H5T_NATIVE_INT64, values.data()) >= 0, name);
}

void Hdf5File::attribute(const std::string& group, const std::string& name, std::string_view ascii)
{
    const Owned type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, ascii.size());
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    const Owned space(H5Screate(H5S_SCALAR), H5Sclose);
    const Owned made(H5Acreate_by_name(handle_->file, group.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
    handle_->must(made >= 0 && H5Awrite(made, type, ascii.data()) >= 0, name);
}

bool Hdf5File::has(const std::string& name) const
{
    // Every group on the way must be asked for, or the library complains.
    for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
        if (H5Lexists(handle_->file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
        if (slash == std::string::npos) return true;
    }
}

template <class T>
std::vector<T> Hdf5File::read(const std::string& name) const
{
    if (!has(name)) handle_->refuse(fmt::format("has no array \"{}\"", name));
    const Owned data(H5Dopen2(handle_->file, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (data < 0) handle_->refuse(fmt::format("\"{}\" is no array", name));
    const Owned space(H5Dget_space(data), H5Sclose);
    const hssize_t size = H5Sget_simple_extent_npoints(space);
    if (size < 0) handle_->refuse(fmt::format("\"{}\" is damaged", name));
    std::vector<T> values(static_cast<std::size_t>(size));
    if (size > 0 && H5Dread(data, type_of<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
        handle_->refuse(fmt::format("\"{}\" is damaged", name));
    return values;
}

std::string Hdf5File::text_attribute(const std::string& group, const std::string& name) const
{
    const Owned made(H5Aopen_by_name(handle_->file, group.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (made < 0) return {};
    const Owned type(H5Aget_type(made), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return {};
    std::string text(H5Tget_size(type), '\0');
    if (H5Aread(made, type, text.data()) < 0) return {};
    return text.substr(0, text.find('\0'));
}

#define CRAZE_HDF5_TYPE(T)                                                                  \
    template void Hdf5File::write<T>(const std::string&, std::span<const T>, std::int64_t); \
    template std::vector<T> Hdf5File::read<T>(const std::string&) const;
CRAZE_HDF5_TYPE(std::uint8_t)
CRAZE_HDF5_TYPE(std::int32_t)
CRAZE_HDF5_TYPE(std::int64_t)
CRAZE_HDF5_TYPE(double)

}  // namespace craze::io
