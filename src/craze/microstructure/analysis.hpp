// What is said of a microstructure: thresholds, porosities, single pores and cracks, thickness [2.4.1, 2.6, Fig. 7].

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/microstructure/microstructure.hpp"
#include "craze/microstructure/objects.hpp"
#include "craze/microstructure/porosity.hpp"
#include "craze/microstructure/thickness.hpp"
#include "craze/microstructure/threshold.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace craze::microstructure {

struct Analysis {
    Histogram levels{};                         ///< voxels of each gray level
    std::optional<int> moments, otsu, entropy;  ///< S by each method
    Porosity whole;
    PorosityProfiles profiles;
    std::vector<Scatter> scatter;
    std::vector<Object> pores, cracks;                          ///< single ones, in the order of their first voxels
    std::vector<double> diameters;                              ///< px, levels of local thickness
    std::vector<std::int64_t> pore_thickness, crack_thickness;  ///< voxels at each level: thickness_histogram
    double R_C = 0.0;                                           ///< px, with which pores were told from cracks
};

Analysis analyse(const Microstructure& micro, const Settings& settings);

/// CSV: `histogram`, `porosity_x`, `porosity_y`, `porosity_z`, `porosity_scatter`, `pores`, `cracks`, `thickness`.
void save(const Analysis& analysis, const Microstructure& micro, const std::filesystem::path& folder);

/// The keys of docs/results.md.
Json summary(const Microstructure& micro, const Analysis& analysis);

}  // namespace craze::microstructure
