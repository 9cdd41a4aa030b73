#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/microstructure/microstructure.hpp"

#include <fmt/format.h>

namespace craze::microstructure {

namespace {

constexpr std::uint8_t matter_value = 255, crack_value = 128, pore_value = 0;

void write_phase(const Microstructure& micro, const std::filesystem::path& file)
{
    const Shape& s = micro.matter.shape();
    const double h = micro.gray.voxel_size;
    const auto to = io::create_volume(file, {s, io::Sample::u8, {h, h, h}});
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(s.nx * s.ny));
    for (std::int64_t z = 0; z < s.nz; ++z) {
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x)
                slice[static_cast<std::size_t>(x + s.nx * y)] = micro.matter(x, y, z)  ? matter_value
                                                                : micro.crack(x, y, z) ? crack_value
                                                                                       : pore_value;
        to->append_slice(std::span<const std::uint8_t>(slice));
    }
    to->finish();
}

}  // namespace

void save(const Microstructure& micro, const std::filesystem::path& folder)
{
    write_phase(micro, folder / "phase.mhd");
    io::write_text(folder / "threshold.json", Json{{"threshold", micro.threshold}}.dump(2) + "\n");
}

void save(const Mask& mask, double voxel_size, const std::filesystem::path& file)
{
    const Shape& s = mask.shape();
    const auto to = io::create_volume(file, {s, io::Sample::u8, {voxel_size, voxel_size, voxel_size}});
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(s.nx * s.ny));
    for (std::int64_t z = 0; z < s.nz; ++z) {
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x)
                slice[static_cast<std::size_t>(x + s.nx * y)] = mask(x, y, z) ? 255 : 0;
        to->append_slice(std::span<const std::uint8_t>(slice));
    }
    to->finish();
}

Microstructure load_microstructure(const std::filesystem::path& folder, const std::filesystem::path& images_folder)
{
    Microstructure micro;
    const auto gray_file = images_folder / "gray.mhd", phase_file = folder / "phase.mhd";
    const auto gray = io::open_volume(gray_file);
    micro.gray = {io::read_volume<std::uint8_t>(*gray), gray->info().voxel_size.x};
    const auto phases = io::open_volume(phase_file);
    phases->require(io::Sample::u8);
    const Shape s = phases->info().shape;
    if (s != gray->info().shape)
        throw InvalidInput(
            fmt::format("{}: its {} x {} x {} voxels are not those of {}, {} x {} x {}; run "
                        "microstructure again",
                        phase_file.string(), s.nx, s.ny, s.nz, gray_file.string(), gray->info().shape.nx,
                        gray->info().shape.ny, gray->info().shape.nz));
    micro.matter = Mask(s), micro.pore = Mask(s), micro.crack = Mask(s);
    std::vector<std::uint8_t> slice(static_cast<std::size_t>(s.nx * s.ny));
    for (std::int64_t z = 0; z < s.nz; ++z) {
        phases->read_slice(z, std::span<std::uint8_t>(slice));
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x) {
                const std::uint8_t phase = slice[static_cast<std::size_t>(x + s.nx * y)];
                if (phase != matter_value && phase != crack_value && phase != pore_value)
                    throw InvalidInput(
                        fmt::format("{}: voxel ({}, {}, {}) needs 0 (pore), 128 (crack) or 255 "
                                    "(matter), got {}",
                                    phase_file.string(), x, y, z, phase));
                (phase == matter_value  ? micro.matter
                 : phase == crack_value ? micro.crack
                                        : micro.pore)
                    .set(x, y, z, true);
            }
    }
    const auto threshold_file = folder / "threshold.json";
    try {
        micro.threshold = Json::parse(io::read_text(threshold_file)).at("threshold").get<int>();
    } catch (const Json::exception& error) {
        throw InvalidInput(fmt::format("{}: cannot be understood ({}); run microstructure again",
                                       threshold_file.string(), error.what()));
    }
    return micro;
}

}  // namespace craze::microstructure
