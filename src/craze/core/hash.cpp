#include "craze/core/hash.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <fstream>
#include <vector>

namespace craze {

struct Hash::XxhState {
    XXH3_state_t* xxh = XXH3_createState();
};

Hash::Hash() : state_(new XxhState) { XXH3_128bits_reset(state_->xxh); }

Hash::~Hash()
{
    XXH3_freeState(state_->xxh);
    delete state_;
}

Hash& Hash::add(std::span<const std::byte> bytes)
{
    XXH3_128bits_update(state_->xxh, bytes.data(), bytes.size());
    return *this;
}

Hash& Hash::add(std::string_view text)
{
    const auto length = static_cast<std::uint64_t>(text.size());  // so that "ab","c" is not "a","bc"
    add(std::as_bytes(std::span(&length, 1)));
    return add(std::as_bytes(std::span(text)));
}

Hash& Hash::add_file(const std::filesystem::path& file)
{
    if (std::filesystem::is_directory(file)) {
        std::vector<std::filesystem::path> inside;
        for (const auto& entry : std::filesystem::directory_iterator(file))
            if (entry.is_regular_file()) inside.push_back(entry.path());
        std::sort(inside.begin(), inside.end());
        for (const auto& one : inside) add(one.filename().string()).add_file(one);
        return *this;
    }
    std::ifstream in(file, std::ios::binary);
    if (!in) throw InvalidInput(fmt::format("{}: cannot be read", file.string()));
    std::vector<char> buffer(std::size_t{1} << 20U);
    while (in) {
        in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        add(std::as_bytes(std::span(buffer.data(), static_cast<std::size_t>(in.gcount()))));
    }
    return *this;
}

std::string Hash::digest() const
{
    const XXH128_hash_t h = XXH3_128bits_digest(state_->xxh);
    return fmt::format("{:016x}{:016x}", h.high64, h.low64);
}

}  // namespace craze
