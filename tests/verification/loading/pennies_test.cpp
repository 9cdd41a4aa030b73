// Randomly oriented open pennies against theory: non-interacting (Kachanov, Appl. Mech. Rev. 45 (1992) 304) and
// self-consistent (Budiansky and O'Connell, Int. J. Solids Struct. 12 (1976) 81).

#include "craze/core/progress.hpp"
#include "craze/domain/room.hpp"
#include "craze/loading/rig.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/loading/theory.hpp"
#include "support/cracked.hpp"
#include "support/moduli.hpp"

#include <gtest/gtest.h>

namespace craze::loading {
namespace {

using support::mean_modulus;

// A lattice cuts whole bonds: a penny of three bond lengths acts like one about a tenth of its radius larger, a third
// in density, beside the scatter of some twenty pennies. Hence 15 %.
TEST(Pennies, SoftenAsTheoriesSay)
{
    set_verbosity(Verbosity::quiet);
    const domain::Domain dense = domain::pack(Vec3{7e-6, 7e-6, 7e-6}, 200e-9, {});
    const double E_0 = mean_modulus(dense);
    const Elastic solid{223e9, 0.29};
    double last = 1.0;
    for (const double density : {0.05, 0.1, 0.2}) {
        double ratio = 0.0;
        for (const std::uint64_t seed : {1U, 2U}) {
            const auto d =
                support::with_pennies(dense, support::random_pennies(dense.box, 1.2e-6, density, 300e-9, seed));
            ratio += 0.5 * mean_modulus(domain::with_defects(d, parse_specimen("cracks"))) / E_0;
        }
        const double alone = non_interacting_pennies(solid, density).E / solid.E,
                     together = self_consistent_pennies(solid, density).E / solid.E;
        RecordProperty(std::to_string(density), std::to_string(ratio));
        EXPECT_LT(ratio, last);
        EXPECT_LT(ratio, 1.15 * alone) << density;
        EXPECT_GT(ratio, 0.85 * together) << density;
        last = ratio;
    }
}

}  // namespace
}  // namespace craze::loading
