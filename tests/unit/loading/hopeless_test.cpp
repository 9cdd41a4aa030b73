// What cannot be loaded ends with a sentence that helps, never with a wrong number.

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/moving.hpp"
#include "craze/loading/specimen.hpp"
#include "support/cracked.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace craze::loading {
namespace {

const domain::Domain& packing()
{
    static const domain::Domain once = (set_verbosity(Verbosity::quiet), support::small_packing(300, 9));
    return once;
}

Loading along_x(double end)
{
    Loading l;
    l.name = "pull";
    l.axis = 0;
    l.drive[0] = {false, 1.0};
    l.path = {0.5 * end, end};
    return l;
}

template <class Error, class Do>
void expect_advice(Do&& work, const std::string& word)
{
    try {
        work();
        ADD_FAILURE() << "not refused: " << word;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

TEST(Hopeless, NothingConnected)
{
    auto d = packing();
    d.bonds = {};
    expect_advice<InvalidInput>([&] { Rig(d, {}, {}, {}); }, "bond");
}

TEST(Hopeless, AFloatingSpecimenThatReachesNoWall)
{
    auto d = packing();
    d.box = 3.0 * d.box;  // the walls are far from the elements
    expect_advice<ComputationFailed>([&] { Rig(d, {}, {}, {}); }, "x");
}

TEST(Hopeless, StrainsBeyondReasonAndNumbersThatAreNone)
{
    Rig rig(packing(), {}, {}, {});
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 0.9, -5.0}) {
        auto l = along_x(bad);
        expect_advice<InvalidInput>([&] { rig.rest(l); }, "strain");
        expect_advice<InvalidInput>([&] { move(rig, l); }, "strain");
    }
    auto l = along_x(1e-3);
    l.drive[0].free = true;
    expect_advice<InvalidInput>([&] { rig.rest(l); }, "no side moves");
    l = along_x(1e-3);
    l.crossings = std::nan("");
    expect_advice<InvalidInput>([&] { move(rig, l); }, "crossings");
    l = along_x(1e-3);
    l.path.clear();
    expect_advice<InvalidInput>([&] { rig.rest(l); }, "path");

    auto d = packing();
    d.elements.x[7] = std::nan("");
    expect_advice<InvalidInput>([&] { Rig(d, {}, {}, {}); }, "7");
}

}  // namespace
}  // namespace craze::loading
