// What the rooms left on disk, read with patience: a missing file is no error here.

#pragma once

#include "craze/core/json.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace craze::report {

/// Columns of a CSV with one line of names; lines that start with # are skipped.
struct CsvColumns {
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> text;  ///< as written, one vector per column, all of the same length

    std::size_t rows() const { return text.empty() ? 0 : text.front().size(); }
    bool has(std::string_view name) const;
    /// Numbers of a column; what is not a number is NaN. Empty if there is no such column.
    std::vector<double> numbers(std::string_view name) const;
    std::vector<double> numbers(std::size_t column) const;
    const std::vector<std::string>& words(std::string_view name) const;
};
CsvColumns parse_csv(std::string_view text);

/// An output folder of a run.
class OutputFolder {
public:
    /// @throws InvalidInput  when `root` is not a folder
    explicit OutputFolder(std::filesystem::path root);

    const std::filesystem::path& root() const { return root_; }
    std::filesystem::path room(std::string_view name) const { return root_ / name; }
    bool has(std::string_view room_name) const;

    /// <out>/run.json; null where there is none.
    const Json& run() const { return run_; }
    /// <out>/<room>/summary.json; null where there is none.
    const Json& summary(std::string_view room_name) const;

    /// A CSV of a room; nothing where there is none or it holds no rows.
    std::optional<CsvColumns> csv(std::string_view room_name, std::string_view file) const;

private:
    std::filesystem::path root_;
    Json run_;
    std::vector<std::pair<std::string, Json>> summaries_;
};

/// The value at "porosity.total"; null where there is none.
const Json& find(const Json& json, std::string_view dotted);
/// The number at the first of `keys` that is there; NaN where none is.
double find_number(const Json& json, std::initializer_list<std::string_view> keys);

/// A JSON file; null (with a notice) where it is missing or cannot be understood.
Json read_json(const std::filesystem::path& file);

}  // namespace craze::report
