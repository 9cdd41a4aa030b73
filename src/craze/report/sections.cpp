#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::report {

bool begin_room(Work& work, std::string_view room, std::string_view title)
{
    work.page.section(room, title);
    if (work.folder.has(room)) return true;
    work.page.remark(fmt::format(
        "The folder holds no {0}/summary.json: this room has not run (craze {0} SETTINGS.toml runs it).", room));
    return false;
}

void end_room(Work& work, std::string_view room)
{
    const Json& summary = work.folder.summary(room);
    for (const Json& text : find(summary, "notices"))
        if (text.is_string()) work.page.remark(text.get<std::string>());
    work.page.folded("All numbers of this step", summary_table(summary));
}

Series histogram(std::string name, std::span<const double> values, std::span<const double> weights, double unit,
                 int bins, double most)
{
    double largest = most / unit;
    if (!(most > 0.0))
        for (const double v : values)
            if (std::isfinite(v)) largest = std::max(largest, v / unit);
    Series series{std::move(name), {}, {}, Mark::bars};
    if (!(largest > 0.0)) return series;
    const double raw = largest / bins, base = std::pow(10.0, std::floor(std::log10(raw)));
    const double width = base * (raw <= base ? 1.0 : raw <= 2.0 * base ? 2.0 : raw <= 5.0 * base ? 5.0 : 10.0);
    const auto count = static_cast<std::size_t>(std::floor(largest / width * (1.0 + 1e-12))) + 1;
    for (std::size_t k = 0; k <= count; ++k) series.x.push_back(static_cast<double>(k) * width);
    series.y.assign(count, 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
        const double v = values[k] / unit;
        if (!(v >= 0.0) || !(v < series.x.back())) continue;
        series.y[static_cast<std::size_t>(v / width)] += weights.empty() ? 1.0 : weights[k];
    }
    return series;
}

std::vector<double> over(std::span<const double> values, double unit)
{
    std::vector<double> out(values.begin(), values.end());
    for (double& v : out) v /= unit;
    return out;
}

std::string cell(double value, double unit, int digits)
{
    return std::isfinite(value) ? format_number(value / unit, digits) : std::string("–");
}

}  // namespace craze::report
