// Arrays by name in an HDF5 file, whole at a time.

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace craze::io {

/// T is std::uint8_t, std::int32_t, std::int64_t or double. Names are paths ("/VTKHDF/Points"); missing groups are
/// made.
class Hdf5File {
public:
    /// @throws InvalidInput  when it cannot be made, naming the file
    static Hdf5File create(const std::filesystem::path& file);
    /// @throws InvalidInput  when it is missing or no HDF5 file
    static Hdf5File open(const std::filesystem::path& file);
    Hdf5File(Hdf5File&&) noexcept;
    ~Hdf5File();

    /// An array of shape (n / columns, columns), or (n,) with one column.
    template <class T>
    void write(const std::string& name, std::span<const T> values, std::int64_t columns = 1);
    template <class T>
    void write(const std::string& name, const std::vector<T>& values, std::int64_t columns = 1)
    {
        write(name, std::span<const T>(values), columns);
    }
    void attribute(const std::string& group, const std::string& name, std::span<const std::int64_t> values);
    void attribute(const std::string& group, const std::string& name, std::string_view ascii);

    bool has(const std::string& name) const;
    /// All values of an array, converted to T.
    /// @throws InvalidInput  when it is missing or damaged, naming file and array
    template <class T>
    std::vector<T> read(const std::string& name) const;
    std::string text_attribute(const std::string& group, const std::string& name) const;

private:
    struct Handle;
    explicit Hdf5File(std::unique_ptr<Handle> handle);
    std::unique_ptr<Handle> handle_;
};

}  // namespace craze::io
