#include "craze/core/random.hpp"
#include "craze/images/non_local_means.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>

namespace {

using namespace craze;

Volume<std::uint8_t> coating(Shape shape)
{
    Volume<std::uint8_t> v(shape);
    for (std::int64_t z = 0; z < shape.nz; ++z)
        for (std::int64_t y = 0; y < shape.ny; ++y) {
            Random random(1, static_cast<std::uint64_t>(y + shape.ny * z));
            for (auto& value : v.row(y, z)) {
                const double level = ((y + z / 2) % 61 < 2 ? 45.0 : 165.0) + 12.0 * random.normal();
                value = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
            }
        }
    return v;
}

void filter(benchmark::State& state, Shape shape, bool in_volume)
{
    const auto v = coating(shape);
    const images::NonLocalMeans settings{21, 5, in_volume, 12.0, 7.2};
    for (auto _ : state) benchmark::DoNotOptimize(images::non_local_means(v, settings).data());
    state.counters["us/voxel"] =
        benchmark::Counter(static_cast<double>(v.shape().voxels()) * 1e-6,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
void non_local_means_3d(benchmark::State& state) { filter(state, {448, 128, 64}, true); }
void non_local_means_2d(benchmark::State& state) { filter(state, {448, 128, 16}, false); }
// For non_local_means_peer.py.
void non_local_means_peer(benchmark::State& state) { filter(state, {428, 80, 48}, true); }
BENCHMARK(non_local_means_peer)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(non_local_means_3d)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(non_local_means_2d)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
