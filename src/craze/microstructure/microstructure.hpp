// Which void is a pore, which a crack: the value that `microstructure` gives, and the door of the room.

#pragma once

#include "craze/core/mask.hpp"
#include "craze/core/schema.hpp"
#include "craze/images/gray.hpp"
#include "craze/microstructure/classification.hpp"
#include "craze/microstructure/labels.hpp"

#include <filesystem>
#include <vector>

namespace craze::microstructure {

/// Voxels told apart. `gray` and `threshold` travel along because Eq. 15 needs them late.
struct Microstructure {
    images::Gray gray;
    int threshold = 0;  ///< S: void where gray < S [2.4.1]
    Mask matter;        ///< img. 0 of Fig. 6: true = matter (the paper's white)
    Mask pore;          ///< img. 1c: true = void of a pore
    Mask crack;         ///< img. 2: true = void of a crack; matter, pore and crack fill the volume
};

enum class ThresholdMethod { moments = 0, otsu = 1, entropy = 2, fixed = 3 };

/// What the sweep tries, and what it takes for good: sweep.hpp.
struct SweepSettings {
    double least = 1.5, most = 20.5, step = 1.0;  ///< px
    double thin_share = 0.01;
    double shell_share = 5e-4;
};

/// Dark sheets found by their curvature besides the threshold: sheets.hpp.
struct SheetSettings {
    bool on = false;
    std::vector<double> scales{2, 3, 4};  ///< px
    double low = 5.0, high = 15.0;        ///< gray levels
    std::int64_t least = 100;             ///< voxels
};

struct Settings {
    ThresholdMethod threshold = ThresholdMethod::moments;
    std::int64_t level = 128;  ///< S of the method `fixed`: void where gray < S
    double R_C = 8.5;          ///< px, closing radius: what holds this ball is a pore
    double R_E = 4.5;          ///< px, erosion radius: how far pores are enlarged to regain their outline
    Border border = Border::open;
    Connectivity connectivity = Connectivity::corners;
    double thickness_step = 0.5;  ///< px, between the radii tried for local thickness
    bool intermediates = false;   ///< write img. 1a and 1b of Fig. 6 and labels too
    bool figures = true;          ///< write pictures
    SheetSettings sheets;
    SweepSettings sweep;
};

void describe(Schema& schema, Settings& settings);
/// @throws InvalidInput  when a value is no choice it could be
void check(const Settings& settings);

/// Matter by the threshold, without the sheets where those are asked for; then pores and cracks [2.4, Fig. 6].
/// @throws InvalidInput       when gray is empty, or has a single level and the method needs two
/// @throws ComputationFailed  when all is void
Microstructure classify(images::Gray gray, const Settings& settings);

/// `phase.mhd` (255 matter, 0 pore, 128 crack) and `threshold.json` in `folder`. The gray levels stay with `images`.
void save(const Microstructure& micro, const std::filesystem::path& folder);
/// One mask as `file` (.mhd): 255 in the set, 0 out of it.
void save(const Mask& mask, double voxel_size, const std::filesystem::path& file);
/// @throws InvalidInput  when a file is missing, or the phases and the gray levels differ in shape
Microstructure load_microstructure(const std::filesystem::path& folder, const std::filesystem::path& images_folder);

}  // namespace craze::microstructure
