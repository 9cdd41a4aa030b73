#include "craze/synth/synth.hpp"

#include "craze/core/progress.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace craze;

synth::Settings recipe(std::int64_t edge)
{
    synth::Settings s;
    s.shape = {edge, edge, edge};
    return s;
}

void place_defects(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(synth::make_coating(recipe(state.range(0))).cracks.size());
}
BENCHMARK(place_defects)->Arg(300)->Unit(benchmark::kMillisecond)->UseRealTime();

void observe_coating(benchmark::State& state)
{
    set_verbosity(Verbosity::quiet);
    const auto settings = recipe(state.range(0));
    const auto coating = synth::make_coating(settings);
    for (auto _ : state) benchmark::DoNotOptimize(synth::observe(coating, settings).fraction.total);
    state.SetItemsProcessed(state.iterations() * state.range(0) * state.range(0) * state.range(0));
}
BENCHMARK(observe_coating)->Arg(300)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
