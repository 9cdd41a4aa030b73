#include "craze/report/figure.hpp"

#include "craze/core/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace craze::report {

namespace {

/// A text field of CSV, quoted where it must be (RFC 4180).
std::string csv_field(std::string_view text)
{
    if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string(); }

Json numbers(const std::vector<double>& values)
{
    Json out = Json::array();
    for (const double v : values) {
        if (std::isfinite(v))
            out.push_back(std::stod(fmt::format("{:.7g}", v)));
        else
            out.push_back(nullptr);
    }
    return out;
}

Json to_json(const Axis& axis)
{
    Json out{{"title", axis.title}, {"log", axis.log}};
    if (std::isfinite(axis.least)) out["least"] = axis.least;
    if (std::isfinite(axis.most)) out["most"] = axis.most;
    return out;
}

constexpr std::array<std::string_view, 4> mark_names{"line", "points", "bars", "dashed"};

}  // namespace

bool Figure::empty() const
{
    return std::none_of(series.begin(), series.end(), [](const Series& s) {
        return std::any_of(s.y.begin(), s.y.end(), [](double v) { return std::isfinite(v); });
    });
}

std::string palette(int index)
{
    static constexpr std::array<std::string_view, 7> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                             "#e69f00", "#56b4e9", "#7f7f7f"};
    return std::string(colours[static_cast<std::size_t>(index) % colours.size()]);
}

std::string csv(const Figure& figure)
{
    if (figure.series.empty()) return {};
    const auto& first = figure.series.front();
    const bool bars = first.mark == Mark::bars;
    const bool shared = std::all_of(figure.series.begin(), figure.series.end(), [&](const Series& s) {
        return s.x == first.x && s.y.size() == first.y.size() && (s.mark == Mark::bars) == bars;
    });
    std::string out;
    const std::string from = csv_field(figure.x.title + " from"), to = csv_field(figure.x.title + " to");
    if (shared) {
        out = bars ? from + "," + to : csv_field(figure.x.title);
        for (const auto& s : figure.series)
            out += "," + csv_field(s.name.empty() || figure.series.size() == 1 ? figure.y.title : s.name);
        for (std::size_t i = 0; i < first.y.size(); ++i) {
            out += "\n" + number(first.x[i]);
            if (bars) out += "," + number(first.x[i + 1]);
            for (const auto& s : figure.series) out += "," + number(s.y[i]);
        }
    } else {
        out = "series," + csv_field(figure.x.title) + "," + csv_field(figure.y.title);
        for (const auto& s : figure.series)
            for (std::size_t i = 0; i < s.y.size(); ++i)
                out += "\n" + csv_field(s.name) + "," +
                       number(s.mark == Mark::bars ? 0.5 * (s.x[i] + s.x[i + 1]) : s.x[i]) + "," + number(s.y[i]);
    }
    return out + "\n";
}

Json to_json(const Figure& figure)
{
    Json series = Json::array(), guides = Json::array();
    int next = 0;
    for (const auto& s : figure.series) {
        series.push_back({{"name", s.name},
                          {"mark", mark_names[static_cast<std::size_t>(s.mark)]},
                          {"colour", palette(s.colour >= 0 ? s.colour : next)},
                          {"x", numbers(s.x)},
                          {"y", numbers(s.y)}});
        if (s.colour < 0) ++next;
    }
    for (const auto& g : figure.guides) guides.push_back({{"at", g.at}, {"label", g.label}, {"upright", g.upright}});
    return {
        {"id", figure.id}, {"x", to_json(figure.x)}, {"y", to_json(figure.y)}, {"series", series}, {"guides", guides}};
}

std::string csv(const Rose& rose)
{
    std::string out = "direction [degree],share [%]";
    const double width = rose.span_degrees / static_cast<double>(rose.share.size());
    double sum = 0.0;
    for (const double v : rose.share) sum += v;
    for (std::size_t i = 0; i < rose.share.size(); ++i)
        out += fmt::format("\n{:.6g},{:.6g}", rose.first_degrees + static_cast<double>(i) * width,
                           sum > 0.0 ? 100.0 * rose.share[i] / sum : 0.0);
    return out + "\n";
}

}  // namespace craze::report
