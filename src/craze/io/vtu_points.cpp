#include "craze/core/errors.hpp"
#include "craze/io/vtu_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

namespace craze::io {

namespace {

[[noreturn]] void not_ours(const std::filesystem::path& file, std::string_view why)
{
    throw InvalidInput(fmt::format("{}: {}; only files that craze wrote are read", file.string(), why));
}

/// Where the array of that name begins in the file's bytes: after its size.
std::span<const char> appended_array(const std::string& bytes, const std::string& name,
                                     const std::filesystem::path& file)
{
    const auto head = bytes.find("<AppendedData encoding=\"raw\">\n_");
    const auto tag = bytes.find(fmt::format("Name=\"{}\"", name));
    if (head == std::string::npos || tag == std::string::npos || tag > head)
        not_ours(file, fmt::format("no array \"{}\"", name));
    const auto offset = bytes.find("offset=\"", tag);
    if (offset == std::string::npos || offset > head) not_ours(file, fmt::format("\"{}\" has no offset", name));
    const std::size_t begin = bytes.find('_', head) + 1 + std::strtoull(bytes.c_str() + offset + 8, nullptr, 10);
    std::uint64_t size = 0;
    if (begin + sizeof size > bytes.size()) not_ours(file, "cut short");
    std::memcpy(&size, bytes.data() + begin, sizeof size);
    if (size > bytes.size() - begin - sizeof size) not_ours(file, "cut short");
    return {bytes.data() + begin + sizeof size, size};
}

template <class T>
std::vector<T> numbers(std::span<const char> bytes)
{
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

}  // namespace

VtuPoints read_vtu_points(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InvalidInput(fmt::format("{}: cannot be opened", file.string()));
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    VtuPoints out{numbers<double>(appended_array(bytes, "Points", file)),
                  numbers<float>(appended_array(bytes, "radius", file)),
                  numbers<float>(appended_array(bytes, "displacement", file))};
    if (out.points.size() != 3 * out.radius.size() || out.displacement.size() != out.points.size())
        not_ours(file, "its arrays do not fit each other");
    return out;
}

}  // namespace craze::io
