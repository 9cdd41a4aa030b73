// Every number of the paper that a virtual coating can be asked for, and how near to it one tries to come.

#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace craze::reproduce {

/// What one coating gave: value by key, in the units of the targets.
using Numbers = std::map<std::string, double>;
/// The value of the first key that begins so ("UTS.": at the lowest strength of bonds); none where there is no such
/// key.
std::optional<double> first_of(const Numbers& numbers, std::string_view begins);

struct Target {
    std::string key;    ///< "E.both.x"
    std::string where;  ///< "Table 3"
    std::string what;   ///< "E along x, pores and cracks"
    std::string unit;   ///< "GPa"; empty: a ratio
    double paper = 0.0;
    double goal = 0.10;  ///< relative difference that one tries for
};

/// All of them, in the paper's order.
const std::vector<Target>& targets();
/// @throws InvalidInput  naming the key and the nearest one
const Target& target(const std::string& key);

/// Mean and spread over seeds of one number.
struct Statistic {
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation (n - 1); 0 of a single value
    int count = 0;
};
/// Of each key that any of the seeds has.
std::map<std::string, Statistic> statistics(const std::vector<Numbers>& seeds);

}  // namespace craze::reproduce
