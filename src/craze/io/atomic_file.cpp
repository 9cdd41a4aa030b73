#include "craze/io/atomic_file.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

namespace craze::io {

namespace fs = std::filesystem;

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write)
{
    if (file.has_parent_path()) {
        std::error_code error;
        fs::create_directories(file.parent_path(), error);
        if (error)
            throw InvalidInput(
                fmt::format("{}: the folder cannot be made ({})", file.parent_path().string(), error.message()));
    }
    // The extension stays last: some libraries choose the format by it.
    const fs::path temporary =
        file.parent_path() / fmt::format(".{}.{}.part{}", file.stem().string(), getpid(), file.extension().string());
    try {
        write(temporary);
        fs::rename(temporary, file);
    } catch (...) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
    }
}

void write_text(const fs::path& file, std::string_view text)
{
    write_atomically(file, [&](const fs::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        out.close();
        if (!out)
            throw InvalidInput(
                fmt::format("{}: cannot be written; is the disk full or the folder read-only?", file.string()));
    });
}

std::string read_text(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in || fs::is_directory(file)) throw InvalidInput(fmt::format("{}: cannot be read", file.string()));
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace craze::io
