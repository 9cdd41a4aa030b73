// An independent packing whose modulus two independent codes have measured.

#include "craze/mechanics/equilibrium.hpp"
#include "support/packings.hpp"

#include <gtest/gtest.h>

namespace craze::mechanics {
namespace {

double mean_displacement(const State& state, const Face& face, int axis)
{
    double sum = 0.0;
    for (const auto e : face.elements) sum += state.displacement(e)[axis];
    return sum / static_cast<double>(face.elements.size());
}

// 235.0 GPa over the box height and nu = 0.297, with the values of Table 2: solved elsewhere by assembled sparse
// matrices and by an independent explicit code.
TEST(ReferencePacking, HasTheModulusAndPoissonRatioFoundElsewhere)
{
    CRAZE_NEEDS_DATA(support::reference_packing_file());
    const Lattice lattice = make_lattice(support::reference_packing(), BeamMaterial{});
    const Face low = find_face(lattice, 2, false), high = find_face(lattice, 2, true);
    constexpr double strain = 1e-3;
    Constraints constraints;
    constraints.impose_normal(low, 0.0);
    constraints.impose_normal(high, strain * lattice.box.z);
    const auto solved =
        equilibrate(lattice, constraints, affine_state(lattice, {-0.29 * strain, -0.29 * strain, strain}));

    const double pull = face_force(high, solved.forces.force), hold = face_force(low, solved.forces.force);
    EXPECT_NEAR(pull / -hold, 1.0, 1e-4);
    const double stress = 0.5 * (pull - hold) / (lattice.box.x * lattice.box.y);
    EXPECT_NEAR(stress / strain / 235.0e9, 1.0, 0.005);
    double across = 0.0;
    for (int axis = 0; axis < 2; ++axis)
        across += 0.5 *
                  (mean_displacement(solved.state, find_face(lattice, axis, true), axis) -
                   mean_displacement(solved.state, find_face(lattice, axis, false), axis)) /
                  lattice.box[axis];
    EXPECT_NEAR(-across / strain, 0.297, 0.01);
}

}  // namespace
}  // namespace craze::mechanics
