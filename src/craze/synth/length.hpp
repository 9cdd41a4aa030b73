// A distribution of lengths, as settings speak of it.

#pragma once

#include "craze/core/random.hpp"
#include "craze/core/schema.hpp"

#include <string>
#include <string_view>

namespace craze::synth {

/// A distribution of positive lengths: lognormal about `median`, drawn again until within [least, most].
struct Length {
    double median = 0.0;             ///< m
    double spread = 0.0;             ///< standard deviation of the logarithm; 0 = always the median
    double least = 0.0, most = 1.0;  ///< m
};

double draw(const Length& length, Random& random);
void describe(Schema& schema, std::string_view key, Length& length, std::string_view meaning);
/// @throws InvalidInput  unless least <= median <= most
void check(const Length& length, const std::string& name);

}  // namespace craze::synth
