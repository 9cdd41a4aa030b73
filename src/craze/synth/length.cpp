#include "craze/synth/length.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

namespace craze::synth {

double draw(const Length& length, Random& random)
{
    if (length.spread == 0.0) return length.median;
    for (int tries = 0; tries < 1000; ++tries) {
        const double value = random.lognormal(length.median, length.spread);
        if (value >= length.least && value <= length.most) return value;
    }
    return length.median;
}

void describe(Schema& schema, std::string_view key, Length& length, std::string_view meaning)
{
    constexpr Range sizes{1e-9, 1e-3};
    schema.group(key, meaning, [&] {
        schema.quantity("median", length.median, Dimension::length, sizes, "median");
        schema.number("spread", length.spread, {0, 3}, "standard deviation of the logarithm");
        schema.quantity("least", length.least, Dimension::length, {0, 1e-3}, "smaller draws are drawn again");
        schema.quantity("most", length.most, Dimension::length, sizes, "greater draws are drawn again");
    });
}

void check(const Length& length, const std::string& name)
{
    if (!(length.least <= length.median && length.median <= length.most))
        throw InvalidInput(fmt::format("synth: {} needs least <= median <= most, got {:g} <= {:g} <= {:g} m", name,
                                       length.least, length.median, length.most));
}

}  // namespace craze::synth
