#include "craze/reproduce/targets.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace {

std::vector<Target> all()
{
    std::vector<Target> t{
        {"porosity.total", "2.6", "porosity, total", "%", 8.83, 0.03},
        {"porosity.pores", "2.6", "porosity, pores", "%", 5.88, 0.03},
        {"porosity.cracks", "2.6", "porosity, cracks", "%", 2.95, 0.03},
        {"elements", "3.1.1", "elements of the dense domain", "", 92000, 0.05},
        {"bonds", "3.1.1", "bonds of the dense domain", "", 278000, 0.05},
        {"E_B", "Table 2", "E_B", "GPa", 5820, 0.05},
        {"r_tilde", "Table 2", "r~", "", 0.345, 0.05},
        {"p_DE", "3.3", "discrete porosity p_DE", "%", 5.82, 0.03},
        {"T2.median", "4.2.3", "thickness T2, median", "nm", 37, 0.10},
        {"T2.most", "Fig. 16", "thickness T2, greatest", "nm", 400, 0.30},
    };
    const auto moduli = [&](const char* specimen, const char* words, double x, double y, double z, double goal) {
        const double value[3] = {x, y, z};
        for (int axis = 0; axis < 3; ++axis)
            t.push_back({fmt::format("E.{}.{}", specimen, "xyz"[axis]), "Table 3",
                         fmt::format("E along {}, {}", "xyz"[axis], words), "GPa", value[axis], goal});
    };
    moduli("both", "pores and cracks", 89, 74, 115, 0.10);
    moduli("cracks", "cracks without pores", 135, 111, 159, 0.10);
    moduli("pores", "pores without cracks", 186, 184, 190, 0.05);
    moduli("dense", "bulk", 223, 223, 223, 0.01);
    t.push_back({"ratio.pores", "4.2.2", "K(0)/K_D, pores only", "", 0.75, 0.10});
    t.push_back({"ratio.cracks", "4.2.2", "K(0)/K_D, cracks only", "", 0.46, 0.10});
    t.push_back({"ratio.both", "4.2.2", "K(0)/K_D, both", "", 0.29, 0.10});
    t.push_back({"K.start", "Fig. 21b", "K at eta = 0, both", "GPa", 52, 0.10});
    t.push_back({"K.end", "Fig. 21b", "K at eta = 1.5 %, both", "GPa", 70, 0.10});
    t.push_back({"T.equivalent", "4.2.3", "constant thickness that fits T2, whole curve", "nm", 40, 0.25});
    t.push_back({"T.equivalent.short", "4.2.3", "constant thickness that fits T2, eta to 1.5 %", "nm", 40, 0.25});
    const double uts[] = {61, 120, 179, 243, 308}, ucs[] = {171, 345, 540, 753, 1002};
    for (int k = 0; k < 5; ++k) {
        t.push_back({fmt::format("UTS.{}", 10 * (k + 1)), "Table 4", fmt::format("UTS at {} GPa", 10 * (k + 1)), "MPa",
                     uts[k], 0.15});
        t.push_back({fmt::format("UCS.{}", 10 * (k + 1)), "Table 4", fmt::format("UCS at {} GPa", 10 * (k + 1)), "MPa",
                     ucs[k], 0.15});
        t.push_back({fmt::format("UCS/UTS.{}", 10 * (k + 1)), "Table 4", fmt::format("UCS/UTS at {} GPa", 10 * (k + 1)),
                     "", std::round(100.0 * ucs[k] / uts[k]) / 100.0, 0.15});
    }
    t.push_back({"new.tension", "4.3.2", "new contact beams in tension", "%", 1.0, 0.5});
    t.push_back({"new.compression", "4.3.2", "new contact beams in compression", "%", 4.4, 0.5});
    return t;
}

}  // namespace

const std::vector<Target>& targets()
{
    static const std::vector<Target> list = all();
    return list;
}

const Target& target(const std::string& key)
{
    for (const auto& t : targets())
        if (t.key == key) return t;
    std::vector<std::string> names;
    for (const auto& t : targets()) names.push_back(t.key);
    const std::string near = nearest_name(key, names.data(), names.data() + names.size());
    throw InvalidInput(near.empty()
                           ? fmt::format("no number of the paper is called \"{}\"", key)
                           : fmt::format("no number of the paper is called \"{}\"; did you mean \"{}\"?", key, near));
}

std::optional<double> first_of(const Numbers& numbers, std::string_view begins)
{
    const auto found = numbers.lower_bound(std::string(begins));
    if (found == numbers.end() || !found->first.starts_with(begins)) return std::nullopt;
    return found->second;
}

std::map<std::string, Statistic> statistics(const std::vector<Numbers>& seeds)
{
    std::map<std::string, Statistic> out;
    for (const auto& numbers : seeds)
        for (const auto& [key, value] : numbers) {
            auto& s = out[key];
            s.mean += value;
            ++s.count;
        }
    for (auto& [key, s] : out) {
        s.mean /= s.count;
        for (const auto& numbers : seeds)
            if (const auto found = numbers.find(key); found != numbers.end())
                s.deviation += (found->second - s.mean) * (found->second - s.mean);
        s.deviation = s.count > 1 ? std::sqrt(s.deviation / (s.count - 1)) : 0.0;
    }
    return out;
}

}  // namespace craze::reproduce
