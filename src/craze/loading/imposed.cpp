#include "craze/loading/imposed.hpp"

#include "craze/core/errors.hpp"

#include <fmt/core.h>

namespace craze::loading {

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
