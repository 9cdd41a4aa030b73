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

// Exit 1, not a modulus of zero. In compression a curve waits for the crack to close.
TEST(Hopeless, ASpecimenCutThroughByAnOpenCrack)
{
    auto d = packing();
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) {
        const double p = d.elements.centre(d.bonds.i[b]).x, q = d.elements.centre(d.bonds.j[b]).x;
        if ((p - 0.5 * d.box.x) * (q - 0.5 * d.box.x) >= 0.0) continue;
        d.bonds.kind[b] = domain::BondKind::contact_beam;
        d.bonds.thickness[b] = 5e-9;
    }
    for (auto& thickness : d.near.thickness) thickness = 5e-9;
    Rig rig(d, {}, {}, {});
    for (const double end : {1e-3, -1e-4}) {
        auto l = along_x(end);
        l.kind = Loading::Kind::modulus;
        expect_advice<ComputationFailed>([&] { rig.rest(l); }, "bears nothing along x");
    }
    auto l = along_x(1e-3);
    l.kind = Loading::Kind::uniaxial;
    expect_advice<ComputationFailed>([&] { rig.rest(l); }, "cuts it through");
    l = along_x(-1e-2);
    l.kind = Loading::Kind::uniaxial;
    l.path = {-1e-4, -1e-2};
    const auto points = rig.rest(l).points;
    EXPECT_GT(points.at(2).closure, 0.1);
    EXPECT_LT(points.at(2).stress.x, -1e6);
    l.axis = 1, l.drive[0].free = true, l.drive[1] = {false, 1.0}, l.path = {1e-3};
    l.kind = Loading::Kind::modulus;
    EXPECT_GT(rig.rest(l).points.back().stress.y, 1e6) << "along the crack it bears";
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
