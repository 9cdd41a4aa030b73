// Content hashes: has anything changed since the last run?

#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace craze {

/// 128 bits of XXH3 over all that was added, as 32 hexadecimal digits.
class Hash {
public:
    Hash();
    ~Hash();
    Hash(const Hash&) = delete;
    Hash& operator=(const Hash&) = delete;

    Hash& add(std::span<const std::byte> bytes);
    Hash& add(std::string_view text);
    template <class T>
    Hash& add(std::span<const T> values)
    {
        return add(std::as_bytes(values));
    }
    /// The bytes of a file, or of every file of a folder with its name, in natural order.
    /// @throws InvalidInput  when it cannot be read
    Hash& add_file(const std::filesystem::path& file);
    std::string digest() const;

private:
    struct XxhState;
    XxhState* state_;
};

}  // namespace craze
