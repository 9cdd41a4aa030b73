#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/images/fingerprint.hpp"
#include "craze/images/homogenise.hpp"
#include "craze/images/images.hpp"
#include "craze/images/levels.hpp"
#include "craze/images/non_local_means.hpp"
#include "craze/images/resample.hpp"
#include "craze/images/stripes.hpp"
#include "craze/images/work_volume.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace craze::images {

namespace fs = std::filesystem;

namespace {

using Slice = std::vector<std::uint8_t>;

/// One run over one stack: the steps in order, each from disk to disk.
class Run {
public:
    Run(const Settings& settings, fs::path folder)
        : settings_(settings),
          folder_(std::move(folder)),
          work_(folder_ / "work"),
          source_(settings),
          journal_(work_ / "journal.json", fingerprint(settings))
    {
        fs::create_directories(work_);
        done_.raw = source_.shape();
        done_.low = source_.low(), done_.high = source_.high();
        say(fmt::format("images: {} slices of {} x {}", done_.raw.nz, done_.raw.nx, done_.raw.ny));
    }

    Preprocessed all()
    {
        look("raw", source_.shape(), [&](std::int64_t z, std::span<std::uint8_t> to) { source_.read(z, to); });
        find_shifts();
        clean_slices();
        denoise();
        homogenise();
        write_spectra();
        if (!settings_.keep_steps) fs::remove_all(work_);
        done_.seconds = watch_.seconds();
        return std::move(done_);
    }

private:
    void look(const std::string& step, Shape shape, const SliceReader& read)
    {
        done_.quality.push_back(quality_of(step, shape, read, settings_.stripes.axis, settings_.stripes.protect));
        write_strip(folder_ / fmt::format("strip_{}_{}.png", done_.quality.size(), step), shape, read);
    }

    // Slices worked on at once.
    std::int64_t batch_size() const
    {
        const auto per_slice = static_cast<double>(source_.shape().nx * source_.shape().ny) * 24.0;
        return std::clamp<std::int64_t>(static_cast<std::int64_t>(settings_.memory / per_slice), threads(), 32);
    }

    std::vector<Slice> read_batch(std::int64_t z0, std::int64_t z1)
    {
        std::vector<Slice> slices(static_cast<std::size_t>(z1 - z0));
        for (std::int64_t z = z0; z < z1; ++z) {
            Slice& slice = slices[static_cast<std::size_t>(z - z0)];
            slice.resize(static_cast<std::size_t>(source_.shape().nx * source_.shape().ny));
            source_.read(z, slice);
        }
        return slices;
    }

    void find_shifts()
    {
        const auto [nx, ny, nz] = source_.shape();
        const Alignment& how = settings_.alignment;
        shifts_.assign(static_cast<std::size_t>(nz), Shift{});
        if (!how.transforms.empty() && how.on) {
            shifts_ = load_transforms(how.transforms, nz);
        } else if (how.on && nz > 1 && nx >= 16 && ny >= 16) {
            if (journal_.get("measured") == 1.0)
                recall_shifts();
            else
                measure_shifts();
        }
        done_.kept = common_crop(shifts_, nx, ny);
        double square = 0.0;
        for (const Shift& s : shifts_) {
            done_.largest_correction = std::max({done_.largest_correction, std::abs(s.x), std::abs(s.y)});
            square += s.x * s.x + s.y * s.y;
        }
        done_.jitter = std::sqrt(square / static_cast<double>(nz));
        save_transforms(folder_ / "transforms.csv", shifts_);
        if (how.on)
            say(fmt::format(
                "images: corrections of {:.2f} px rms, {:.2f} px at most; {} x {} px are common to all slices",
                done_.jitter, done_.largest_correction, done_.kept.x1 - done_.kept.x0, done_.kept.y1 - done_.kept.y0));
    }

    void measure_shifts()
    {
        const auto [nx, ny, nz] = source_.shape();
        ShiftMeter meter(nx, ny, settings_.alignment);
        std::vector<PairShift> pairs;
        Progress progress("images: alignment", nz);
        for (std::int64_t z = 0; z < nz;) {
            const std::int64_t end = std::min(nz, z + batch_size());
            const auto found = meter.add(read_batch(z, end));
            pairs.insert(pairs.end(), found.begin(), found.end());
            progress.advance(end - z);
            z = end;
        }
        const Positions positions = solve_positions(nz, pairs);
        shifts_ = corrections(positions, settings_.alignment);
        if (!positions.known())
            notice(fmt::format(
                "images: {} of {} pairs of slices disagree with the others, so the slices stay where they are; "
                "more neighbours (images.alignment.neighbours) or a larger crop may tell",
                positions.bad_pairs, positions.pairs));
        done_.drift = positions.drift;
        done_.bad_pairs = positions.bad_pairs;
        save_transforms(work_ / "transforms.csv", shifts_);
        journal_.set("drift_x", positions.drift.x);
        journal_.set("drift_y", positions.drift.y);
        journal_.set("bad_pairs", static_cast<double>(positions.bad_pairs));
        journal_.set("measured", 1.0);
    }

    void recall_shifts()
    {
        shifts_ = load_transforms(work_ / "transforms.csv", source_.shape().nz);
        done_.drift = {journal_.get("drift_x"), journal_.get("drift_y")};
        done_.bad_pairs = static_cast<std::int64_t>(journal_.get("bad_pairs"));
    }

    // Alignment and stripes: each slice by itself.
    void clean_slices()
    {
        const Shape raw = source_.shape(), shape{done_.kept.x1 - done_.kept.x0, done_.kept.y1 - done_.kept.y0, raw.nz};
        current_.emplace(work_ / "cleaned.raw", shape);
        auto z = static_cast<std::int64_t>(journal_.get("cleaned"));
        const StripeFilter stripes(shape.nx, shape.ny, settings_.stripes);
        Progress progress("images: stripes", shape.nz - z);
        while (z < shape.nz) {
            const std::int64_t end = std::min(shape.nz, z + batch_size());
            const std::vector<Slice> slices = read_batch(z, end);
            std::vector<Slice> results(slices.size());
            parallel_tasks(end - z, [&](std::int64_t i) {
                std::vector<float> slice(static_cast<std::size_t>(shape.nx * shape.ny));
                shift_slice(slices[static_cast<std::size_t>(i)], raw.nx, raw.ny,
                            shifts_[static_cast<std::size_t>(z + i)], done_.kept, slice);
                stripes.remove(slice);
                Slice& result = results[static_cast<std::size_t>(i)];
                result.resize(slice.size());
                for (std::size_t p = 0; p < slice.size(); ++p)
                    result[p] = static_cast<std::uint8_t>(std::clamp(slice[p] + 0.5F, 0.0F, 255.0F));
            });
            for (std::int64_t i = z; i < end; ++i) current_->write(i, results[static_cast<std::size_t>(i - z)]);
            current_->sync();
            journal_.set("cleaned", static_cast<double>(end));
            progress.advance(end - z);
            z = end;
        }
        look("stripes", shape, reader());
    }

    SliceReader reader()
    {
        return [this](std::int64_t z, std::span<std::uint8_t> to) { current_->read(z, to); };
    }

    void denoise()
    {
        const Denoise& how = settings_.denoise;
        if (how.method == Denoise::Method::none) return;
        const Shape shape = current_->shape();
        NonLocalMeans filter;
        filter.search = how.search;
        filter.neighbourhood = how.neighbourhood;
        filter.in_volume = how.method == Denoise::Method::nlm3d;
        // Neighbourhoods far apart differ by all of the noise, however alike neighbours are.
        const Quality& now = done_.quality.back();
        filter.sigma = how.sigma.value_or(now.correlated ? now.noise_apart : now.noise);
        if (now.correlated && !how.sigma)
            notice(
                fmt::format("images: the noise is correlated, {:.2f} gray levels between neighbours and {:.2f} "
                            "between voxels 4 px apart; taken as {:.2f} (images.denoise.sigma sets it)",
                            now.noise, now.noise_apart, now.noise_apart));
        filter.h = how.h.value_or(std::max(0.5, how.strength * filter.sigma));
        done_.sigma = filter.sigma, done_.h = filter.h;
        say(fmt::format("images: noise {:.2f} gray levels, non-local means with h = {:.2f}", filter.sigma, filter.h));
        // Slabs of like thickness: thin ones spend much on the voxels between them.
        constexpr std::int64_t thick = 192;
        std::int64_t slab = (shape.nz + (shape.nz + thick - 1) / thick - 1) / ((shape.nz + thick - 1) / thick);
        while (slab > 1 && static_cast<double>(memory_of_slab(filter, shape, slab)) > settings_.memory) --slab;
        if (static_cast<double>(memory_of_slab(filter, shape, slab)) > settings_.memory)
            notice(fmt::format("images.memory: one slice and its surroundings fill {} MB; going on with that",
                               memory_of_slab(filter, shape, slab) / 1'000'000));
        WorkVolume to(work_ / "denoised.raw", shape);
        auto z = static_cast<std::int64_t>(journal_.get("denoised"));
        Progress progress("images: non-local means", shape.nz - z);
        double finished = 0.0;
        std::int64_t shown = 0;
        while (z < shape.nz) {
            const std::int64_t end = std::min(shape.nz, z + slab);
            const auto advance = [&](double share) {
                finished += share * static_cast<double>(end - z);
                const auto whole = static_cast<std::int64_t>(finished);
                if (whole > shown)
                    progress.advance(whole - std::exchange(shown, whole));
                else
                    progress.advance(0);
            };
            filter_slab(
                filter, shape, z, end, reader(),
                [&](std::int64_t k, std::span<const std::uint8_t> from) { to.write(k, from); }, advance);
            to.sync();
            journal_.set("denoised", static_cast<double>(end));
            z = end;
        }
        current_.emplace(std::move(to));
        look("denoise", shape, reader());
    }

    void homogenise()
    {
        const Shape shape = current_->shape();
        std::optional<Homogeniser> homogeniser;
        Slice slice(static_cast<std::size_t>(shape.nx * shape.ny));
        if (settings_.homogenise.on) {
            Progress progress("images: homogenisation", 3 * shape.nz);
            const auto each = [&](const auto& use) {
                for (std::int64_t z = 0; z < shape.nz; ++z) {
                    current_->read(z, slice);
                    use(z);
                    progress.advance();
                }
            };
            Histogram histogram{};
            each([&](std::int64_t) {
                const Histogram h = histogram_of(slice);
                for (std::size_t v = 0; v < 256; ++v) histogram[v] += h[v];
            });
            homogeniser.emplace(shape, settings_.homogenise, histogram);
            each([&](std::int64_t z) { homogeniser->fit(z, slice); });
            each([&](std::int64_t z) { homogeniser->learn(z, slice); });
            homogeniser->settle();
            done_.gradient = homogeniser->gradient(), done_.layers = homogeniser->direction();
            std::string text = "layer,level\n";
            for (std::size_t i = 0; i < homogeniser->profile().size(); ++i)
                text += fmt::format("{},{:.4f}\n", i, homogeniser->profile()[i]);
            io::write_text(folder_ / "profile.csv", text);
        }
        CubicVoxels cubes(shape, source_.voxel_size(), [&](std::int64_t z, std::span<std::uint8_t> to) {
            if (!homogeniser) return current_->read(z, to);
            current_->read(z, slice);
            homogeniser->remove(z, slice, to);
        });
        done_.shape = cubes.shape(), done_.voxel_size = cubes.edge();
        if (cubes.needed())
            say(fmt::format("images: voxels resampled to cubes, {} x {} x {}", done_.shape.nx, done_.shape.ny,
                            done_.shape.nz));
        const double h = cubes.edge();
        const auto gray = io::create_volume(folder_ / "gray.mhd", {done_.shape, io::Sample::u8, {h, h, h}});
        Slice result(static_cast<std::size_t>(done_.shape.nx * done_.shape.ny));
        for (std::int64_t z = 0; z < done_.shape.nz; ++z) {
            check_interrupt();
            if (cubes.needed())
                cubes.read(z, result);
            else if (homogeniser)
                current_->read(z, slice), homogeniser->remove(z, slice, result);
            else
                current_->read(z, result);
            gray->append_slice(std::span<const std::uint8_t>(result));
        }
        gray->finish();
        const auto written = io::open_volume(folder_ / "gray.mhd");
        look(homogeniser ? "homogenise" : "given", done_.shape,
             [&](std::int64_t z, std::span<std::uint8_t> to) { written->read_slice(z, to); });
    }

    void write_spectra() const
    {
        std::string text = "waves_per_pixel";
        std::size_t most = 0;
        for (const Quality& q : done_.quality) text += "," + q.step, most = std::max(most, q.spectrum.size());
        text += '\n';
        const auto extent = static_cast<double>(done_.quality.front().spectrum.size());
        for (std::size_t m = 0; m < most; ++m) {
            text += fmt::format("{:.6f}", static_cast<double>(m) / (2.0 * extent));
            for (const Quality& q : done_.quality)
                text += m < q.spectrum.size() ? fmt::format(",{:.6g}", q.spectrum[m]) : ",";
            text += '\n';
        }
        io::write_text(folder_ / "spectrum.csv", text);
    }

    const Settings& settings_;
    fs::path folder_, work_;
    LevelSource source_;
    Journal journal_;
    Stopwatch watch_;
    Preprocessed done_;
    std::vector<Shift> shifts_;
    std::optional<WorkVolume> current_;
};

}  // namespace

Preprocessed preprocess(const Settings& settings, const fs::path& folder)
{
    check(settings);
    fs::create_directories(folder);
    return Run(settings, folder).all();
}

}  // namespace craze::images
