// Where void ends and matter begins: thresholds read from the histogram of gray levels [2.4.1, Fig. 4].
//
// The paper's convention: void where gray < S. Public tools give t with void where gray <= t: S = t + 1.

#pragma once

#include "craze/core/mask.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace craze::microstructure {

/// Voxels of each gray level.
using Histogram = std::array<std::int64_t, 256>;

Histogram histogram(const Volume<std::uint8_t>& gray);

/// The two-level image with the same first three moments (Tsai 1985).
struct TwoLevels {
    double z0 = 0.0, z1 = 0.0;  ///< gray levels of void and matter, z0 < z1
    double p0 = 0.0;            ///< fraction of void
};
/// Nothing where the histogram has a single level.
std::optional<TwoLevels> preserving_moments(const Histogram& histogram);

/// S of each method, 1 ... 255; nothing where the histogram has a single level.
///
/// Moment-preserving (Tsai, Comput. Vis. Graph. Image Process. 29 (1985) 377): t is the first level whose cumulative
/// fraction exceeds p0.
std::optional<int> moments_threshold(const Histogram& histogram);
/// Greatest variance between classes (Otsu, IEEE Trans. Syst. Man Cybern. 9 (1979) 62); the last of equal maxima.
std::optional<int> otsu_threshold(const Histogram& histogram);
/// Greatest sum of the entropies of both classes (Kapur, Sahoo, Wong, ibid. 29 (1985) 273); the first of equal maxima.
std::optional<int> entropy_threshold(const Histogram& histogram);

/// true where gray >= S: matter is true.
Mask matter_of(const Volume<std::uint8_t>& gray, int S);

}  // namespace craze::microstructure
