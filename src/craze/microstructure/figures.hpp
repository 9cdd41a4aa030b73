// Pictures of slices: gray, binary, pores and cracks in colour [Figs. 4 and 6].

#pragma once

#include "craze/io/picture.hpp"
#include "craze/microstructure/microstructure.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace craze::microstructure {

/// Slice z in colour: gray levels, pores blue, cracks red. Shrunk by a whole factor until no wider than `most` px.
io::Picture phases_over_gray(const Volume<std::uint8_t>& gray, const Mask& pore, const Mask& crack, std::int64_t z,
                             std::int64_t most = 480);

/// Slice z as the segmentation gives it: matter white, void black.
io::Picture binary_slice(const Mask& matter, std::int64_t z, std::int64_t most = 480);

/// Slice z as it is.
io::Picture gray_slice(const Volume<std::uint8_t>& gray, std::int64_t z, std::int64_t most = 480);

/// A picture with a word above it.
struct Tile {
    io::Picture picture;
    std::string word;  ///< digits, some capitals, . and =
    bool framed = false;
};

/// Tiles of equal size, `columns` in a row.
io::Picture montage(const std::vector<Tile>& tiles, std::int64_t columns);

/// `thresholds.png`: three slices segmented by each method, side by side [Fig. 4]; `phases.png`: the same slices with
/// pores and cracks over gray.
void save_figures(const Microstructure& micro, const std::filesystem::path& folder);

/// Img. 1a and 1b of Fig. 6 as volumes, `closed.mhd` and `enlarged.mhd`: 255 matter, 0 void; and `pore_labels.mhd`,
/// `crack_labels.mhd`: the label of each voxel in `pores.csv` and `cracks.csv`, 0 outside (16 bits, or floats beyond
/// 65 535 objects).
void save_intermediates(const Microstructure& micro, const Settings& settings, const std::filesystem::path& folder);

}  // namespace craze::microstructure
