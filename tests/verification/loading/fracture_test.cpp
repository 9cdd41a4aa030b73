// Bonds that break, on a small specimen: section 4.3, Table 4, Figs. 23 to 25.

#include "craze/core/progress.hpp"
#include "craze/domain/room.hpp"
#include "craze/loading/moving.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/loading/states.hpp"
#include "support/cracked.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace craze::loading {
namespace {

class Fracture : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        set_verbosity(Verbosity::quiet);
        auto dense = domain::pack(Vec3{4.4e-6, 4.0e-6, 4.0e-6}, 200e-9, {});
        const auto pennies = support::random_pennies(dense.box, 0.7e-6, 0.15, 5e-9, 11);
        rig_ = new Rig(domain::with_defects(support::with_pennies(std::move(dense), pennies), parse_specimen("cracks")),
                       {}, {}, {});
    }
    static void TearDownTestSuite() { delete rig_; }

    static Loading along_x(double end, double strength, double crossings, std::int64_t points = 60)
    {
        Loading l;
        l.kind = Loading::Kind::fracture;
        l.name = "fracture";
        l.solver = Solver::motion;
        l.axis = 0;
        l.drive[0] = {false, 1.0};
        l.strength = strength;
        l.crossings = crossings;
        l.stop_drop = 0.5;
        for (std::int64_t k = 1; k <= points; ++k)
            l.path.push_back(end * static_cast<double>(k) / static_cast<double>(points));
        return l;
    }
    /// Standard deviation of where bonds broke along x, over that of bonds everywhere.
    static double spread(const Curve& curve)
    {
        double sum = 0.0, square = 0.0;
        for (const auto& b : curve.broken) sum += b.where.x, square += b.where.x * b.where.x;
        const auto n = static_cast<double>(curve.broken.size());
        return std::sqrt(std::max(0.0, square / n - sum * sum / n / n)) / (rig_->lattice().box.x / std::sqrt(12.0));
    }
    static inline Rig* rig_ = nullptr;
};

TEST_F(Fracture, StrengthIsProportionalToThatOfTheBonds)  // [Table 4]
{
    // Crossings are per strain of sigma_failure / E_B: the same rate of strain over strength.
    const double one = strength_of(move(*rig_, along_x(1.2e-3, 8e9, 40.0))).strength;
    const double two = strength_of(move(*rig_, along_x(2.4e-3, 16e9, 40.0))).strength;
    EXPECT_NEAR(two / one, 2.0, 0.06);
}

TEST_F(Fracture, TensionBreaksInOnePlaceAndCompressionInMany)  // [Fig. 24]
{
    auto dense = support::small_packing(2000, 5);
    auto pennies = support::random_pennies(dense.box, 1.0e-6, 0.3, 0.0, 11);
    for (std::size_t k = 0; k < pennies.size(); ++k)
        pennies[k].aperture = 15e-9 * std::pow(static_cast<double>(k) / static_cast<double>(pennies.size()), 2.0);
    Rig rig(domain::with_defects(support::with_pennies(std::move(dense), pennies), parse_specimen("cracks")), {}, {},
            {});
    const Curve tension = move(rig, along_x(2e-3, 10e9, 40.0)), compression = move(rig, along_x(-4e-3, 10e9, 40.0));
    const Strength t = strength_of(tension), c = strength_of(compression);
    EXPECT_FALSE(tension.stopped.empty());
    EXPECT_FALSE(compression.stopped.empty());
    EXPECT_GT(c.strength, 1.5 * t.strength);
    EXPECT_GT(c.new_cracks, 1.5 * t.new_cracks);
    EXPECT_LT(spread(tension), spread(compression));
}

TEST_F(Fracture, HalvingTheRateMovesBothStrengthsByAtMostFivePercent)
{
    for (const double end : {1.6e-3, -3e-3}) {
        const double rate = strength_of(move(*rig_, along_x(end, 10e9, 40.0, 100))).strength;
        const double half = strength_of(move(*rig_, along_x(end, 10e9, 80.0, 100))).strength;
        EXPECT_NEAR(half / rate, 1.0, 0.05) << end;
    }
}

// Sources of truth without time: solve for rest, break the worst beams, solve again, strain on once all hold.
double strength_by_events(Rig& rig, const Loading& loading, double strain_step)
{
    mechanics::EquilibriumSolver solver(rig.lattice(), {.tolerance = 1e-4, .free_contacts = false});
    auto state = mechanics::rest_state(rig.lattice());
    double s = 0.25 * loading.path.back(), peak = 0.0;
    for (bool broke = false;; broke = false) {
        double stress = 0.0;
        do {
            auto rest = solver.solve(rig.constraints(loading, s), std::move(state));
            state = std::move(rest.state);
            stress = std::abs(rig.measure(loading, s, state, rest.forces).stress[loading.axis]);
            if (stress < 0.7 * peak) return peak;
            const auto loads = born_loads(rig.lattice(), state, rig.fill());
            const auto worst = static_cast<double>(*std::max_element(loads.rankine.begin(), loads.rankine.end()));
            const double limit = std::max(loading.strength, 0.95 * worst);
            broke = false;
            for (std::size_t b = 0; b < state.kind.size(); ++b)
                if (state.kind[b] == domain::BondKind::beam && static_cast<double>(loads.rankine[b]) >= limit)
                    state.kind[b] = domain::BondKind::contact_beam, broke = true;
        } while (broke);
        peak = std::max(peak, stress);
        s *= 1.0 + strain_step;
        for (double& u : state.u) u *= 1.0 + strain_step;
    }
}

TEST_F(Fracture, AgreesWithBreakingBondByBondAtRest)
{
    for (const double end : {1.6e-3, -3e-3}) {
        Loading l = along_x(end, 10e9, 80.0, 100);
        const double moved = strength_of(move(*rig_, l)).strength;
        l.path = {0.8 * 4.0 * move(*rig_, l).points[1].program};
        EXPECT_NEAR(moved / strength_by_events(*rig_, l, 0.01), 1.0, 0.05) << end;
    }
}

TEST_F(Fracture, CyclesFollowTheMonotonicEnvelope)  // [Fig. 25]
{
    const Curve monotonic = move(*rig_, along_x(1.0e-3, 10e9, 80.0, 100));
    Loading cycles = along_x(1.0e-3, 10e9, 200.0, 1);
    cycles.damping = 1.0;  // against the waves of the turns
    cycles.path.clear();
    cycles.stop_drop = 1.0;
    const std::vector<double> peaks{4e-4, 5.6e-4};
    for (const double peak : peaks) {
        for (int k = 1; k <= 11; ++k) cycles.path.push_back(peak * k / 11.0);
        for (int k = 10; k >= 0; --k) cycles.path.push_back(peak * k / 11.0);
    }
    const Curve cycled = move(*rig_, cycles);
    const auto envelope = [&](double strain) {
        const auto& p = monotonic.points;
        for (std::size_t k = 1; k < p.size(); ++k)
            if (p[k].strain.x >= strain) {
                const double share = (strain - p[k - 1].strain.x) / (p[k].strain.x - p[k - 1].strain.x);
                return p[k - 1].stress.x + share * (p[k].stress.x - p[k - 1].stress.x);
            }
        return 0.0;
    };
    std::vector<double> stiffness;
    for (std::size_t k = 0; k + 6 < cycled.points.size(); ++k) {
        const Point &p = cycled.points[k], &unloaded = cycled.points[k + 6];
        if (std::find(peaks.begin(), peaks.end(), p.program) == peaks.end()) continue;
        EXPECT_NEAR(p.stress.x / envelope(p.strain.x), 1.0, 0.05) << p.program;
        stiffness.push_back((p.stress.x - unloaded.stress.x) / (p.strain.x - unloaded.strain.x));
        const Point& end = cycled.points.at(k + 11);
        EXPECT_EQ(end.program, 0.0);
        EXPECT_LT(std::abs(end.stress.x), 0.01 * p.stress.x) << "no residual strain";
    }
    ASSERT_EQ(stiffness.size(), 2U);
    EXPECT_LT(stiffness[1], stiffness[0]);
}

}  // namespace
}  // namespace craze::loading
