// Real micrographs against the masks of experts.

#include "craze/core/progress.hpp"
#include "craze/io/volume_file.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/microstructure.hpp"
#include "craze/microstructure/morphology.hpp"
#include "craze/microstructure/objects.hpp"
#include "craze/microstructure/sheets.hpp"
#include "craze/microstructure/threshold.hpp"
#include "support/data.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

namespace craze::microstructure {
namespace {

TEST(FracturedRock, SheetsAgreeWithTheExpertMask)
{
    const auto folder = support::data_folder() / "fractured_rock";
    CRAZE_NEEDS_DATA(folder);
    Settings settings;
    settings.threshold = ThresholdMethod::fixed;
    settings.level = 60;  // below nearly all of the rock: cracks are found as sheets
    settings.sheets.on = true;
    images::Gray gray{io::read_volume<std::uint8_t>(folder / "stack_8bit.tif"), 1e-6};
    const Microstructure micro = classify(std::move(gray), settings);
    const auto expert = io::read_volume<std::uint8_t>(folder / "expert_fracture_mask_slices_10_to_89.tif");
    std::int64_t both = 0, sum = 0;
    for (std::int64_t z = 0; z < expert.shape().nz; ++z)
        for (std::int64_t y = 0; y < expert.shape().ny; ++y)
            for (std::int64_t x = 0; x < expert.shape().nx; ++x) {
                const bool found = !micro.matter(x, y, z + 10), truth = expert(x, y, z) >= 128;
                both += found && truth ? 1 : 0;
                sum += (found ? 1 : 0) + (truth ? 1 : 0);
            }
    const double dice = 2.0 * static_cast<double>(both) / static_cast<double>(sum);
    std::cout << fmt::format("fractured rock: Dice {:.4f} (2D non-local means + Otsu: 0.756)\n", dice);
    EXPECT_GE(dice, 0.87);
}

// Hits within 3 px: the experts' lines are a few px wide.
struct Score {
    double near_truth = 0, found = 0, near_found = 0, truth = 0;

    void add(const Mask& mask, const Mask& expert)
    {
        near_truth += static_cast<double>(intersection(mask, dilated(expert, Ball(3.0))).count());
        found += static_cast<double>(mask.count());
        near_found += static_cast<double>(intersection(expert, dilated(mask, Ball(3.0))).count());
        truth += static_cast<double>(expert.count());
    }
    double precision() const { return near_truth / found; }
    double recall() const { return near_found / truth; }
    double f1() const { return 2 * precision() * recall() / (precision() + recall()); }
    void say(const char* name) const
    {
        std::cout << fmt::format("{}: precision {:.3f}, recall {:.3f}, F1 {:.3f}\n", name, precision(), recall(), f1());
    }
};

Mask otsu(const Volume<std::uint8_t>& gray, const Mask& layer)
{
    Histogram levels{};
    for (std::int64_t y = 0; y < gray.shape().ny; ++y)
        for (std::int64_t x = 0; x < gray.shape().nx; ++x)
            if (layer(x, y, 0)) ++levels[gray(x, y, 0)];
    return intersection(complement(matter_of(gray, otsu_threshold(levels).value())), layer);
}

// Sauvola and Pietikainen, Pattern Recognit. 33 (2000) 225: gray < m (1 + k (s / R - 1)) over a window.
Mask sauvola(const Volume<std::uint8_t>& gray, const Mask& layer)
{
    constexpr std::int64_t half = 15;
    constexpr double k = 0.2, R = 128;
    const Shape s = gray.shape();
    Mask dark(s);
    for (std::int64_t y = 0; y < s.ny; ++y)
        for (std::int64_t x = 0; x < s.nx; ++x) {
            if (!layer(x, y, 0)) continue;
            double n = 0, sum = 0, squares = 0;
            for (std::int64_t j = std::max<std::int64_t>(0, y - half); j <= std::min(s.ny - 1, y + half); ++j)
                for (std::int64_t i = std::max<std::int64_t>(0, x - half); i <= std::min(s.nx - 1, x + half); ++i) {
                    const double v = gray(i, j, 0);
                    n += 1, sum += v, squares += v * v;
                }
            const double m = sum / n, deviation = std::sqrt(std::max(0.0, squares / n - m * m));
            if (gray(x, y, 0) < m * (1 + k * (deviation / R - 1))) dark.set(x, y, 0, true);
        }
    return dark;
}

// Lines of the response inside the layer, at least 60 px long.
Mask lines(const Volume<std::uint8_t>& gray, const Mask& layer)
{
    auto response = sheet_response(gray, {1.5, 2.5});
    for (std::int64_t y = 0; y < gray.shape().ny; ++y)
        for (std::int64_t x = 0; x < gray.shape().nx; ++x)
            if (!layer(x, y, 0)) response(x, y, 0) = 0.0F;
    const Mask found = hysteresis(response, 4, 10, 10);
    const Components each = components(found);
    std::vector<std::uint8_t> keep;
    for (const Object& o : measured(found, each, squared_distance(complement(found))))
        keep.push_back(2 * o.semi_axes[0] >= 60 ? 1 : 0);
    return selected(each, keep);
}

TEST(SprayedCoating, CracksOfTheOxideLayerAreFoundBetterThanByThresholds)
{
    const auto folder = support::data_folder() / "sprayed_coating_sem";
    CRAZE_NEEDS_DATA(folder);
    Score by_otsu, by_sauvola, by_lines;
    for (int i = 1; i <= 4; ++i) {
        const auto gray = io::read_volume<std::uint8_t>(folder / fmt::format("coating_{}.tif", i));
        const auto mask = io::read_volume<std::uint8_t>(folder / fmt::format("coating_{}_mask.tif", i));
        const Mask layer = matter_of(mask, 1), crack = matter_of(mask, 2);
        by_otsu.add(otsu(gray, layer), crack);
        by_sauvola.add(sauvola(gray, layer), crack);
        by_lines.add(lines(gray, layer), crack);
    }
    by_otsu.say("Otsu");
    by_sauvola.say("Sauvola");
    by_lines.say("craze, sheets");
    EXPECT_GT(by_lines.f1(), by_otsu.f1());
    EXPECT_GT(by_lines.f1(), by_sauvola.f1());
}

}  // namespace
}  // namespace craze::microstructure
