// Speed of the domain room at the paper's size. Random data of the paper's numbers; nothing is read from disk.

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/domain/cracks.hpp"
#include "craze/domain/orientation.hpp"
#include "craze/domain/packing.hpp"
#include "craze/domain/pairs.hpp"
#include "craze/domain/quality.hpp"
#include "craze/domain/thickness.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace {

using namespace craze;
using namespace craze::domain;

constexpr double R = 200e-9, h = 23.6e-9;
constexpr Vec3 paper_box{17.61e-6, 13.24e-6, 21.22e-6};

const Domain& paper_domain()
{
    static const Domain domain = join(pack_elements(paper_box, {}), paper_box, R, {});
    return domain;
}

/// Wavy sheets of small triangles all over the box, as alpha shapes of skeleton voxels are: edges of about h.
mesh::CrackSurface sheets(std::int64_t triangles)
{
    mesh::CrackSurface s;
    for (std::uint64_t sheet = 0; std::ssize(s.triangles) < triangles; ++sheet) {
        Random random(3, sheet);
        const Vec3 centre{random.uniform(0, paper_box.x), random.uniform(0, paper_box.y),
                          random.uniform(0, paper_box.z)};
        Vec3 n{random.normal(), random.normal(), random.normal()}, u = normalized(cross(n, {0.3, 0.5, 0.8}));
        n = normalized(n);
        const Vec3 v = cross(n, u);
        const auto side = static_cast<std::int32_t>(60 + random.below(160));
        const auto first = static_cast<std::int32_t>(s.vertices.size());
        for (std::int32_t a = 0; a <= side; ++a)
            for (std::int32_t b = 0; b <= side; ++b)
                s.vertices.push_back(centre + (a - side / 2) * h * u + (b - side / 2) * h * v +
                                     3 * h * std::sin(0.1 * a) * std::cos(0.13 * b) * n);
        for (std::int32_t a = 0; a < side; ++a)
            for (std::int32_t b = 0; b < side; ++b) {
                const std::int32_t k = first + a * (side + 1) + b;
                s.triangles.push_back({k, k + 1, k + side + 1});
                s.triangles.push_back({k + 1, k + side + 2, k + side + 1});
            }
    }
    s.triangles.resize(static_cast<std::size_t>(triangles));
    return s;
}

// Argument: elements. The box keeps the paper's proportions.
void packing(benchmark::State& state)
{
    const Vec3 box = std::cbrt(static_cast<double>(state.range(0)) / 92000.0) * paper_box;
    PackingReport report;
    Elements elements;
    for (auto _ : state) elements = pack_elements(box, {}, &report);
    const Stopwatch watch;
    const Domain domain = join(std::move(elements), box, R, {});
    state.counters["join_s"] = watch.seconds();
    const Quality q = quality(domain);
    state.counters["elements"] = domain.elements.size();
    state.counters["bonds"] = domain.bonds.size();
    state.counters["steps"] = static_cast<double>(report.iterations);
    state.counters["overlap_median_%"] = 100 * q.overlap[2];
    state.counters["overlap_most_%"] = 100 * q.overlap[4];
    state.counters["fabric_off_%"] =
        100 * std::max({std::abs(3 * q.fabric[0] - 1), std::abs(3 * q.fabric[1] - 1), std::abs(3 * q.fabric[2] - 1)});
    state.counters["peak_GB"] = static_cast<double>(peak_memory()) / 1e9;
}
BENCHMARK(packing)->Arg(92000)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1)->Repetitions(3);

// Several GB and many minutes: CRAZE_BENCH_ELEMENTS=10000000 asks for it.
void large_packing(benchmark::State& state)
{
    const char* asked = std::getenv("CRAZE_BENCH_ELEMENTS");
    if (!asked) {
        state.SkipWithError("set CRAZE_BENCH_ELEMENTS=10000000");
        return;
    }
    const Vec3 box = std::cbrt(std::atof(asked) / 92000.0) * paper_box;
    PackingReport report;
    for (auto _ : state) {
        const Domain domain = join(pack_elements(box, {}, &report), box, R, {});
        state.counters["bonds"] = domain.bonds.size();
    }
    state.counters["steps"] = static_cast<double>(report.iterations);
    state.counters["pack_s"] = report.seconds;
    state.counters["peak_GB"] = static_cast<double>(peak_memory()) / 1e9;
}
BENCHMARK(large_packing)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(1);

void bonds_against_nine_million_triangles(benchmark::State& state)
{
    const Domain& d = paper_domain();
    const mesh::CrackSurface surface = sheets(9'000'000);
    std::vector<std::uint8_t> met;
    double best = 1e30;
    for (auto _ : state) {
        const Stopwatch watch;
        met = triangles_met(d.elements, d.bonds.i, d.bonds.j, surface);
        best = std::min(best, watch.seconds());
    }
    // Brute force costs the same for every pair: a sample of triangles against all bonds, on as many threads.
    constexpr std::size_t sample = 400;
    const Stopwatch watch;
    const double hits = parallel_sum(d.bonds.size(), [&](std::int64_t b) {
        const Vec3 p = d.elements.centre(d.bonds.i[static_cast<std::size_t>(b)]),
                   q = d.elements.centre(d.bonds.j[static_cast<std::size_t>(b)]);
        double sum = 0.0;
        for (std::size_t t = 0; t < sample; ++t) {
            const auto& c = surface.triangles[t * 22000];
            sum += meets(p, q, surface.vertices[static_cast<std::size_t>(c[0])],
                         surface.vertices[static_cast<std::size_t>(c[1])],
                         surface.vertices[static_cast<std::size_t>(c[2])]);
        }
        return sum;
    });
    const double brute = watch.seconds() * 9e6 / sample;
    benchmark::DoNotOptimize(hits);
    state.counters["cut"] = static_cast<double>(std::ranges::count_if(met, [](auto n) { return n > 0; }));
    state.counters["brute_force_s"] = brute;
    state.counters["times_faster"] = brute / best;
}
BENCHMARK(bonds_against_nine_million_triangles)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(5);

void thickness_of_25000_contact_beams(benchmark::State& state)
{
    const Domain& d = paper_domain();
    microstructure::Microstructure micro;
    const Shape shape{746, 561, 899};
    micro.gray.level = Volume<std::uint8_t>(shape);
    micro.gray.voxel_size = h;
    micro.threshold = 110;
    micro.pore = Mask(shape);
    micro.crack = Mask(shape);
    parallel_tasks(shape.nz, [&](std::int64_t z) {
        for (std::int64_t y = 0; y < shape.ny; ++y)
            for (std::int64_t x = 0; x < shape.nx; ++x) {
                const bool in = (x + 2 * y + 3 * z) % 40 < 2;
                micro.gray.level(x, y, z) = in ? 60 : 170;
                if (in) micro.crack.set(x, y, z, true);
            }
    });
    PairCracks cracks;
    cracks.cut.assign(d.bonds.i.size(), 0);
    for (std::size_t b = 0; b < 25000; ++b) cracks.cut[b * d.bonds.i.size() / 25000] = 1;
    for (auto _ : state)
        measure_thickness(cracks, d.elements, d.bonds.i, d.bonds.j, 0.345 * R, micro, CountedVoid::crack);
}
BENCHMARK(thickness_of_25000_contact_beams)->Unit(benchmark::kSecond)->UseRealTime()->Iterations(5);

}  // namespace

BENCHMARK_MAIN();
