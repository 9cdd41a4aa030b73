// The steps of images by themselves, and, with CRAZE_FULL_SIZE=<folder for 2 GB>, the whole room at the paper's size:
// synthetic coating of 899 x 746 x 561 voxels (or CRAZE_SHAPE="nx ny nz"), from the stack on disk to gray.mhd.

#include "craze/images/images.hpp"

#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/random.hpp"
#include "craze/images/homogenise.hpp"
#include "craze/images/stripes.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/synth/synth.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

namespace {

using namespace craze;

constexpr Shape shape{899, 746, 16};

const Volume<std::uint8_t>& coating()
{
    static const Volume<std::uint8_t> volume = [] {
        Volume<std::uint8_t> v(shape);
        for (std::int64_t z = 0; z < shape.nz; ++z)
            for (std::int64_t y = 0; y < shape.ny; ++y) {
                Random random(1, static_cast<std::uint64_t>(y + shape.ny * z));
                const double stripe = 4.0 * random.normal();
                std::int64_t x = 0;
                for (auto& value : v.row(y, z)) {
                    const bool dark = ((x++ / 3 + y + z / 2) % 61) < 3;
                    value = static_cast<std::uint8_t>(
                        std::clamp((dark ? 45.0 : 165.0) + stripe + 12.0 * random.normal(), 0.0, 255.0));
                }
            }
        return v;
    }();
    return volume;
}

void per_voxel(benchmark::State& state)
{
    state.counters["ns/voxel"] =
        benchmark::Counter(static_cast<double>(shape.voxels()) * 1e-9,
                           benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Slices in parallel, as preprocess does it.
void stripes(benchmark::State& state, images::Stripes::Method method)
{
    images::Stripes how;
    how.method = method;
    const images::StripeFilter filter(shape.nx, shape.ny, how);
    const Volume<std::uint8_t>& volume = coating();
    for (auto _ : state)
        parallel_tasks(shape.nz, [&](std::int64_t z) {
            const auto from = volume.slice(z);
            std::vector<float> slice(from.begin(), from.end());
            filter.remove(slice);
            benchmark::DoNotOptimize(slice.data());
        });
    per_voxel(state);
}
void stripe_notch(benchmark::State& state) { stripes(state, images::Stripes::Method::notch); }
void stripe_wavelet(benchmark::State& state) { stripes(state, images::Stripes::Method::wavelet); }
BENCHMARK(stripe_notch)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(stripe_wavelet)->Unit(benchmark::kMillisecond)->UseRealTime();

// Measuring against four neighbours and moving each slice.
void alignment(benchmark::State& state)
{
    std::vector<std::vector<std::uint8_t>> slices;
    for (std::int64_t z = 0; z < shape.nz; ++z)
        slices.emplace_back(coating().slice(z).begin(), coating().slice(z).end());
    const images::Shift shift{0.4, -0.3};
    for (auto _ : state) {
        images::ShiftMeter meter(shape.nx, shape.ny, {});
        benchmark::DoNotOptimize(meter.add(slices).size());
        const images::CommonCrop all{0, shape.nx, 0, shape.ny};
        parallel_tasks(shape.nz, [&](std::int64_t z) {
            std::vector<float> moved(slices.front().size());
            images::shift_slice(slices[static_cast<std::size_t>(z)], shape.nx, shape.ny, shift, all, moved);
            benchmark::DoNotOptimize(moved.data());
        });
    }
    per_voxel(state);
}
BENCHMARK(alignment)->Unit(benchmark::kMillisecond)->UseRealTime();

// Histogram, fit, profile along the gradient, removal: what a stack in memory costs.
void homogenisation(benchmark::State& state)
{
    const Volume<std::uint8_t>& volume = coating();
    std::vector<std::uint8_t> result(volume.slice(0).size());
    for (auto _ : state) {
        images::Homogeniser homogeniser(shape, {}, images::histogram_of(volume.values()));
        for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.fit(z, volume.slice(z));
        for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.learn(z, volume.slice(z));
        homogeniser.settle();
        for (std::int64_t z = 0; z < shape.nz; ++z) homogeniser.remove(z, volume.slice(z), result);
        benchmark::DoNotOptimize(result.data());
    }
    per_voxel(state);
}
BENCHMARK(homogenisation)->Unit(benchmark::kMillisecond)->UseRealTime();

int whole_room(const std::filesystem::path& folder)
{
    Shape size{899, 746, 561};
    if (const char* said = std::getenv("CRAZE_SHAPE")) std::istringstream(said) >> size.nx >> size.ny >> size.nz;
    if (!std::filesystem::exists(folder / "stack.tif")) {
        synth::Settings recipe;
        recipe.shape = {size.nx, size.ny, size.nz};
        const auto coating = synth::make_coating(recipe);
        synth::save(coating, synth::observe(coating, recipe), recipe, folder);
        std::printf("stack.tif written; run once more to clean it in a process of its own\n");
        return 0;
    }
    images::Settings s;
    s.source = (folder / "stack.tif").string();
    s.voxel_size = {23.6e-9};
    const auto done = images::preprocess(s, folder / "images");
    std::printf("images %lld x %lld x %lld: %.1f s, %.3f us/voxel, peak memory %.2f GB\n",
                static_cast<long long>(done.shape.nx), static_cast<long long>(done.shape.ny),
                static_cast<long long>(done.shape.nz), done.seconds,
                1e6 * done.seconds / static_cast<double>(done.shape.voxels()),
                1e-9 * static_cast<double>(peak_memory()));
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    if (const char* folder = std::getenv("CRAZE_FULL_SIZE")) return whole_room(folder);
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
