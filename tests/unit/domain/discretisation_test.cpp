#include "craze/domain/discretisation.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"

#include <gtest/gtest.h>

namespace craze::domain {
namespace {

// Four elements in a row; element 1 in a pore; bond 2-3 and near pair 0-2 cut.
Discretisation row()
{
    Discretisation d;
    d.dense.box = {8, 2, 2};
    d.dense.mean_radius = 1.0;
    d.dense.dense_volume = 1.0;
    d.dense.elements = {{1, 3, 5, 7}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 2, 1, 1}};
    d.dense.bonds = {{0, 1, 2}, {1, 2, 3}, std::vector(3, BondKind::beam), {0, 0, 0}};
    d.dense.near = {{0, 1}, {2, 3}, {0, 0}};
    d.in_pore = {0, 1, 0, 0};
    d.bonds = {{0, 1, 2}, {0, 0.5, 0.3}, {0, 0.4, 0.2}};
    d.near = {{1, 0}, {0.7, 0}, {0.6, 0}};
    return d;
}

using Thickness = Defects::Thickness;

TEST(WithDefects, OfNoneIsTheDenseDomain)
{
    const Discretisation d = row();
    const Domain dense = with_defects(d, {.pores = false, .cracks = false});
    EXPECT_EQ(dense.elements.x, d.dense.elements.x);
    EXPECT_EQ(dense.bonds.i, d.dense.bonds.i);
    EXPECT_EQ(dense.bonds.kind, d.dense.bonds.kind);
    EXPECT_EQ(dense.near.thickness, d.dense.near.thickness);
    EXPECT_EQ(dense.mean_radius, 1.0);
    EXPECT_EQ(dense.dense_volume, 1.0);
}

TEST(WithDefects, OfPoresTakesElementsWithTheirPairsAndRenumbers)
{
    const Domain porous = with_defects(row(), {.pores = true, .cracks = false});
    EXPECT_EQ(porous.elements.x, (std::vector<double>{1, 5, 7}));
    EXPECT_EQ(porous.bonds.i, std::vector<std::int32_t>{1});
    EXPECT_EQ(porous.bonds.j, std::vector<std::int32_t>{2});
    EXPECT_EQ(porous.bonds.kind[0], BondKind::beam);
    EXPECT_EQ(porous.near.i, std::vector<std::int32_t>{0});
    EXPECT_EQ(porous.near.j, std::vector<std::int32_t>{1});
    EXPECT_EQ(porous.near.thickness[0], 0.0);
}

TEST(WithDefects, GivesContactBeamsTheThicknessAskedFor)
{
    const auto T = [](Thickness thickness, double constant = 0.0) {
        const Domain cracked = with_defects(row(), {false, true, thickness, constant});
        EXPECT_EQ(cracked.bonds.kind, (std::vector{BondKind::beam, BondKind::contact_beam, BondKind::contact_beam}));
        return std::pair{cracked.bonds.thickness, cracked.near.thickness};
    };
    EXPECT_EQ(T(Thickness::T1), (std::pair{std::vector{0.0, 0.5, 0.3}, std::vector{0.7, 0.0}}));
    EXPECT_EQ(T(Thickness::T2), (std::pair{std::vector{0.0, 0.4, 0.2}, std::vector{0.6, 0.0}}));
    EXPECT_EQ(T(Thickness::constant, 0.1), (std::pair{std::vector{0.0, 0.1, 0.1}, std::vector{0.1, 0.0}}));
    EXPECT_EQ(T(Thickness::closed), (std::pair{std::vector{0.0, 0.0, 0.0}, std::vector{0.0, 0.0}}));
}

TEST(WithDefects, BoundsTheThicknessToTheBondWithANotice)
{
    set_verbosity(Verbosity::quiet);
    take_notices();
    const Domain cracked = with_defects(row(), {false, true, Thickness::constant, 2.5});
    EXPECT_EQ(cracked.bonds.thickness, (std::vector{0.0, 2.0, 2.0}));
    ASSERT_EQ(take_notices().size(), 1U);
}

TEST(WithDefects, RefusesWhatDoesNotFit)
{
    EXPECT_THROW(with_defects(row(), {true, true, Thickness::constant, -1.0}), InvalidInput);
    EXPECT_THROW(with_defects(row(), {true, true, Thickness::constant, std::nan("")}), InvalidInput);
    Discretisation short_of_one = row();
    short_of_one.near.T2.pop_back();
    EXPECT_THROW(with_defects(short_of_one, {}), InvalidInput);
}

TEST(DiscretePorosity, IsTheShareOfSphereVolume)  // [Eq. 12]
{
    EXPECT_DOUBLE_EQ(discrete_porosity(row()), 8.0 / 11.0);
}

}  // namespace
}  // namespace craze::domain
