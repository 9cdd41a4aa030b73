#include "craze/core/units.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace craze {

namespace {

struct Unit {
    const char* name;
    double factor;
    bool written;  // used when values are written
};

// Ascending factors within each dimension.
const std::vector<Unit>& table(Dimension dimension)
{
    static const std::vector<Unit> pure{{"", 1, true}};
    static const std::vector<Unit> fraction{{"%", 0.01, true}, {"", 1, false}};
    static const std::vector<Unit> pixel{{"px", 1, true}, {"voxels", 1, false}};
    static const std::vector<Unit> length{
        {"nm", 1e-9, true}, {"um", 1e-6, true}, {"µm", 1e-6, false}, {"mm", 1e-3, true}, {"m", 1, true}};
    static const std::vector<Unit> pressure{
        {"Pa", 1, true}, {"kPa", 1e3, true}, {"MPa", 1e6, true}, {"GPa", 1e9, true}};
    static const std::vector<Unit> density{{"kg/m3", 1, true}, {"g/cm3", 1000, false}};
    static const std::vector<Unit> time{{"ns", 1e-9, true}, {"us", 1e-6, true}, {"ms", 1e-3, true}, {"s", 1, true}};
    static const std::vector<Unit> angle{{"deg", std::numbers::pi / 180, true}, {"rad", 1, false}};
    static const std::vector<Unit> velocity{{"m/s", 1, true}, {"mm/s", 1e-3, false}};
    static const std::vector<Unit> size{{"B", 1, true}, {"kB", 1e3, true}, {"MB", 1e6, true}, {"GB", 1e9, true}};
    switch (dimension) {
        case Dimension::pure: return pure;
        case Dimension::fraction: return fraction;
        case Dimension::pixel: return pixel;
        case Dimension::length: return length;
        case Dimension::pressure: return pressure;
        case Dimension::density: return density;
        case Dimension::time: return time;
        case Dimension::angle: return angle;
        case Dimension::velocity: return velocity;
        case Dimension::size: return size;
    }
    return pure;
}

std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t above = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
            diagonal = above;
        }
    }
    return row.back();
}

// A power of ten moves the decimal exponent of the text, so that "23.6 nm" is the double nearest to 23.6e-9.
double scaled(std::string_view number, double value, double factor)
{
    const double power = std::round(std::log10(factor));
    if (std::abs(std::pow(10.0, power) / factor - 1.0) > 1e-12) return value * factor;
    const auto e = number.find_first_of("eE");
    int exponent = 0;
    if (e != std::string_view::npos) {
        const std::size_t from = e + 1 + (number[e + 1] == '+' ? 1 : 0);
        std::from_chars(number.data() + from, number.data() + number.size(), exponent);
    }
    const std::string text = fmt::format("{}e{}", number.substr(0, e), exponent + static_cast<int>(power));
    double moved = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), moved);
    return moved;
}

}  // namespace

std::string units_of(Dimension dimension)
{
    std::string list;
    for (const Unit& unit : table(dimension)) {
        if (*unit.name == '\0') continue;
        if (!list.empty()) list += ", ";
        list += unit.name;
    }
    return list;
}

double parse_quantity(std::string_view text, Dimension dimension)
{
    const std::string_view body = trimmed(text);
    double number = 0.0;
    const auto [end, error] = std::from_chars(body.data(), body.data() + body.size(), number);
    if (error != std::errc{} || !std::isfinite(number))
        throw InvalidInput(fmt::format("needs a number with a unit ({}), got \"{}\"", units_of(dimension), text));
    const std::string_view unit = trimmed(body.substr(static_cast<std::size_t>(end - body.data())));
    for (const Unit& candidate : table(dimension))
        if (unit == candidate.name)
            return scaled(body.substr(0, static_cast<std::size_t>(end - body.data())), number, candidate.factor);
    if (unit.empty()) throw InvalidInput(fmt::format("needs a unit, one of {}; got \"{}\"", units_of(dimension), text));
    std::vector<std::string> names;
    for (const Unit& candidate : table(dimension)) names.emplace_back(candidate.name);
    const std::string near = nearest_name(unit, names.data(), names.data() + names.size());
    throw InvalidInput(fmt::format("unknown unit \"{}\" in \"{}\"; needs one of {}{}", unit, text, units_of(dimension),
                                   near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

std::string format_quantity(double value, Dimension dimension)
{
    const auto& units = table(dimension);
    const Unit* best = nullptr;
    for (const Unit& unit : units) {
        if (!unit.written) continue;
        if (best == nullptr || std::abs(value) >= unit.factor * (1 - 1e-12)) best = &unit;
    }
    // Rounding of the division can hide the short decimal: look for one that parses back.
    for (int digits = 1; digits <= 17; ++digits) {
        const double rounded = std::stod(fmt::format("{:.{}g}", value / best->factor, digits));
        std::string text = fmt::format("{}", rounded);  // 40, not 4e+01
        if (*best->name != '\0') text += fmt::format(" {}", best->name);
        if (parse_quantity(text, dimension) == value) return text;
    }
    return fmt::format("{:.17g}{}{}", value / best->factor, *best->name == '\0' ? "" : " ", best->name);
}

std::string nearest_name(std::string_view word, const std::string* begin, const std::string* end)
{
    const std::string* best = end;
    std::size_t least = std::max<std::size_t>(2, word.size() / 2) + 1;
    for (const std::string* name = begin; name != end; ++name) {
        if (name->empty()) continue;
        const std::size_t d = edit_distance(word, *name);
        if (d < least && d < std::max(word.size(), name->size())) least = d, best = name;
    }
    return best == end ? std::string{} : *best;
}

}  // namespace craze
