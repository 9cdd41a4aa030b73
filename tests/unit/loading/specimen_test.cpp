#include "craze/loading/specimen.hpp"

#include "craze/core/errors.hpp"

#include <gtest/gtest.h>

namespace craze::loading {
namespace {

using Thickness = domain::Defects::Thickness;

TEST(Specimen, IsNamedByItsDefects)
{
    for (const char* name :
         {"dense", "pores", "cracks", "both", "cracks T1", "both closed", "cracks 40 nm", "both 0 nm"})
        EXPECT_EQ(specimen_name(parse_specimen(name)), name);
    EXPECT_EQ(specimen_name(parse_specimen("both T2")), "both");
    const auto forty = parse_specimen("cracks 40nm");
    EXPECT_FALSE(forty.pores);
    EXPECT_EQ(forty.thickness, Thickness::constant);
    EXPECT_EQ(forty.constant, 40e-9);
}

TEST(Specimen, OfUnknownNameIsRefusedWithTheNearest)
{
    for (const char* bad : {"", "crack", "dense 40 nm", "pores closed", "cracks 40", "cracks -1 nm", "both nan nm"})
        EXPECT_THROW(parse_specimen(bad), InvalidInput) << bad;
    try {
        parse_specimen("crackz");
        FAIL();
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("\"cracks\""), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace craze::loading
