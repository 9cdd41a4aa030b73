// Bonds that break, on a small specimen: section 4.3, Table 4, Figs. 23 to 25.

#include "craze/core/progress.hpp"
#include "craze/domain/room.hpp"
#include "craze/loading/moving.hpp"
#include "craze/loading/specimen.hpp"
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
    // The path grows with the strength and so does its time: the same rate of strain.
    const double one = strength_of(move(*rig_, along_x(1.2e-3, 8e9, 60.0))).strength;
    const double two = strength_of(move(*rig_, along_x(2.4e-3, 16e9, 120.0))).strength;
    EXPECT_NEAR(two / one, 2.0, 0.06);
}

TEST_F(Fracture, TensionBreaksInOnePlaceAndCompressionInMany)  // [Fig. 24]
{
    auto dense = support::small_packing(2000, 5);
    auto pennies = support::random_pennies(dense.box, 1.0e-6, 0.3, 0.0, 11);
    for (std::size_t k = 0; k < pennies.size(); ++k)
        pennies[k].aperture = 15e-9 * std::pow(static_cast<double>(k) / static_cast<double>(pennies.size()), 2.0);
    const Rig rig(domain::with_defects(support::with_pennies(std::move(dense), pennies), parse_specimen("cracks")), {},
                  {}, {});
    const Curve tension = move(rig, along_x(2e-3, 10e9, 40.0)), compression = move(rig, along_x(-4e-3, 10e9, 40.0));
    const Strength t = strength_of(tension), c = strength_of(compression);
    EXPECT_FALSE(tension.stopped.empty());
    EXPECT_FALSE(compression.stopped.empty());
    EXPECT_GT(c.strength, 1.5 * t.strength);
    EXPECT_GT(c.new_cracks, 1.5 * t.new_cracks);
    EXPECT_LT(spread(tension), spread(compression));
}

TEST_F(Fracture, HalvingTheRateMovesTheTensileStrengthByLessThanFivePercent)
{
    const double rate = strength_of(move(*rig_, along_x(1.6e-3, 10e9, 100.0))).strength;
    const double half = strength_of(move(*rig_, along_x(1.6e-3, 10e9, 200.0))).strength;
    EXPECT_NEAR(half / rate, 1.0, 0.05);
}

TEST_F(Fracture, CyclesFollowTheMonotonicEnvelope)  // [Fig. 25]
{
    const Curve monotonic = move(*rig_, along_x(1.0e-3, 10e9, 60.0, 20));
    Loading cycles = along_x(1.0e-3, 10e9, 180.0, 1);
    cycles.path.clear();
    cycles.stop_drop = 1.0;
    for (const double peak : {4e-4, 5.5e-4}) {
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
    for (const std::size_t peak : {std::size_t{11}, std::size_t{33}}) {
        const Point& p = cycled.points.at(peak);
        EXPECT_NEAR(p.stress.x / envelope(p.strain.x), 1.0, 0.08);
    }
}

}  // namespace
}  // namespace craze::loading
