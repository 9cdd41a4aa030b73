// One benchmark per claim of speed of the microstructure room, on a synthetic coating of 300^3 voxels.

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/microstructure/analysis.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/morphology.hpp"
#include "craze/synth/synth.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace craze;
using namespace craze::microstructure;

const synth::Observation& coating()
{
    static const synth::Observation seen = [] {
        const synth::Settings settings;
        return synth::observe(synth::make_coating(settings), settings);
    }();
    return seen;
}

const Mask& matter()
{
    static const Mask mask = matter_of(coating().label, 200);
    return mask;
}

const Mask& empty()
{
    static const Mask mask = complement(matter());
    return mask;
}

void per_voxel(benchmark::State& state)
{
    const auto voxels = static_cast<double>(matter().shape().voxels());
    state.counters["ns/voxel"] =
        benchmark::Counter(voxels * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void histogram_of_levels(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(histogram(coating().stack.level));
    per_voxel(state);
}
BENCHMARK(histogram_of_levels)->UseRealTime()->Unit(benchmark::kMillisecond);

void threshold_to_mask(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(matter_of(coating().stack.level, 120));
    per_voxel(state);
}
BENCHMARK(threshold_to_mask)->UseRealTime()->Unit(benchmark::kMillisecond);

// Argument: twice the radius, px.
void closing(benchmark::State& state)
{
    const Ball ball(static_cast<double>(state.range(0)) / 2);
    for (auto _ : state) benchmark::DoNotOptimize(closed(matter(), ball));
    per_voxel(state);
}
BENCHMARK(closing)->Arg(3)->Arg(9)->Arg(17)->Arg(41)->UseRealTime()->Unit(benchmark::kMillisecond);

void erosion(benchmark::State& state)
{
    const Ball ball(static_cast<double>(state.range(0)) / 2);
    for (auto _ : state) benchmark::DoNotOptimize(eroded(matter(), ball));
    per_voxel(state);
}
BENCHMARK(erosion)->Arg(9)->UseRealTime()->Unit(benchmark::kMillisecond);

void classification_of_figure_6(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(classified(matter(), 8.5, 4.5));
    per_voxel(state);
}
BENCHMARK(classification_of_figure_6)->UseRealTime()->Unit(benchmark::kMillisecond);

void distance_of_void_to_matter(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(squared_distance(matter()));
    per_voxel(state);
}
BENCHMARK(distance_of_void_to_matter)->UseRealTime()->Unit(benchmark::kMillisecond);

void distance_of_matter_to_void(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(squared_distance(empty()));
    per_voxel(state);
}
BENCHMARK(distance_of_matter_to_void)->UseRealTime()->Unit(benchmark::kMillisecond);

// Far from everything: the slow road of the transform.
void distance_to_one_voxel(benchmark::State& state)
{
    Mask one(matter().shape());
    one.set(1, 2, 3, true);
    for (auto _ : state) benchmark::DoNotOptimize(squared_distance(one));
    per_voxel(state);
}
BENCHMARK(distance_to_one_voxel)->UseRealTime()->Unit(benchmark::kMillisecond);

// Argument: 0 corners (26), 1 edges (18), 2 faces (6).
void labels(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(components(empty(), static_cast<Connectivity>(state.range(0))));
    per_voxel(state);
}
BENCHMARK(labels)->Arg(0)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void labels_painted(benchmark::State& state)
{
    for (auto _ : state) benchmark::DoNotOptimize(painted(components(empty())));
    per_voxel(state);
}
BENCHMARK(labels_painted)->UseRealTime()->Unit(benchmark::kMillisecond);

void single_objects(benchmark::State& state)
{
    const auto squared = squared_distance(matter());
    for (auto _ : state) benchmark::DoNotOptimize(measured(empty(), components(empty()), squared));
    per_voxel(state);
}
BENCHMARK(single_objects)->UseRealTime()->Unit(benchmark::kMillisecond);

void thickness_in_half_pixels(benchmark::State& state)
{
    const auto squared = squared_distance(matter());
    for (auto _ : state) benchmark::DoNotOptimize(local_thickness(squared, 0.5));
    per_voxel(state);
}
BENCHMARK(thickness_in_half_pixels)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv)
{
    craze::set_verbosity(craze::Verbosity::quiet);
    matter();
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
