// The printed form of figures.

#include "craze/report/figure.hpp"
#include "craze/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::report {

namespace {

constexpr double width = 640.0, height = 400.0, left = 74.0, right = 18.0, bottom = 54.0;

/// Where values of one axis fall on the paper, and where its ticks are.
struct Scale {
    double least = 0.0, most = 1.0, from = 0.0, to = 1.0;
    bool log = false;

    double operator()(double v) const
    {
        const double t = log ? std::log(v / least) / std::log(most / least) : (v - least) / (most - least);
        return from + (to - from) * t;
    }
    std::vector<double> ticks(int wanted) const
    {
        std::vector<double> out;
        if (log) {
            const int first = static_cast<int>(std::ceil(std::log10(least) - 1e-9));
            const int last = static_cast<int>(std::floor(std::log10(most) + 1e-9));
            const int stride = std::max(1, (last - first) / wanted + 1);
            for (int k = first; k <= last; k += stride) out.push_back(std::pow(10.0, k));
            if (out.size() >= 2) return out;
            out.clear();
        }
        const double raw = (most - least) / wanted, base = std::pow(10.0, std::floor(std::log10(raw)));
        const double step = base * (raw <= base ? 1.0 : raw <= 2.0 * base ? 2.0 : raw <= 5.0 * base ? 5.0 : 10.0);
        for (double k = std::ceil(least / step - 1e-9); k * step <= most + 1e-9 * step; k += 1.0)
            out.push_back(k * step);
        return out;
    }
};

std::string tick_text(double value, const std::vector<double>& ticks)
{
    double largest = 0.0;
    for (const double t : ticks) largest = std::max(largest, std::abs(t));
    if (std::abs(value) < 1e-9 * largest) return "0";
    return fmt::format("{:.6g}", value);
}

void widen(double v, bool log, double& least, double& most)
{
    if (!std::isfinite(v) || (log && v <= 0.0)) return;
    least = std::min(least, v);
    most = std::max(most, v);
}

Scale scale_of(const Figure& figure, bool along_x)
{
    const Axis& axis = along_x ? figure.x : figure.y;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto& s : figure.series) {
        for (const double v : along_x ? s.x : s.y) widen(v, axis.log, least, most);
        if (!along_x && s.mark == Mark::bars && !axis.log) widen(0.0, false, least, most);
    }
    for (const auto& g : figure.guides)
        if (g.upright == along_x) widen(g.at, axis.log, least, most);
    if (!(least <= most)) least = axis.log ? 0.1 : 0.0, most = 1.0;
    if (axis.log) {
        least = std::pow(10.0, std::floor(std::log10(least) * 5.0) / 5.0),
        most = std::pow(10.0, std::ceil(std::log10(most) * 5.0) / 5.0);
        if (least == most) most = 10.0 * least;
    } else {
        if (least == most)
            least -= most == 0.0 ? 1.0 : 0.1 * std::abs(most), most += most == 0.0 ? 1.0 : 0.1 * std::abs(most);
        const double margin = along_x ? 0.0 : 0.05 * (most - least);
        if (least != 0.0) least -= margin;
        if (most != 0.0) most += margin;
    }
    if (std::isfinite(axis.least)) least = axis.least;
    if (std::isfinite(axis.most)) most = axis.most;
    if (!(most > least)) most = least + 1.0;
    Scale scale;
    scale.least = least, scale.most = most, scale.log = axis.log;
    return scale;
}

std::string path_of(const Series& s, const Scale& x, const Scale& y)
{
    std::string out;
    const auto seen = [](double v, const Scale& axis) { return std::isfinite(v) && (!axis.log || v > 0.0); };
    if (s.mark == Mark::bars) {
        const double floor = y(y.log ? y.least : std::clamp(0.0, y.least, y.most));
        for (std::size_t i = 0; i < s.y.size(); ++i) {
            if (!seen(s.y[i], y) || !seen(s.x[i], x)) continue;
            out +=
                fmt::format("M{:.2f} {:.2f}V{:.2f}H{:.2f}V{:.2f}Z", x(s.x[i]), floor, y(s.y[i]), x(s.x[i + 1]), floor);
        }
        return out;
    }
    bool pen = false;
    for (std::size_t i = 0; i < s.y.size(); ++i) {
        if (!seen(s.y[i], y) || !seen(s.x[i], x)) {
            pen = false;
        } else if (s.mark == Mark::points) {
            out += fmt::format("M{:.2f} {:.2f}m-3 0a3 3 0 1 0 6 0a3 3 0 1 0 -6 0", x(s.x[i]), y(s.y[i]));
        } else {
            out += fmt::format("{}{:.2f} {:.2f}", pen ? 'L' : 'M', x(s.x[i]), y(s.y[i]));
            pen = true;
        }
    }
    return out;
}

std::string draw(const Series& s, const std::string& colour, const Scale& x, const Scale& y)
{
    const auto path = path_of(s, x, y);
    switch (s.mark) {
        case Mark::bars:
            return fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\".35\" stroke=\"{}\" stroke-width=\".7\"/>\n",
                               path, colour, colour);
        case Mark::points: return fmt::format("<path d=\"{}\" fill=\"{}\"/>\n", path, colour);
        default:
            return fmt::format(
                "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\" stroke-linejoin=\"round\"{}/>\n", path,
                colour, s.mark == Mark::dashed ? " stroke-dasharray=\"6 4\"" : "");
    }
}

std::string head(double w, double h, const std::string& label)
{
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
        "aria-label=\"{2}\" font-family=\"Helvetica,Arial,sans-serif\" font-size=\"13\" fill=\"currentColor\">\n",
        w, h, escape(label));
}

}  // namespace

std::string svg(const Figure& figure)
{
    Scale x = scale_of(figure, true), y = scale_of(figure, false);
    std::string legend, body;
    double at = left, line = 16.0;
    int next = 0;
    for (const auto& s : figure.series) {
        const auto colour = palette(s.colour >= 0 ? s.colour : next);
        if (s.colour < 0) ++next;
        if (s.name.empty()) continue;
        const double span = 34.0 + 7.0 * static_cast<double>(s.name.size());
        if (at > left && at + span > width - right) at = left, line += 18.0;
        legend += fmt::format(
            "<path d=\"M{:.1f} {:.1f}h20\" stroke=\"{}\" stroke-width=\"{}\"{}/><text x=\"{:.1f}\" "
            "y=\"{:.1f}\">{}</text>\n",
            at, line - 4.0, colour, s.mark == Mark::bars || s.mark == Mark::points ? 8 : 2.5,
            s.mark == Mark::dashed ? " stroke-dasharray=\"6 3\"" : "", at + 26.0, line, escape(s.name));
        at += span;
    }
    const double top = legend.empty() ? 14.0 : line + 10.0;
    x.from = left, x.to = width - right, y.from = height - bottom, y.to = top;

    std::string out = head(width, height, figure.caption);
    const auto xs = x.ticks(7), ys = y.ticks(6);
    out += "<g stroke=\"currentColor\" stroke-opacity=\".15\">";
    for (const double t : xs) out += fmt::format("<path d=\"M{:.2f} {:.2f}V{:.2f}\"/>", x(t), y.from, y.to);
    for (const double t : ys) out += fmt::format("<path d=\"M{:.2f} {:.2f}H{:.2f}\"/>", x.from, y(t), x.to);
    out += "</g>\n<g text-anchor=\"middle\">";
    for (const double t : xs)
        out += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>", x(t), y.from + 18.0, tick_text(t, xs));
    out += "</g>\n<g text-anchor=\"end\">";
    for (const double t : ys)
        out += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>", x.from - 7.0, y(t) + 4.5, tick_text(t, ys));
    out += "</g>\n" + legend;
    out += fmt::format(
        "<clipPath id=\"clip-{0}\"><rect x=\"{1}\" y=\"{2:.2f}\" width=\"{3:.2f}\" height=\"{4:.2f}\"/></clipPath>\n"
        "<g clip-path=\"url(#clip-{0})\">\n",
        figure.id, left, top, x.to - x.from, y.from - y.to);
    next = 0;
    for (const auto& s : figure.series) {
        out += draw(s, palette(s.colour >= 0 ? s.colour : next), x, y);
        if (s.colour < 0) ++next;
    }
    out += "</g>\n";
    double label_y = top + 15.0;
    auto guides = figure.guides;
    std::stable_sort(guides.begin(), guides.end(), [](const Guide& a, const Guide& b) { return a.at < b.at; });
    for (const auto& g : guides) {
        const double p = g.upright ? x(g.at) : y(g.at);
        if (!std::isfinite(p)) continue;
        if (g.upright) {
            const bool flip = p > x.to - 7.0 * static_cast<double>(g.label.size()) - 10.0;
            out += fmt::format(
                "<path d=\"M{0:.2f} {1:.2f}V{2:.2f}\" stroke=\"currentColor\" stroke-dasharray=\"2 3\"/>"
                "<text x=\"{3:.2f}\" y=\"{4:.2f}\" text-anchor=\"{5}\" font-size=\"12\">{6}</text>\n",
                p, y.from, y.to, p + (flip ? -5.0 : 5.0), label_y, flip ? "end" : "start", escape(g.label));
            label_y += 15.0;
        } else {
            out += fmt::format(
                "<path d=\"M{0:.2f} {1:.2f}H{2:.2f}\" stroke=\"currentColor\" stroke-dasharray=\"2 3\"/>"
                "<text x=\"{3:.2f}\" y=\"{4:.2f}\" text-anchor=\"end\" font-size=\"12\">{5}</text>\n",
                x.from, p, x.to, x.to - 5.0, p - 4.0, escape(g.label));
        }
    }
    out += fmt::format(
        "<rect x=\"{}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"none\" stroke=\"currentColor\"/>\n",
        left, top, x.to - x.from, y.from - y.to);
    out += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"middle\" font-size=\"14\">{}</text>\n",
                       0.5 * (x.from + x.to), height - 12.0, escape(figure.x.title));
    out += fmt::format(
        "<text transform=\"translate(17 {:.2f}) rotate(-90)\" text-anchor=\"middle\" font-size=\"14\">{}</text>\n",
        0.5 * (y.from + y.to), escape(figure.y.title));
    return out + "</svg>\n";
}

std::string svg(const Rose& rose)
{
    constexpr double side = 340.0, centre = 170.0, reach = 132.0;
    std::string out = head(side, side, rose.caption);
    const auto petals = rose.share.size();
    double sum = 0.0, most = 0.0;
    for (const double v : rose.share) sum += v, most = std::max(most, v);
    for (const double ring : {0.5, 1.0})
        out += fmt::format(
            "<circle cx=\"{0}\" cy=\"{0}\" r=\"{1:.1f}\" fill=\"none\" stroke=\"currentColor\" "
            "stroke-opacity=\".25\"/>\n",
            centre, reach * std::sqrt(ring));
    const double step = rose.span_degrees / static_cast<double>(petals) * std::numbers::pi / 180.0;
    const double first = rose.first_degrees * std::numbers::pi / 180.0;
    const auto turns = static_cast<std::size_t>(std::lround(360.0 / rose.span_degrees));
    std::string path;
    for (std::size_t k = 0; most > 0.0 && k < petals * turns; ++k) {
        const double r = reach * std::sqrt(rose.share[k % petals] / most),
                     a = first + (static_cast<double>(k) - 0.5) * step, b = a + step;
        path += fmt::format("M{0} {0}L{1:.2f} {2:.2f}A{3:.2f} {3:.2f} 0 0 0 {4:.2f} {5:.2f}Z", centre,
                            centre + r * std::cos(a), centre - r * std::sin(a), r, centre + r * std::cos(b),
                            centre - r * std::sin(b));
    }
    out += fmt::format("<path d=\"{}\" fill=\"{}\" fill-opacity=\".5\" stroke=\"{}\" stroke-width=\".8\"/>\n", path,
                       palette(0), palette(0));
    out += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text><text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
        centre + reach + 8.0, centre + 5.0, escape(rose.east), centre, centre - reach - 10.0, escape(rose.north));
    out +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\">outer ring: {:.2g} % per {:.3g}°</text>\n", 8.0,
                    side - 8.0, sum > 0.0 ? 100.0 * most / sum : 0.0, rose.span_degrees / static_cast<double>(petals));
    return out + "</svg>\n";
}

}  // namespace craze::report
