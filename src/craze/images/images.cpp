#include "craze/images/images.hpp"

#include "craze/core/json.hpp"
#include "craze/io/volume_file.hpp"

namespace craze::images {

namespace {

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

Json json_of(const Quality& q)
{
    return {{"step", q.step},
            {"noise", q.noise},
            {"noise_4px_apart", q.noise_apart},
            {"noise_correlated", q.correlated},
            {"stripes", q.stripes},
            {"gradient_per_voxel", json_of(q.gradient)},
            {"shading", q.shading},
            {"solid_level", q.solid},
            {"dark_level", q.dark},
            {"contrast_to_noise", q.contrast_to_noise}};
}

}  // namespace

Gray load_gray(const std::filesystem::path& folder)
{
    const auto reader = io::open_volume(folder / "gray.mhd");
    return {io::read_volume<std::uint8_t>(*reader), reader->info().voxel_size.x};
}

void save(const Gray& gray, const std::filesystem::path& folder)
{
    io::write_volume(folder / "gray.mhd", gray.level, gray.voxel_size);
}

Json summary(const Preprocessed& p)
{
    Json quality = Json::array();
    for (const Quality& q : p.quality) quality.push_back(json_of(q));
    return {{"raw_shape", {p.raw.nx, p.raw.ny, p.raw.nz}},
            {"shape", {p.shape.nx, p.shape.ny, p.shape.nz}},
            {"voxel_size_m", p.voxel_size},
            {"window", {p.low, p.high}},
            {"alignment",
             {{"common_crop", {p.kept.x0, p.kept.x1, p.kept.y0, p.kept.y1}},
              {"drift_px_per_slice", {p.drift.x, p.drift.y}},
              {"jitter_rms_px", p.jitter},
              {"largest_correction_px", p.largest_correction},
              {"bad_pairs", p.bad_pairs}}},
            {"denoise", {{"sigma", p.sigma}, {"h", p.h}}},
            {"homogenise", {{"gradient_per_voxel", json_of(p.gradient)}, {"direction", json_of(p.layers)}}},
            {"quality", quality},
            {"seconds", p.seconds}};
}

}  // namespace craze::images
