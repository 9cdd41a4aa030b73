// Equilibrium and motion on packings of the paper's density: cost per bond, per step and per modulus.

#include "craze/core/parallel.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/room.hpp"
#include "craze/mechanics/equilibrium.hpp"
#include "craze/mechanics/motion.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>

namespace {

using namespace craze;
using namespace craze::mechanics;

/// About n elements in a box of the paper's proportions (92 000 fill it). Made once.
const domain::Domain& packing(std::int64_t n)
{
    static std::map<std::int64_t, domain::Domain> made;
    const auto found = made.find(n);
    if (found != made.end()) return found->second;
    const double scale = std::cbrt(static_cast<double>(n) / 92000.0) * 1e-6;
    return made.emplace(n, domain::pack(Vec3{17.61, 13.24, 21.22} * scale, 200e-9, domain::Settings{})).first->second;
}

/// Discs of radius 0.5 to 2 um, sum a^3 / V = 0.2, become contact beams of T up to 60 nm; 5 % of the volume is pores.
domain::Domain damaged(domain::Domain d)
{
    Random random(3);
    const double volume = d.box.x * d.box.y * d.box.z;
    const auto somewhere = [&] {
        return Vec3{random.uniform(0, d.box.x), random.uniform(0, d.box.y), random.uniform(0, d.box.z)};
    };
    std::vector<std::uint8_t> gone(d.elements.r.size(), 0);
    for (double done = 0.0; done < 0.05 * volume;) {
        const double r = random.uniform(0.3e-6, 1.0e-6);
        const Vec3 c = somewhere();
        for (std::int32_t e = 0; e < d.elements.size(); ++e)
            if (norm(d.elements.centre(e) - c) < r) gone[static_cast<std::size_t>(e)] = 1;
        done += 4.19 * r * r * r;
    }
    domain::Bonds kept;
    for (std::size_t b = 0; b < d.bonds.i.size(); ++b) {
        // Elements in pores stay as rattlers here: they bear nothing.
        if (gone[static_cast<std::size_t>(d.bonds.i[b])] || gone[static_cast<std::size_t>(d.bonds.j[b])]) continue;
        kept.i.push_back(d.bonds.i[b]), kept.j.push_back(d.bonds.j[b]);
        kept.kind.push_back(d.bonds.kind[b]), kept.thickness.push_back(0.0);
    }
    d.bonds = kept;
    for (double done = 0.0; done < 0.2 * volume;) {
        const double a = random.uniform(0.5e-6, 2.0e-6), T = random.uniform(0.0, 60e-9);
        const Vec3 c = somewhere(), n = normalized(Vec3{random.normal(), random.normal(), random.normal()});
        for (std::size_t b = 0; b < d.bonds.i.size(); ++b) {
            const Vec3 p = d.elements.centre(d.bonds.i[b]) - c, q = d.elements.centre(d.bonds.j[b]) - c;
            const double s = dot(p, n), t = dot(q, n);
            if (s * t > 0.0 || norm(p + (q - p) * (s / (s - t))) > a) continue;
            d.bonds.kind[b] = domain::BondKind::contact_beam;
            d.bonds.thickness[b] = T;
        }
        done += a * a * a;
    }
    return d;
}

void per_bond(benchmark::State& state, std::int32_t bonds)
{
    using benchmark::Counter;
    state.counters["s_per_bond"] =
        Counter(static_cast<double>(state.iterations()) * bonds, Counter::kIsRate | Counter::kInvert);
    state.counters["bonds"] = bonds;
}

void kernel(benchmark::State& state)
{
    const Lattice lattice = make_lattice(packing(state.range(0)), {});
    const Stiffness stiffness(lattice, lattice.kind);
    std::vector<double> u(6 * lattice.r.size(), 1e-12), f(u.size());
    for (auto _ : state) stiffness.apply(u, f);
    per_bond(state, lattice.bonds());
}
BENCHMARK(kernel)->Arg(10000)->Arg(92000)->Unit(benchmark::kMillisecond)->UseRealTime();

/// Everything of a step: forces, contact, failure, damping, energies, integration.
void step(benchmark::State& state)
{
    const Lattice lattice = make_lattice(packing(state.range(0)), {});
    MotionOptions options{.geometry = static_cast<Geometry>(state.range(1)), .damping = 1e7, .strength = 10e9};
    Motion motion(lattice, options, rest_state(lattice));
    Constraints faces;
    faces.impose_normal(find_face(lattice, 0, false), -0.1);
    faces.impose_normal(find_face(lattice, 0, true), 0.1);
    motion.drive(faces);
    motion.set_affine_rate({0.2 / lattice.box.x, 0, 0});
    motion.advance(10);
    for (auto _ : state) motion.advance(10);
    per_bond(state, 10 * lattice.bonds());
}
BENCHMARK(step)
    ->ArgsProduct({{10000, 92000}, {0, 1}})
    ->Args({1000000, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// One modulus from an affine start, everything but the packing included.
void modulus(benchmark::State& state)
{
    const auto domain = state.range(1) == 0 ? packing(state.range(0)) : damaged(packing(state.range(0)));
    const Lattice lattice = make_lattice(domain, {});
    constexpr double strain = 1e-3;
    std::int64_t iterations = 0;
    for (auto _ : state) {
        Constraints faces;
        faces.impose_normal(find_face(lattice, 0, false), 0.0);
        faces.impose_normal(find_face(lattice, 0, true), strain * lattice.box.x);
        const auto solved = equilibrate(lattice, faces, affine_state(lattice, {strain, -0.29 * strain, -0.29 * strain}),
                                        {.tolerance = 1e-6});
        iterations = solved.iterations;
    }
    state.counters["cg_iterations"] = static_cast<double>(iterations);
}
BENCHMARK(modulus)
    ->ArgsProduct({{10000, 92000}, {0, 1}})
    ->Args({1000000, 0})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
