// One benchmark per claim of speed of the loading room, at the paper's size: about 92 000 elements, 278 000 bonds.
// Counters hold what was measured, so that a figure of speed stands beside the answer it bought.

#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/room.hpp"
#include "craze/loading/calibration.hpp"
#include "craze/loading/loading.hpp"
#include "craze/loading/moving.hpp"
#include "craze/loading/specimen.hpp"
#include "support/moduli.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace craze;
using namespace craze::loading;

const Vec3 paper_box{17.61e-6, 13.24e-6, 21.22e-6};

/// Randomly oriented pennies of radius 1.5 um by their density sum a^3 / V; apertures as skewed as T2's, median 37 nm.
domain::Discretisation with_pennies(const domain::Domain& dense, double density, double pore_share)
{
    domain::Discretisation d;
    d.dense = dense;
    struct Penny {
        Vec3 centre, normal;
        double aperture;
    };
    constexpr double a = 1.5e-6, pore = 0.7e-6;
    const double volume = dense.box.x * dense.box.y * dense.box.z;
    const auto place = [&](Random& random) {
        return Vec3{random.uniform(0.0, dense.box.x), random.uniform(0.0, dense.box.y),
                    random.uniform(0.0, dense.box.z)};
    };
    std::vector<Penny> pennies(static_cast<std::size_t>(density * volume / (a * a * a) + 0.5));
    for (std::size_t k = 0; k < pennies.size(); ++k) {
        Random random(1, k);
        pennies[k] = {place(random), normalized(Vec3{random.normal(), random.normal(), random.normal()}),
                      random.lognormal(37e-9, 0.8)};
    }
    std::vector<Vec3> pores(
        static_cast<std::size_t>(pore_share * volume / (4.0 / 3.0 * 3.14159265 * pore * pore * pore) + 0.5));
    for (std::size_t k = 0; k < pores.size(); ++k) {
        Random random(2, k);
        pores[k] = place(random);
    }
    const auto& e = d.dense.elements;
    for (std::int32_t k = 0; k < e.size(); ++k) {
        bool inside = false;
        for (const Vec3& c : pores) inside = inside || norm(e.centre(k) - c) < pore;
        d.in_pore.push_back(inside ? 1 : 0);
    }
    const auto mark = [&](const std::vector<std::int32_t>& is, const std::vector<std::int32_t>& js,
                          domain::PairCracks& out) {
        for (std::size_t b = 0; b < is.size(); ++b) {
            const Vec3 p = e.centre(is[b]), q = e.centre(js[b]);
            std::uint8_t cut = 0;
            double thickness = 0.0;
            for (const auto& penny : pennies) {
                const double dp = dot(p - penny.centre, penny.normal), dq = dot(q - penny.centre, penny.normal);
                if ((dp < 0.0) == (dq < 0.0)) continue;
                const double rho = norm(p + (q - p) * (dp / (dp - dq)) - penny.centre) / a;
                if (rho >= 1.0) continue;
                ++cut;
                thickness = std::max(thickness, penny.aperture * std::sqrt(1.0 - rho * rho));
            }
            out.cut.push_back(cut), out.T1.push_back(thickness), out.T2.push_back(thickness);
        }
    };
    mark(d.dense.bonds.i, d.dense.bonds.j, d.bonds);
    mark(d.dense.near.i, d.dense.near.j, d.near);
    return d;
}

const domain::Domain& dense()
{
    static const domain::Domain once = domain::pack(paper_box, 200e-9, {});
    return once;
}
const domain::Discretisation& coating()
{
    static const domain::Discretisation once = with_pennies(dense(), 0.3, 0.06);
    return once;
}

void calibration(benchmark::State& state)
{
    dense();
    for (auto _ : state) {
        const Calibration c = calibrate(dense(), {}, {});
        state.counters["E_B_GPa"] = c.beam.E_B * 1e-9;
        state.counters["r"] = c.beam.r_tilde;
        state.counters["error_%"] = 100.0 * c.error;
        state.counters["trials"] = static_cast<double>(c.path.size());
    }
}
BENCHMARK(calibration)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

/// Table 2 on the default recipe, untuned.
void untuned_table_2(benchmark::State& state)
{
    dense();
    for (auto _ : state) {
        const Calibration c = measure_given(dense(), {}, {}, {});
        const auto& t = c.path.back();
        state.counters["E_x"] = t.E.x * 1e-9, state.counters["E_y"] = t.E.y * 1e-9,
        state.counters["E_z"] = t.E.z * 1e-9;
        state.counters["nu"] = c.nu;
        state.counters["elements"] = dense().elements.size(), state.counters["bonds"] = dense().bonds.size();
    }
}
BENCHMARK(untuned_table_2)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

void modulus(benchmark::State& state, const char* specimen)
{
    const auto domain = domain::with_defects(coating(), parse_specimen(specimen));
    for (auto _ : state) {
        Rig rig(domain, {}, {}, {});
        Loading l;
        l.drive[2] = {false, 1.0};
        l.path = {1e-3};
        const Point p = rig.rest(l).points.back();
        state.counters["E_GPa"] = p.stress.z / p.strain.z * 1e-9;
        state.counters["iterations"] = static_cast<double>(p.iterations);
        state.counters["residual"] = p.residual;
    }
}
BENCHMARK_CAPTURE(modulus, dense, "dense")->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();
BENCHMARK_CAPTURE(modulus, both, "both")->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

void triaxial(benchmark::State& state, const char* specimen)
{
    const auto domain = domain::with_defects(coating(), parse_specimen(specimen));
    Settings s;
    s.moduli.run = s.uniaxial.run = false;
    s.specimens = {specimen};
    for (auto _ : state) {
        Rig rig(domain, {}, {}, {});
        const auto points = rig.rest(plan(s, domain.box).at(0)).points;
        state.counters["K_first"] = points.front().bulk * 1e-9;
        state.counters["K_last"] = points.back().bulk * 1e-9;
        state.counters["closure"] = points.back().closure;
        double iterations = 0.0;
        for (const auto& p : points) iterations += static_cast<double>(p.iterations);
        state.counters["iterations"] = iterations;
    }
}
BENCHMARK_CAPTURE(triaxial, dense, "dense")->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();
BENCHMARK_CAPTURE(triaxial, both, "both")->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

/// Along x at 10 GPa; the second argument of the name is the number of wave crossings per strain of sigma_failure /
/// E_B.
void fracture(benchmark::State& state)
{
    const bool tension = state.range(0) > 0;
    const auto domain = domain::with_defects(coating(), parse_specimen("both"));
    Settings s;
    s.moduli.run = s.uniaxial.run = s.triaxial.run = false;
    s.fracture.run = true;
    s.fracture.crossings = static_cast<double>(state.range(1));
    for (auto _ : state) {
        Rig rig(domain, {}, {}, {});
        const Curve c = move(rig, plan(s, domain.box).at(tension ? 0 : 1));
        const Strength strength = strength_of(c);
        state.counters["MPa"] = strength.strength * 1e-6;
        state.counters["new_%"] = 100.0 * strength.new_cracks;
        double steps = 0.0;
        for (const auto& p : c.points) steps += static_cast<double>(p.iterations);
        state.counters["steps"] = steps;
        const Point& p = c.points.back();
        state.counters["balance_%"] = 100.0 * (p.work - p.elastic - p.kinetic - p.damped - p.fracture) / p.work;
    }
}
BENCHMARK(fracture)
    ->Args({1, 20})
    ->Args({1, 40})
    ->Args({1, 80})
    ->Args({-1, 20})
    ->Args({-1, 40})
    ->Args({-1, 80})
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime();

/// E of randomly oriented open pennies over E of the dense packing, mean of x, y, z, beside two theories.
void pennies(benchmark::State& state)
{
    const double density = 0.01 * static_cast<double>(state.range(0));
    const auto domain = domain::with_defects(with_pennies(dense(), density, 0.0), parse_specimen("cracks 300 nm"));
    static const double E_0 = support::mean_modulus(dense());
    const Elastic solid{223e9, 0.29};
    for (auto _ : state) state.counters["E/E0"] = support::mean_modulus(domain) / E_0;
    state.counters["alone"] = non_interacting_pennies(solid, density).E / solid.E;
    state.counters["self_consistent"] = self_consistent_pennies(solid, density).E / solid.E;
}
BENCHMARK(pennies)->Arg(5)->Arg(10)->Arg(20)->Arg(30)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

}  // namespace

int main(int count, char** words)
{
    set_verbosity(Verbosity::quiet);
    benchmark::Initialize(&count, words);
    benchmark::RunSpecifiedBenchmarks();
}
