#include "craze/report/html.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cmath>

namespace craze::report {

namespace {

bool numeric(std::string_view cell)
{
    return !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell[0])) || cell[0] == '-' || cell[0] == '+');
}

std::string replaced(std::string text, std::string_view what, std::string_view with)
{
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

std::string scalar(const Json& value)
{
    if (value.is_string()) return escape(value.get<std::string>());
    if (value.is_number_float()) return format_number(value.get<double>(), 6);
    if (value.is_number()) return format_number(value.get<double>(), 15);
    return escape(value.dump());
}

void flatten(const Json& value, const std::string& key, Table& table)
{
    constexpr std::size_t shown = 8;
    if (value.is_object()) {
        for (const auto& [name, item] : value.items()) flatten(item, key.empty() ? name : key + "." + name, table);
    } else if (value.is_array()) {
        const bool plain = std::none_of(value.begin(), value.end(), [](const Json& v) { return v.is_structured(); });
        if (!plain && value.size() <= shown) {
            for (std::size_t i = 0; i < value.size(); ++i) flatten(value[i], fmt::format("{}[{}]", key, i), table);
            return;
        }
        std::string cell;
        for (std::size_t i = 0; plain && i < std::min(shown, value.size()); ++i)
            cell += (i ? ", " : "") + scalar(value[i]);
        if (value.size() > shown || !plain)
            cell += fmt::format("{}({} items)", cell.empty() ? "" : ", … ", value.size());
        table.rows.push_back({escape(key), cell});
    } else {
        table.rows.push_back({escape(key), scalar(value)});
    }
}

}  // namespace

std::string escape(std::string_view text)
{
    std::string out;
    out.reserve(text.size());
    for (const char c : text) switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            case '\'': out += "&#39;"; break;
            default: out += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
        }
    return out;
}

std::string base64(std::span<const std::byte> bytes)
{
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return k < bytes.size() ? std::to_integer<unsigned>(bytes[k]) : 0U; };
        const unsigned word = at(i) << 16U | at(i + 1) << 8U | at(i + 2);
        out += digits[word >> 18U];
        out += digits[word >> 12U & 63U];
        out += i + 1 < bytes.size() ? digits[word >> 6U & 63U] : '=';
        out += i + 2 < bytes.size() ? digits[word & 63U] : '=';
    }
    return out;
}

std::string base64(std::string_view bytes) { return base64(std::as_bytes(std::span(bytes))); }

std::vector<std::byte> deflated(std::span<const std::byte> bytes)
{
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<std::byte> out(size);
    const int code = compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 7);
    if (code != Z_OK) throw ComputationFailed(fmt::format("report: zlib could not compress {} bytes", bytes.size()));
    out.resize(size);
    return out;
}

std::string script_json(const Json& json)
{
    const auto text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return replaced(replaced(text, "</", "<\\/"), "<!--", "\\u003c!--");
}

std::string data_uri(std::string_view type, std::span<const std::byte> bytes)
{
    return fmt::format("data:{};base64,{}", type, base64(bytes));
}

std::string data_uri(std::string_view type, std::string_view bytes)
{
    return data_uri(type, std::as_bytes(std::span(bytes)));
}

std::string html(const Table& table)
{
    std::string out = fmt::format("<div class=\"wide\"><table class=\"{}\">", escape(table.kind));
    if (!table.head.empty()) {
        out += "<thead><tr>";
        for (const auto& cell : table.head) out += "<th>" + cell + "</th>";
        out += "</tr></thead>";
    }
    out += "<tbody>";
    for (const auto& row : table.rows) {
        out += "<tr>";
        for (std::size_t i = 0; i < row.size(); ++i)
            out += i == 0 ? "<th scope=\"row\">" + row[i] + "</th>"
                          : fmt::format("<td{}>{}</td>", numeric(row[i]) ? " class=\"n\"" : "", row[i]);
        out += "</tr>";
    }
    return out + "</tbody></table></div>\n";
}

std::string format_seconds(double seconds)
{
    if (!(seconds >= 0.0)) return "?";
    if (seconds < 10.0) return fmt::format("{:.2g} s", seconds);
    if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
    const auto whole = static_cast<std::int64_t>(std::llround(seconds));
    if (whole < 7200) return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string format_number(double value, int digits)
{
    if (!std::isfinite(value)) return std::isnan(value) ? "–" : value > 0 ? "∞" : "−∞";
    std::string text = fmt::format("{:.{}g}", value, digits);
    if (text.find('e') != std::string::npos && std::abs(value) >= 1.0 && std::abs(value) < 1e15)
        text = fmt::format("{:.0f}", value);
    if (text.find_first_of("e.") != std::string::npos) return text;
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool first = i == 0 || text[i - 1] == '-';
        if (!first && text[i] != '-' && (text.size() - i) % 3 == 0) out += "\u00a0";
        out += text[i];
    }
    return out;
}

std::string summary_table(const Json& json)
{
    Table table{{"key", "value"}, {}, "summary"};
    flatten(json, "", table);
    return html(table);
}

}  // namespace craze::report
