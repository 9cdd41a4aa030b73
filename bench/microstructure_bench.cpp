// One benchmark per claim of speed of the microstructure room, on a synthetic coating of 300^3 voxels.

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/microstructure/analysis.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/morphology.hpp"
#include "craze/synth/synth.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>

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

// The paper's 899 slices of 746 x 561: the coating mirrored until it fills them, with noise of sigma 8.
images::Gray full_size()
{
    const auto& label = coating().label;
    const Shape from = label.shape(), s{746, 561, 899};
    images::Gray gray{Volume<std::uint8_t>(s), 23.6e-9};
    const auto mirrored = [](std::int64_t i, std::int64_t n) {
        const std::int64_t k = i % (2 * n);
        return k < n ? k : 2 * n - 1 - k;
    };
    parallel_tasks(s.nz, [&](std::int64_t z) {
        Random random(1, static_cast<std::uint64_t>(z));
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x) {
                const bool solid = label(mirrored(x, from.nx), mirrored(y, from.ny), mirrored(z, from.nz)) == 255;
                const double noise = 8 * std::sqrt(6.0) * (random.uniform() + random.uniform() - 1);
                gray.level(x, y, z) = static_cast<std::uint8_t>((solid ? 165 : 45) + noise);
            }
    });
    return gray;
}

// All of the room at the paper's size. Asked for by CRAZE_FULL_SIZE=1: it needs 4 GB.
void whole_room_at_full_size(benchmark::State& state)
{
    const Settings settings;
    for (auto _ : state) {
        state.PauseTiming();
        auto gray = full_size();
        state.ResumeTiming();
        const Stopwatch watch;
        const Microstructure micro = classify(std::move(gray), settings);
        state.counters["classify s"] = watch.seconds();
        const Analysis analysis = analyse(micro, settings);
        state.counters["pores"] = static_cast<double>(analysis.pores.size());
    }
    state.counters["peak GB"] = static_cast<double>(peak_memory()) * 1e-9;
}

}  // namespace

int main(int argc, char** argv)
{
    craze::set_verbosity(craze::Verbosity::quiet);
    matter();
    if (std::getenv("CRAZE_FULL_SIZE") != nullptr)
        benchmark::RegisterBenchmark("whole_room_at_full_size", whole_room_at_full_size)
            ->UseRealTime()
            ->MeasureProcessCPUTime()
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
}
