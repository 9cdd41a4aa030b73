// Skeletons, the alpha shape and what is measured on it, at an eighth of the paper's volume; the last two make the
// paper's own size. All threads unless said.

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/mesh/alpha_shape.hpp"
#include "craze/mesh/medial_surface.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/mesh/skeleton.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

namespace {

using craze::Mask;
using craze::Shape;
using craze::Vec3;

// Wavy discs 1.2 to 4.2 px thick of random place and direction until `share` of the volume is crack.
Mask cracks(Shape shape, double share)
{
    Mask mask(shape);
    craze::Random random(11);
    const auto wanted = static_cast<std::int64_t>(share * static_cast<double>(shape.voxels()));
    std::int64_t made = 0;
    while (made < wanted) {
        const Vec3 centre{random.uniform(0, static_cast<double>(shape.nx)),
                          random.uniform(0, static_cast<double>(shape.ny)),
                          random.uniform(0, static_cast<double>(shape.nz))};
        const Vec3 n = craze::normalized({random.normal(), random.normal(), random.normal()});
        const Vec3 u = craze::normalized(std::abs(n.x) < 0.7 ? craze::cross(n, {1, 0, 0}) : craze::cross(n, {0, 1, 0}));
        const Vec3 v = craze::cross(n, u);
        const double radius = random.uniform(15, 60), half = random.uniform(0.6, 2.1), wave = random.uniform(1, 5),
                     phase = random.uniform(0, 6.28);
        for (double a = -radius; a <= radius; a += 0.5)
            for (double b = -radius; b <= radius; b += 0.5) {
                if (a * a + b * b > radius * radius) continue;
                const double lift = wave * std::sin(a * 0.12 + phase) * std::cos(b * 0.1);
                for (double c = -half; c <= half; c += 0.4) {
                    const Vec3 p = centre + a * u + b * v + (lift + c) * n;
                    const auto x = static_cast<std::int64_t>(std::floor(p.x)),
                               y = static_cast<std::int64_t>(std::floor(p.y)),
                               z = static_cast<std::int64_t>(std::floor(p.z));
                    if (x < 0 || y < 0 || z < 0 || x >= shape.nx || y >= shape.ny || z >= shape.nz) continue;
                    if (!mask(x, y, z)) mask.set(x, y, z, true), ++made;
                }
            }
    }
    return mask;
}

constexpr Shape eighth{449, 373, 280}, paper{899, 746, 561};

// The share of the paper. Ours are thicker than the paper's where 4.7 % are needed for its 9 million triangles.
const Mask& small_cracks()
{
    static const Mask mask = cracks(eighth, 0.0295);
    return mask;
}

void quiet() { craze::set_verbosity(craze::Verbosity::quiet); }

void skeleton(benchmark::State& state)
{
    quiet();
    craze::set_threads(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(craze::mesh::skeleton_of_slices(small_cracks(), 2).count());
    state.SetItemsProcessed(state.iterations() * eighth.voxels());
    craze::set_threads(0);
}
BENCHMARK(skeleton)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void medial(benchmark::State& state)
{
    quiet();
    craze::set_threads(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(craze::mesh::medial_surface(small_cracks()).count());
    state.SetItemsProcessed(state.iterations() * eighth.voxels());
    craze::set_threads(0);
}
BENCHMARK(medial)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

// Arguments: threads, 100 alpha.
void alpha(benchmark::State& state)
{
    quiet();
    craze::set_threads(static_cast<int>(state.range(0)));
    static const Mask thin = craze::mesh::skeleton_of_slices(small_cracks(), 2);
    for (auto _ : state)
        benchmark::DoNotOptimize(
            craze::mesh::alpha_shape(thin, 0.01 * static_cast<double>(state.range(1))).triangles.size());
    state.SetItemsProcessed(state.iterations() * thin.count());
    craze::set_threads(0);
}
BENCHMARK(alpha)
    ->ArgsProduct({{1, 2}, {87, 142, 200, 300, 400}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

void measures(benchmark::State& state)
{
    quiet();
    static const craze::mesh::CrackSurface surface = craze::mesh::mesh_cracks(small_cracks(), 1e-6, {});
    for (auto _ : state) benchmark::DoNotOptimize(craze::mesh::measure(surface, small_cracks(), 1e-6).area);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(surface.triangles.size()));
}
BENCHMARK(measures)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

// The paper's volume, from mask to surface. Memory is what the peak grew by, so run it alone:
// --benchmark_filter=whole
void whole(benchmark::State& state)
{
    quiet();
    const Mask mask = cracks(paper, 0.047);
    const std::int64_t before = craze::peak_memory();
    std::size_t triangles = 0, vertices = 0;
    for (auto _ : state) {
        const craze::mesh::CrackSurface surface = craze::mesh::mesh_cracks(mask, 23.6e-9, {});
        triangles = surface.triangles.size(), vertices = surface.vertices.size();
    }
    state.counters["triangles"] = static_cast<double>(triangles);
    state.counters["points"] = static_cast<double>(vertices);
    state.counters["grown_bytes_per_point"] =
        static_cast<double>(craze::peak_memory() - before) / static_cast<double>(vertices);
}
BENCHMARK(whole)->Iterations(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

void whole_measures(benchmark::State& state)
{
    quiet();
    const Mask mask = cracks(paper, 0.047);
    const craze::mesh::CrackSurface surface = craze::mesh::mesh_cracks(mask, 23.6e-9, {});
    const std::int64_t before = craze::peak_memory();
    for (auto _ : state) benchmark::DoNotOptimize(craze::mesh::measure(surface, mask, 23.6e-9).area);
    state.counters["triangles"] = static_cast<double>(surface.triangles.size());
    state.counters["grown_bytes"] = static_cast<double>(craze::peak_memory() - before);
}
BENCHMARK(whole_measures)->Iterations(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
