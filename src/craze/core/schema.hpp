// Settings described once, for everything that needs them: reading, checking, writing, manuals, content hashes.
//
// Each room has a plain struct of its settings with defaults and one function
//
//     void describe(Schema& schema, images::Settings& s)
//     {
//         schema.quantity("voxel_size", s.voxel_size, Dimension::length, {1e-10, 1e-2}, "edge of a voxel");
//         schema.group("denoise", "non-local means, section 2.3 (3)", [&] {
//             schema.integer("search", s.denoise.search, {3, 63}, "search window, odd"); });
//     }
//
// Keys are snake_case. Meanings are one line, lower case, no full stop. Ranges are inclusive.

#pragma once

#include "craze/core/units.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace craze {

struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
};

/// What a settings struct is shown to. Implementations read TOML, write TOML or JSON, or print the manual.
class Schema {
public:
    virtual ~Schema() = default;

    /// A number with a unit (or a plain number or percentage, by dimension).
    virtual void quantity(std::string_view key, double& value, Dimension, Range, std::string_view meaning) = 0;
    /// The same, where "auto" (no value) is allowed; `meaning` says what auto does.
    virtual void quantity(std::string_view key, std::optional<double>& value, Dimension, Range,
                          std::string_view meaning) = 0;
    virtual void quantities(std::string_view key, std::vector<double>& values, Dimension, Range,
                            std::string_view meaning) = 0;
    virtual void integer(std::string_view key, std::int64_t& value, Range, std::string_view meaning) = 0;
    virtual void integers(std::string_view key, std::vector<std::int64_t>& values, Range, std::string_view meaning) = 0;
    virtual void flag(std::string_view key, bool& value, std::string_view meaning) = 0;
    virtual void text(std::string_view key, std::string& value, std::string_view meaning) = 0;
    virtual void texts(std::string_view key, std::vector<std::string>& values, std::string_view meaning) = 0;
    /// A file or folder; a relative one is taken from where the settings file lies. Its existence is checked by the
    /// room's own check.
    virtual void path(std::string_view key, std::string& value, std::string_view meaning) = 0;
    /// One of `names`; `value` is the index into it.
    virtual void choice(std::string_view key, int& value, const std::vector<std::string>& names,
                        std::string_view meaning) = 0;
    /// A subsection.
    virtual void group(std::string_view key, std::string_view meaning, const std::function<void()>& describe) = 0;
    /// A list of subsections ([[...]] in TOML). `resize(n)` makes room, `item(i)` describes the i-th.
    virtual void list(std::string_view key, std::size_t size, std::string_view meaning,
                      const std::function<void(std::size_t)>& resize, const std::function<void(std::size_t)>& item) = 0;

    void number(std::string_view key, double& value, Range range, std::string_view meaning)
    {
        quantity(key, value, Dimension::pure, range, meaning);
    }
    /// A choice kept as an enum whose values are 0, 1, 2, ... in the order of `names`.
    template <class Enum>
    void option(std::string_view key, Enum& value, const std::vector<std::string>& names, std::string_view meaning)
    {
        int index = static_cast<int>(value);
        choice(key, index, names, meaning);
        value = static_cast<Enum>(index);
    }
    template <class Item>
    void items(std::string_view key, std::vector<Item>& values, std::string_view meaning)
    {
        list(
            key, values.size(), meaning, [&](std::size_t n) { values.resize(n); },
            [&](std::size_t i) { describe(*this, values[i]); });
    }
};

}  // namespace craze
