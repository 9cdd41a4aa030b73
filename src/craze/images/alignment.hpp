// Slices moved back to where they belong [2.3 (1)].

#pragma once

#include "craze/images/fourier.hpp"
#include "craze/images/settings.hpp"

#include <complex>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <span>
#include <vector>

namespace craze::images {

/// px along x and y.
struct Shift {
    double x = 0.0, y = 0.0;
};

/// The content of slice b lies displaced by `by` against slice a.
struct PairShift {
    std::int64_t a = 0, b = 0;
    Shift by;
    double likeness = 1.0;  ///< correlation coefficient of the slices once b is moved back, at most 1
};

/// Measures displacements between slices that come in order: the highest cross-correlation of the slices, their
/// mean removed and faded out towards the borders, with a paraboloid through the nine values around its top.
class ShiftMeter {
public:
    ShiftMeter(std::int64_t nx, std::int64_t ny, const Alignment& settings);

    /// The next slices; their pairs with up to `neighbours` slices before each.
    std::vector<PairShift> add(const std::vector<std::vector<std::uint8_t>>& slices);

private:
    using Spectrum = std::vector<std::complex<float>>;
    Spectrum spectrum_of(std::span<const std::uint8_t> slice) const;
    struct Measured {
        Shift by;
        double likeness;
    };
    Measured displacement(const Spectrum& a, const Spectrum& b) const;
    double power_of(const Spectrum& spectrum) const;

    std::int64_t nx_, ny_, width_, height_, neighbours_, count_ = 0;
    double max_shift_;
    Fourier2D fourier_;
    std::vector<float> fade_x_, fade_y_;
    std::deque<Spectrum> before_;
};

/// Where every slice lies, from the pairs.
struct Positions {
    std::vector<Shift> at;       ///< of each slice against the first
    Shift drift;                 ///< px per slice: linear trend of `at`
    std::int64_t bad_pairs = 0;  ///< set aside by the robust fit
    std::int64_t pairs = 0;      ///< measured
    /// Whether the pairs know where the slices lie: at most a quarter was set aside. A stack with few large things in
    /// it, each going its own way, has no common displacement.
    bool known() const { return 4 * bad_pairs <= pairs; }
};

/// Least squares over all pairs, those that disagree with the rest weighing less and less; a slice whose pairs all
/// disagree is placed between its neighbours. Pairs much less alike than most say nothing: where a large pore begins,
/// two slices have little in common and the best of their correlations is chance.
Positions solve_positions(std::int64_t slices, std::span<const PairShift> pairs);

/// What to read where: aligned(x, y) = raw(x + shift.x, y + shift.y). Jumps (over 5 px) are undone, and what slices are
/// misplaced each for itself; slow displacements stay, as leaning cracks look just the same, unless remove_drift asks
/// for all. Shifts shorter than least_shift become zero.
std::vector<Shift> corrections(const Positions& positions, const Alignment& settings);

/// The part that every slice covers after its correction, as [x0, x1) x [y0, y1).
struct CommonCrop {
    std::int64_t x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};
/// @throws InvalidInput  when nothing is left
CommonCrop common_crop(std::span<const Shift> shifts, std::int64_t nx, std::int64_t ny);

/// raw(x + shift) for x, y in the crop, by a Lanczos kernel of six pixels; beyond the border the last pixel counts.
void shift_slice(std::span<const std::uint8_t> raw, std::int64_t nx, std::int64_t ny, const Shift& shift,
                 const CommonCrop& crop, std::span<float> to);

void save_transforms(const std::filesystem::path& file, std::span<const Shift> shifts);
/// @throws InvalidInput  naming file and line
std::vector<Shift> load_transforms(const std::filesystem::path& file, std::int64_t slices);

}  // namespace craze::images
