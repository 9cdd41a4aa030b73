#include "craze/core/mask.hpp"

#include <benchmark/benchmark.h>

namespace {

// The limit of everything that reads a whole mask once.
void count_mask(benchmark::State& state)
{
    const craze::Mask mask(craze::Shape{746, 561, 64});
    for (auto _ : state) benchmark::DoNotOptimize(mask.count());
    state.SetItemsProcessed(state.iterations() * mask.shape().voxels());
}
BENCHMARK(count_mask);

}  // namespace

BENCHMARK_MAIN();
