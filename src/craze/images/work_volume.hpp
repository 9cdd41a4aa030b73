// 8-bit volumes between the steps, on disk, and how far each step has come.

#pragma once

#include "craze/core/volume.hpp"
#include "craze/io/raw_file.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>

namespace craze::images {

/// Slices at their places in a plain file.
class WorkVolume {
public:
    WorkVolume(const std::filesystem::path& file, Shape shape) : file_(file, io::RawFile::Mode::update), shape_(shape)
    {
    }

    const Shape& shape() const { return shape_; }
    void read(std::int64_t z, std::span<std::uint8_t> to) const
    {
        file_.read_at(z * shape_.nx * shape_.ny, std::as_writable_bytes(to));
    }
    void write(std::int64_t z, std::span<const std::uint8_t> from)
    {
        file_.write_at(z * shape_.nx * shape_.ny, std::as_bytes(from));
    }
    void sync() { file_.sync(); }

private:
    io::RawFile file_;
    Shape shape_;
};

/// How many slices of each step lie on the disk, for a run that goes on where another stopped. The entries count only
/// for the same settings and source, which `key` stands for.
class Journal {
public:
    Journal(std::filesystem::path file, std::string key);
    double get(const std::string& entry) const;
    void set(const std::string& entry, double value);

private:
    std::filesystem::path file_;
    std::string key_;
    std::map<std::string, double> entries_;
};

}  // namespace craze::images
