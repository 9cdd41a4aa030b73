#include "craze/loading/theory.hpp"

#include "craze/core/errors.hpp"

#include <gtest/gtest.h>

namespace craze::loading {
namespace {

constexpr Elastic ysz{223e9, 0.29};  // [Table 1]

TEST(Theory, OfPoresGivesThePapersNumber) { EXPECT_NEAR(porous_modulus(ysz, 0.0582), 197e9, 0.5e9); }  // [Eq. 18]

// Evaluated by hand from Hashin and Shtrikman, J. Mech. Phys. Solids 11 (1963) 127.
TEST(Theory, HashinShtrikmanBoundOfThePapersPores)
{
    const Elastic bound = hashin_shtrikman(ysz, 0.0582);
    EXPECT_NEAR(bound.bulk() / ysz.bulk(), 0.8645, 5e-4);
    EXPECT_NEAR(bound.E, 198.4e9, 0.2e9);
}

TEST(Theory, OfVoidsAndCracksStartsFromTheDenseSolid)
{
    for (const Elastic& none :
         {hashin_shtrikman(ysz, 0.0), non_interacting_pennies(ysz, 0.0), self_consistent_pennies(ysz, 0.0)}) {
        EXPECT_NEAR(none.E, ysz.E, 1e-6 * ysz.E);
        EXPECT_NEAR(none.nu, ysz.nu, 1e-9);
    }
    EXPECT_EQ(modulus_across_pennies(ysz, 0.0), ysz.E);
}

TEST(Theory, PenniesOfDensityATenth)
{
    EXPECT_NEAR(non_interacting_pennies(ysz, 0.1).E / ysz.E, 0.852, 5e-4);
    EXPECT_NEAR(self_consistent_pennies(ysz, 0.1).E / ysz.E, 0.8235, 1e-3);
}

TEST(Theory, SelfConsistentBulkModulusAgreesWithItsOwnFormula)
{
    // K/K_0 = 1 - 16/9 (1 - nu^2)/(1 - 2 nu) e with the effective nu: Budiansky and O'Connell, Int. J. Solids Struct.
    // 12 (1976) 81.
    for (const double e : {0.05, 0.2, 0.4}) {
        const Elastic cracked = self_consistent_pennies(ysz, e);
        const double nu = cracked.nu;
        EXPECT_NEAR(cracked.bulk() / ysz.bulk(), 1.0 - 16.0 / 9.0 * (1.0 - nu * nu) / (1.0 - 2.0 * nu) * e, 1e-9);
    }
    EXPECT_THROW(self_consistent_pennies(ysz, 0.6), InvalidInput);
}

}  // namespace
}  // namespace craze::loading
