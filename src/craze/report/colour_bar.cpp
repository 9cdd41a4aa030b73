#include "craze/report/colour_bar.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace craze::report {

namespace {

// Strokes on a grid of 5 x 7 points, two digits (column, row) each, polylines parted by blanks.
struct Sign {
    char name;
    std::string_view strokes;
};
constexpr Sign signs[] = {{'0', "103041453616050110"},
                          {'1', "112026 1636"},
                          {'2', "01103041420646"},
                          {'3', "0110304142334445361605 2333"},
                          {'4', "36300444"},
                          {'5', "400003334445361605"},
                          {'6', "3010010516364544331304"},
                          {'7', "004016"},
                          {'8', "103041423313020110 1304051636454433"},
                          {'9', "423313020110304145361605"},
                          {'-', "0343"},
                          {'.', "1616"},
                          {'%', "0640 0010110100 3545463635"},
                          {'[', "30101636"},
                          {']', "10303616"},
                          {'_', "0747"},
                          {'n', "0206 0312324346"},
                          {'m', "0206 03122326 23324346"},
                          {'u', "0205163645 4246"},
                          {'x', "0246 4206"},
                          {'y', "0226 4218"},
                          {'z', "02420646"}};

double distance_to_stroke(double x, double y, const std::array<double, 4>& s)
{
    const double dx = s[2] - s[0], dy = s[3] - s[1], length2 = dx * dx + dy * dy;
    const double t = length2 > 0.0 ? std::clamp(((x - s[0]) * dx + (y - s[1]) * dy) / length2, 0.0, 1.0) : 0.0;
    return std::hypot(x - s[0] - t * dx, y - s[1] - t * dy);
}

void draw_stroke(io::Picture& picture, const std::array<double, 4>& s, double width, Colour ink)
{
    const double reach = 0.5 * width + 1.0;
    const auto pixel = [](double v, std::int64_t most) {
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(v)), 0, most);
    };
    const std::uint8_t tone[3] = {ink.r, ink.g, ink.b};
    for (auto y = pixel(std::min(s[1], s[3]) - reach, picture.height);
         y < pixel(std::max(s[1], s[3]) + reach + 1.0, picture.height); ++y)
        for (auto x = pixel(std::min(s[0], s[2]) - reach, picture.width);
             x < pixel(std::max(s[0], s[2]) + reach + 1.0, picture.width); ++x) {
            const double off =
                distance_to_stroke(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5, s) - 0.5 * width;
            const double cover = std::clamp(0.5 - off, 0.0, 1.0);
            for (int c = 0; c < 3; ++c) {
                auto& value = picture.at(x, y)[c];
                value = static_cast<std::uint8_t>((1.0 - cover) * value + cover * tone[c] + 0.5);
            }
        }
}

/// Four to ten round values from least to most, and how many digits behind the point they need.
struct Ticks {
    std::vector<double> at;
    int digits = 0;
};
Ticks ticks_of(double least, double most)
{
    const double rough = (most - least) / 5.0, power = std::pow(10.0, std::floor(std::log10(rough)));
    const double share = rough / power, step = power * (share < 1.5   ? 1.0
                                                        : share < 3.5 ? 2.0
                                                        : share < 7.5 ? 5.0
                                                                      : 10.0);
    Ticks out;
    out.digits = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
    for (double k = std::ceil(least / step - 1e-9); k <= most / step + 1e-9; ++k) out.at.push_back(k * step);
    return out;
}

}  // namespace

void write_text(io::Picture& picture, double x, double y, double size, std::string_view text, Colour ink)
{
    const double unit = size / 6.0;
    for (const char c : text) {
        const auto* sign = std::find_if(std::begin(signs), std::end(signs), [c](const Sign& s) { return s.name == c; });
        if (sign != std::end(signs)) {
            const std::string_view way = sign->strokes;
            for (std::size_t k = 0; k + 3 < way.size();) {
                if (way[k + 2] == ' ') {
                    k += 3;
                    continue;
                }
                const auto at = [&](std::size_t n) { return unit * (way[k + n] - '0'); };
                draw_stroke(picture, {x + at(0), y + at(1), x + at(2), y + at(3)}, 0.9 * unit, ink);
                k += 2;
            }
        }
        x += (c == '.' ? 4.0 : 6.0) * unit;
    }
}

io::Picture with_colour_bar(const io::Picture& picture, const ColourBar& bar)
{
    if (picture.channels != 3 || !(bar.most > bar.least))
        throw InvalidInput(
            fmt::format("colour bar: needs a picture in colour and values that rise, got {} channel(s) "
                        "and {:g} to {:g}",
                        picture.channels, bar.least, bar.most));
    const auto unit = static_cast<double>(picture.height) / 750.0;
    const auto px = [unit](double v) { return static_cast<std::int64_t>(std::lround(v * unit)); };
    io::Picture out(picture.width + px(200.0), picture.height, 3, 255);
    for (std::int64_t y = 0; y < picture.height; ++y) std::copy_n(picture.at(0, y), 3 * picture.width, out.at(0, y));

    const std::int64_t left = picture.width + px(20.0), right = left + px(30.0), top = px(110.0),
                       bottom = picture.height - px(60.0);
    const Colour ink{60, 66, 74};
    for (std::int64_t y = top; y < bottom; ++y) {
        const Colour c = viridis((static_cast<double>(bottom - y) - 0.5) / static_cast<double>(bottom - top));
        for (std::int64_t x = left; x < right; ++x) {
            out.at(x, y)[0] = c.r, out.at(x, y)[1] = c.g, out.at(x, y)[2] = c.b;
        }
    }
    const Ticks ticks = ticks_of(bar.least, bar.most);
    for (const double value : ticks.at) {
        const double share = (value - bar.least) / (bar.most - bar.least);
        const double y = static_cast<double>(bottom) - share * static_cast<double>(bottom - top);
        draw_stroke(out, {static_cast<double>(right), y, static_cast<double>(right) + 8.0 * unit, y}, 1.6 * unit, ink);
        write_text(out, static_cast<double>(right) + 16.0 * unit, y - 9.0 * unit, 18.0 * unit,
                   fmt::format("{:.{}f}", value == 0.0 ? 0.0 : value, ticks.digits), ink);
    }
    write_text(out, static_cast<double>(left), static_cast<double>(top) - 52.0 * unit, 21.0 * unit, bar.title, ink);
    return out;
}

}  // namespace craze::report
