#include "craze/loading/imposed.hpp"

#include "craze/core/errors.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace craze::loading {

void check(const Loading& loading)
{
    const auto refuse = [&](const std::string& why) {
        throw InvalidInput(fmt::format("loading \"{}\": {}", loading.name, why));
    };
    double most_factor = 0.0;
    for (const auto& d : loading.drive) {
        if (d.free) continue;
        if (!std::isfinite(d.factor)) refuse("a factor of its drive is not a number");
        most_factor = std::max(most_factor, std::abs(d.factor));
    }
    if (most_factor == 0.0) refuse("no side moves; drive at least one axis");
    if (loading.axis < 0 || loading.axis > 2) refuse(fmt::format("axis {}; needed 0, 1 or 2", loading.axis));
    if (loading.path.empty()) refuse("its path has no point; needed at least one strain");
    for (const double s : loading.path)
        if (!(std::abs(s) * most_factor <= 0.5))
            refuse(fmt::format(
                "a strain of {:.4g} on its path; needed finite strains up to 0.5, ceramics break below 0.02",
                s * most_factor));
    if (!(loading.crossings > 0.0 && std::isfinite(loading.crossings) && loading.strength > 0.0))
        refuse(fmt::format("{} wave crossings and a bond strength of {:.4g} Pa; both need to be above zero",
                           loading.crossings, loading.strength));
}

std::string half_rate_name(const std::string& name)
{
    constexpr std::string_view before = " 1/", after = " rate";
    const auto slash = name.rfind(before);
    if (slash == std::string::npos || !name.ends_with(after)) return fmt::format("{}{}2{}", name, before, after);
    const auto number = slash + before.size();
    return fmt::format("{}{}{}", name.substr(0, number), 2 * std::stol(name.substr(number)), after);
}

double strain_at_density(const std::array<Drive, 3>& drive, double eta)
{
    // V/V_0 - 1/(1 + eta) grows with s as long as every driven edge keeps a positive length.
    const auto excess = [&](double s) {
        double volume = 1.0;
        for (const auto& d : drive)
            if (!d.free) volume *= 1.0 + d.factor * s;
        return volume - 1.0 / (1.0 + eta);
    };
    double most_factor = 0.0;
    for (const auto& d : drive)
        if (!d.free) most_factor = std::max(most_factor, d.factor);
    double low = most_factor > 0.0 ? -1.0 / most_factor : 0.0, high = 0.0;
    if (!(eta >= 0.0 && most_factor > 0.0 && excess(low) <= 0.0))
        throw InvalidInput(fmt::format("density eta = {}: needed zero or more, with axes that shorten together", eta));
    for (int i = 0; i < 200 && low < high; ++i) {
        const double middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        (excess(middle) < 0.0 ? low : high) = middle;
    }
    return high;
}

}  // namespace craze::loading
