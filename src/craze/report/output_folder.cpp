#include "craze/report/output_folder.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace craze::report {

namespace fs = std::filesystem;

namespace {

/// Fields of one record starting at `at`, which moves behind its end of line (RFC 4180 quotes).
std::vector<std::string> record(std::string_view text, std::size_t& at)
{
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (; at < text.size(); ++at) {
        const char c = text[at];
        if (quoted) {
            if (c != '"')
                fields.back() += c;
            else if (at + 1 < text.size() && text[at + 1] == '"')
                fields.back() += text[++at];
            else
                quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == ',') {
            fields.emplace_back();
        } else if (c == '\n') {
            ++at;
            break;
        } else if (c != '\r') {
            fields.back() += c;
        }
    }
    for (auto& f : fields) {
        const auto first = f.find_first_not_of(' ');
        f = first == std::string::npos ? std::string() : f.substr(first, f.find_last_not_of(' ') - first + 1);
    }
    return fields;
}

double number(const std::string& text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

CsvColumns parse_csv(std::string_view text)
{
    CsvColumns out;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == '#') {
            at = std::min(text.find('\n', at), text.size() - 1) + 1;
            continue;
        }
        auto fields = record(text, at);
        if (fields.size() == 1 && fields[0].empty()) continue;
        if (out.names.empty()) {
            out.names = std::move(fields);
            out.text.resize(out.names.size());
            continue;
        }
        fields.resize(out.names.size());
        for (std::size_t c = 0; c < fields.size(); ++c) out.text[c].push_back(std::move(fields[c]));
    }
    return out;
}

bool CsvColumns::has(std::string_view name) const { return std::find(names.begin(), names.end(), name) != names.end(); }

std::vector<double> CsvColumns::numbers(std::size_t column) const
{
    std::vector<double> out;
    if (column >= text.size()) return out;
    out.reserve(rows());
    for (const auto& field : text[column]) out.push_back(number(field));
    return out;
}

std::vector<double> CsvColumns::numbers(std::string_view name) const
{
    return numbers(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
}

const std::vector<std::string>& CsvColumns::words(std::string_view name) const
{
    static const std::vector<std::string> none;
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    return at < text.size() ? text[at] : none;
}

OutputFolder::OutputFolder(fs::path root) : root_(std::move(root))
{
    if (!fs::is_directory(root_))
        throw InvalidInput(fmt::format("report: {} is not a folder; give the output folder of a run", root_.string()));
    if (fs::exists(root_ / "run.json")) run_ = read_json(root_ / "run.json");
    std::vector<fs::path> rooms;
    for (const auto& entry : fs::directory_iterator(root_))
        if (entry.is_directory() && fs::exists(entry.path() / "summary.json")) rooms.push_back(entry.path());
    std::sort(rooms.begin(), rooms.end());
    for (const auto& room : rooms) summaries_.emplace_back(room.filename().string(), read_json(room / "summary.json"));
}

bool OutputFolder::has(std::string_view room_name) const { return !summary(room_name).is_null(); }

const Json& OutputFolder::summary(std::string_view room_name) const
{
    static const Json none;
    for (const auto& [name, json] : summaries_)
        if (name == room_name) return json;
    return none;
}

std::optional<CsvColumns> OutputFolder::csv(std::string_view room_name, std::string_view file) const
{
    const auto path = room(room_name) / file;
    if (!fs::is_regular_file(path)) return std::nullopt;
    auto columns = parse_csv(io::read_text(path));
    if (columns.rows() == 0) return std::nullopt;
    return columns;
}

const Json& find(const Json& json, std::string_view dotted)
{
    static const Json none;
    const Json* at = &json;
    while (!dotted.empty()) {
        const auto dot = dotted.find('.');
        const std::string key(dotted.substr(0, dot));
        if (!at->is_object() || !at->contains(key)) return none;
        at = &(*at)[key];
        dotted = dot == std::string_view::npos ? std::string_view() : dotted.substr(dot + 1);
    }
    return *at;
}

double find_number(const Json& json, std::initializer_list<std::string_view> keys)
{
    for (const auto key : keys)
        if (const Json& value = find(json, key); value.is_number()) return value.get<double>();
    return std::numeric_limits<double>::quiet_NaN();
}

Json read_json(const fs::path& file)
{
    try {
        return Json::parse(io::read_text(file));
    } catch (const std::exception& error) {
        notice(fmt::format("report: {} is left out: {}", file.string(), error.what()));
        return nullptr;
    }
}

}  // namespace craze::report
