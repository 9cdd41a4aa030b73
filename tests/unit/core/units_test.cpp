#include "craze/core/units.hpp"

#include "craze/core/errors.hpp"

#include <gtest/gtest.h>

#include <string>

namespace craze {
namespace {

TEST(Quantity, IsReadInSi)
{
    EXPECT_EQ(parse_quantity("23.6 nm", Dimension::length), 23.6e-9);
    EXPECT_EQ(parse_quantity("223GPa", Dimension::pressure), 223e9);
    EXPECT_EQ(parse_quantity(" 0.1 % ", Dimension::fraction), 0.001);
    EXPECT_EQ(parse_quantity("0.29", Dimension::fraction), 0.29);
    EXPECT_EQ(parse_quantity("8.5 px", Dimension::pixel), 8.5);
}

TEST(Quantity, RefusesWhatIsNotOneAndNamesTheNearestUnit)
{
    for (const char* bad : {"", "nm", "23.6", "1e400 nm", "nan nm", "inf nm", "1 2 nm", "0x1 nm"})
        EXPECT_THROW(parse_quantity(bad, Dimension::length), InvalidInput) << bad;
    try {
        parse_quantity("223 Gpa", Dimension::pressure);
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean \"GPa\"?"), std::string::npos) << error.what();
    }
}

TEST(Quantity, WrittenAndReadAgainIsTheSame)
{
    for (const double value : {23.6e-9, 200e-9, 0.4e-6, 17.61e-6, 1e-3, 2.0, 0.0, -3.7e-9, 1.0 / 3.0})
        EXPECT_EQ(parse_quantity(format_quantity(value, Dimension::length), Dimension::length), value);
    EXPECT_EQ(format_quantity(23.6e-9, Dimension::length), "23.6 nm");
    EXPECT_EQ(format_quantity(223e9, Dimension::pressure), "223 GPa");
    EXPECT_EQ(format_quantity(0.001, Dimension::fraction), "0.1 %");
}

}  // namespace
}  // namespace craze
