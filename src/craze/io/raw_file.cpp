#include "craze/io/raw_file.hpp"

#include "craze/core/errors.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace craze::io {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, std::string_view what)
{
    throw InvalidInput(fmt::format("{}: {} ({})", file.string(), what, std::strerror(errno)));
}

}  // namespace

RawFile::RawFile(const std::filesystem::path& file, Mode mode) : path_(file)
{
    const int flags = mode == Mode::read ? O_RDONLY : O_RDWR | O_CREAT | (mode == Mode::create ? O_TRUNC : 0);
    handle_ = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
    if (handle_ < 0) fail(file, mode == Mode::read ? "cannot be opened" : "cannot be written");
    struct stat status {};
    if (fstat(handle_, &status) == 0 && S_ISREG(status.st_mode)) return;
    ::close(std::exchange(handle_, -1));
    throw InvalidInput(fmt::format("{}: needed a file, got something else (a folder or a device?)", file.string()));
}

RawFile::~RawFile() { close(); }

RawFile::RawFile(RawFile&& other) noexcept : path_(std::move(other.path_)), handle_(std::exchange(other.handle_, -1)) {}

RawFile& RawFile::operator=(RawFile&& other) noexcept
{
    std::swap(path_, other.path_);
    std::swap(handle_, other.handle_);
    return *this;
}

std::int64_t RawFile::size() const
{
    struct stat status {};
    if (fstat(handle_, &status) != 0) fail(path_, "its size cannot be read");
    return status.st_size;
}

void RawFile::read_at(std::int64_t offset, std::span<std::byte> to) const
{
    while (!to.empty()) {
        const ssize_t got = ::pread(handle_, to.data(), to.size(), offset);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(path_, "cannot be read");
        if (got == 0)
            throw InvalidInput(
                fmt::format("{}: truncated; {} bytes are missing at byte {}", path_.string(), to.size(), offset));
        offset += got;
        to = to.subspan(static_cast<std::size_t>(got));
    }
}

void RawFile::write_at(std::int64_t offset, std::span<const std::byte> from)
{
    while (!from.empty()) {
        const ssize_t put = ::pwrite(handle_, from.data(), from.size(), offset);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) fail(path_, "cannot be written; is the disk full?");
        offset += put;
        from = from.subspan(static_cast<std::size_t>(put));
    }
}

void RawFile::sync()
{
    if (fdatasync(handle_) != 0) fail(path_, "cannot be written to the disk");
}

void RawFile::close()
{
    if (handle_ >= 0) ::close(std::exchange(handle_, -1));
}

}  // namespace craze::io
