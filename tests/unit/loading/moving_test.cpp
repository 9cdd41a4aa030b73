#include "craze/loading/moving.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/response_json.hpp"
#include "craze/loading/specimen.hpp"
#include "craze/loading/states.hpp"
#include "support/cracked.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace craze::loading {
namespace {

class Moving : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        set_verbosity(Verbosity::quiet);
        const auto dense = support::small_packing(400, 7);
        const auto pennies = support::random_pennies(dense.box, 0.8e-6, 0.2, 2e-9, 3);
        rig_ =
            new Rig(domain::with_defects(support::with_pennies(dense, pennies), parse_specimen("cracks")), {}, {}, {});
    }
    static void TearDownTestSuite() { delete rig_; }

    static Loading tension(double end, std::int64_t points, double crossings)
    {
        Loading l;
        l.kind = Loading::Kind::fracture;
        l.name = "tension";
        l.solver = Solver::motion;
        l.axis = 0;
        l.drive[0] = {false, 1.0};
        l.crossings = crossings;
        for (std::int64_t k = 1; k <= points; ++k)
            l.path.push_back(end * static_cast<double>(k) / static_cast<double>(points));
        return l;
    }
    /// All that is not wall time, as text: every bit counts.
    static std::string bits(Curve c)
    {
        c.seconds = 0.0;
        return as_json(c).dump();
    }
    static inline Rig* rig_ = nullptr;
};

TEST_F(Moving, SlowlyAgreesWithRest)
{
    const Loading l = tension(-2e-3, 8, 60.0);
    const auto slow = move(*rig_, l).points, rest = rig_->rest(l).points;
    ASSERT_EQ(slow.size(), rest.size());
    for (std::size_t k = 2; k < slow.size(); ++k) EXPECT_NEAR(slow[k].stress.x / rest[k].stress.x, 1.0, 0.02) << k;
    EXPECT_EQ(slow.back().strain.x, rest.back().strain.x);
}

TEST_F(Moving, WorkIsAccountedForToOnePercent)
{
    Loading l = tension(4e-3, 20, 20.0);
    l.strength = 10e9;
    const Curve c = move(*rig_, l);
    EXPECT_GT(c.points.back().broken, 5);
    EXPECT_GT(c.points.back().fracture, 0.0);
    for (const auto& p : c.points)
        EXPECT_NEAR(p.elastic + p.kinetic + p.damped + p.fracture, p.work, 0.01 * c.points.back().work);
}

TEST_F(Moving, BreaksLaterTheLessBendingCounts)
{
    Loading l = tension(4e-3, 20, 10.0);
    l.strength = 10e9;
    const double printed = strength_of(move(*rig_, l)).strength;
    l.bending_share = 0.5;
    EXPECT_GT(strength_of(move(*rig_, l)).strength, 1.15 * printed);
}

TEST_F(Moving, StartsFromRestShortOfTheFirstBreak)
{
    Loading l = tension(4e-3, 40, 20.0);
    l.strength = 10e9;
    const Curve c = move(*rig_, l);
    std::size_t first = 1;  // point in motion
    while (c.points.at(first).time == 0.0) ++first;
    ASSERT_GE(first, 2U);
    const Point &rest = c.points[first - 1], &moving = c.points[first];
    EXPECT_EQ(rest.broken, 0);
    EXPECT_NEAR(rest.work, rest.elastic, 1e-12 * rest.work);
    ASSERT_FALSE(c.broken.empty());
    EXPECT_GT(c.broken.front().strain, rest.program);
    EXPECT_LT(c.broken.front().strain, 1.25 * rest.program) << "0.9 of the first break";
    // No wave: the same stiffness, hardly any motion, both sides bear the same.
    EXPECT_NEAR(moving.stress.x / moving.strain.x / (rest.stress.x / rest.strain.x), 1.0, 0.01);
    EXPECT_LT(moving.imbalance, 0.01);
    EXPECT_LT(moving.kinetic, 2e-2 * moving.elastic) << "that of the drive itself";
}

TEST_F(Moving, NotesEachBrokenBondWithItsStrain)
{
    Loading l = tension(4e-3, 20, 10.0);
    l.strength = 10e9;
    const Curve c = move(*rig_, l);
    EXPECT_EQ(std::ssize(c.broken), c.points.back().broken);
    double last = 0.0;
    for (const auto& b : c.broken) {
        EXPECT_GE(b.strain, last);
        EXPECT_LE(b.strain, 4e-3);
        last = b.strain;
        const Vec3 middle = 0.5 * (rig_->lattice().centre(b.i) + rig_->lattice().centre(b.j));
        EXPECT_EQ(b.where, middle);
    }
    const Strength s = strength_of(c);
    EXPECT_TRUE(s.tension);
    EXPECT_GT(s.strength, 0.0);
    EXPECT_NEAR(s.new_cracks, static_cast<double>(c.points.back().broken) / rig_->lattice().bonds(),
                1e-12);  // [Eq. 25]
}

TEST_F(Moving, StopsWhenStressHasFallenOrDamageIsDone)
{
    Loading l = tension(2e-2, 60, 40.0);
    l.strength = 10e9;
    l.stop_drop = 0.3;
    const Curve fallen = move(*rig_, l);
    EXPECT_FALSE(fallen.stopped.empty());
    EXPECT_LT(fallen.points.back().stress.x, 0.7 * strength_of(fallen).strength);
    l.stop_drop = 1.0;
    l.stop_damage = 0.01;
    const Curve damaged = move(*rig_, l);
    EXPECT_GE(damaged.points.back().broken, rig_->lattice().bonds() / 100);
    EXPECT_LT(std::ssize(damaged.points), std::ssize(l.path));
}

TEST_F(Moving, StoppedAnywhereGoesOnToTheSameBits)
{
    Loading l = tension(4e-3, 12, 10.0);
    l.strength = 10e9;
    l.path.push_back(2e-3);  // and a turn
    const std::string whole = bits(move(*rig_, l));
    MovingOptions options;
    options.restart = std::filesystem::temp_directory_path() / "craze_restart_test" / "one.restart";
    std::filesystem::remove(options.restart);
    for (const std::int64_t stop : {3, 50, 51, 200}) {
        options.stop_after = stop;
        EXPECT_THROW(move(*rig_, l, options), Interrupted);
        EXPECT_TRUE(std::filesystem::exists(options.restart));
    }
    Loading other = l;
    other.strength = 11e9;
    EXPECT_THROW(move(*rig_, other, options), InvalidInput);
    options.stop_after = MovingOptions{}.stop_after;
    EXPECT_EQ(bits(move(*rig_, l, options)), whole);
    EXPECT_FALSE(std::filesystem::exists(options.restart));
    std::ofstream(options.restart) << "craze restart 2\n{\"key\": 1}";
    EXPECT_THROW(move(*rig_, l, options), InvalidInput);
    std::filesystem::remove_all(options.restart.parent_path());
}

TEST_F(Moving, GivesTheSameBitsOnAnyNumberOfThreads)
{
    Loading l = tension(3e-3, 6, 8.0);
    l.strength = 10e9;
    set_threads(1);
    const auto one = bits(move(*rig_, l));
    set_threads(2);
    const auto two = bits(move(*rig_, l));
    set_threads(0);
    EXPECT_EQ(one, two);
}

TEST_F(Moving, UnloadedAfterCyclesKeepsNoStrainButLosesStiffness)  // [Fig. 25]
{
    Loading l = tension(1e-3, 1, 100.0);
    l.kind = Loading::Kind::cycles;
    l.damping = 1.0;  // against the waves of the turns
    l.path.clear();
    for (const double peak : {4e-4, 4.5e-4})
        for (int k = 1; k <= 20; ++k) l.path.push_back(k <= 10 ? peak * k / 10.0 : peak * (20 - k) / 10.0);
    l.strength = 7e9;
    const Curve c = move(*rig_, l);
    ASSERT_GE(c.points.size(), 35U);
    const Point* end = &c.points.back();  // twenty points back to the second peak's start, forty to the first's
    EXPECT_GT(end->broken, 0);
    EXPECT_GT(end[-10].broken, end[-30].broken);
    const auto unloading = [&](const Point* peak) {
        return (peak[0].stress.x - peak[6].stress.x) / (peak[0].strain.x - peak[6].strain.x);
    };
    EXPECT_LT(unloading(end - 10), unloading(end - 30));
    EXPECT_LT(std::abs(end[-20].stress.x), 0.02 * end[-30].stress.x);
    EXPECT_LT(std::abs(end[0].stress.x), 0.02 * end[-10].stress.x);
}

TEST_F(Moving, BearsOnAverageTheStressOfItsSides)
{
    Loading l = tension(1e-3, 1, 10.0);
    l.solver = Solver::equilibrium;
    BornLoads loads;
    Point point;
    rig_->rest(l, [&](const Moment& m) {
        loads = born_loads(rig_->lattice(), m.state, rig_->fill());
        point = m.point;
    });
    double mean = 0.0, volume = 0.0;
    const auto& lattice = rig_->lattice();
    for (std::size_t e = 0; e < lattice.r.size(); ++e) {
        const double v = std::pow(lattice.r[e], 3);
        mean += v * static_cast<double>(loads.stress[6 * e]);
        volume += v;
    }
    // The branches of the outermost elements to the walls are not bonds: a share of about R/L per side is missing.
    EXPECT_NEAR(mean / volume / point.stress.x, 1.0, 0.15);
    for (std::size_t b = 0; b < loads.contact.size(); ++b)
        EXPECT_EQ(loads.contact[b] == BornLoads::beam, lattice.kind[b] == domain::BondKind::beam);
}

TEST(Load, KeepsStatesAndGoesOnFromWhatIsFinished)
{
    set_verbosity(Verbosity::quiet);
    const auto dense = support::small_packing(300, 9);
    const auto d = support::with_pennies(dense, support::random_pennies(dense.box, 0.6e-6, 0.2, 2e-9, 3));
    Settings s;
    s.beam.calibrate = false;
    s.moduli.run = s.uniaxial.run = s.triaxial.run = false;
    s.fracture.run = true;
    s.fracture.specimens = {"cracks"};
    s.fracture.points = 10;
    s.fracture.crossings = 8.0;
    s.fracture.halvings = 1;
    s.fracture.stop_drop = 1.0;
    s.output.states = {1e-3};
    const auto folder = std::filesystem::temp_directory_path() / "craze_loading_states";
    std::filesystem::remove_all(folder);
    const Response r = load(d, s, folder);
    ASSERT_EQ(r.strengths.size(), 4U);
    EXPECT_GE(r.strengths[0].change, 0.0);
    EXPECT_LT(r.strengths[1].change, 0.0);
    EXPECT_FALSE(r.strengths[2].tension);
    int states = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder / "states"))
        if (file.path().extension() == ".vtu") {
            ++states;
            std::ifstream in(file.path(), std::ios::binary);
            const std::string text{std::istreambuf_iterator<char>(in), {}};
            for (const char* field : {"displacement", "velocity", "damage", "contact", "normal_force", "bending_moment",
                                      "torque", "rankine_stress", "stress", "broken", "breaking_strain"})
                EXPECT_NE(text.find(fmt::format("Name=\"{}\"", field)), std::string::npos) << field;
        }
    EXPECT_EQ(states, 2 + 4);  // one strain in tension, and the last of each
    EXPECT_FALSE(std::filesystem::exists(folder / "partial"));
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace craze::loading
