#include "craze/microstructure/microstructure.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/microstructure/classification.hpp"
#include "craze/microstructure/sheets.hpp"
#include "craze/microstructure/threshold.hpp"

#include <fmt/format.h>

namespace craze::microstructure {

void describe(Schema& schema, Settings& s)
{
    schema.option("threshold", s.threshold, {"moments", "otsu", "entropy", "fixed"},
                  "how the gray level that parts void from matter is found");
    schema.integer("level", s.level, {1, 255}, "for the method fixed: void where gray < level");
    schema.quantity("R_C", s.R_C, Dimension::pixel, {0, 500}, "closing radius: void that holds this ball is a pore");
    schema.quantity("R_E", s.R_E, Dimension::pixel, {0, 500},
                    "erosion radius: how far pores are enlarged to regain their outline");
    schema.option("border", s.border, {"open", "matter"},
                  "what lies behind the border of the volume: neither matter nor void, or matter");
    schema.option("connectivity", s.connectivity, {"corners", "edges", "faces"},
                  "voxels that hang together to one pore or crack: 26, 18 or 6 neighbours");
    schema.quantity("thickness_step", s.thickness_step, Dimension::pixel, {0.25, 10},
                    "step of the radii tried for local thickness");
    schema.flag("intermediates", s.intermediates,
                "write the closed and the enlarged pores of Fig. 6 and the label of every pore and crack too");
    schema.flag("figures", s.figures, "write pictures");
    schema.group("sheets", "cracks thinner than their blur, found by the curvature of gray levels", [&] {
        schema.flag("on", s.sheets.on, "take dark sheets for void besides what the threshold finds");
        schema.quantities("scales", s.sheets.scales, Dimension::pixel, {0.5, 20}, "sigma of the smoothing, each tried");
        schema.number("low", s.sheets.low, {0, 255}, "response of a sheet, gray levels, where it joins a certain one");
        schema.number("high", s.sheets.high, {0, 255}, "response that makes a sheet certain, gray levels");
        schema.integer("least", s.sheets.least, {1, 1e9}, "smallest sheet kept, voxels");
    });
    schema.group("sweep", "what --sweep tries for R_C and R_E, and what it takes for good", [&] {
        schema.quantity("least", s.sweep.least, Dimension::pixel, {0.5, 100}, "smallest radius");
        schema.quantity("most", s.sweep.most, Dimension::pixel, {0.5, 100}, "largest radius");
        schema.quantity("step", s.sweep.step, Dimension::pixel, {0.1, 20}, "between radii");
        schema.quantity("thin_share", s.sweep.thin_share, Dimension::fraction, {0, 1},
                        "share of the closed pores that may be thin elongated objects");
        schema.quantity("shell_share", s.sweep.shell_share, Dimension::fraction, {0, 1},
                        "share of the cracks that may be shells around pores");
    });
}

void check(const Settings& s)
{
    if (s.sheets.high < s.sheets.low)
        throw InvalidInput(fmt::format("microstructure.sheets.high: needs at least sheets.low ({}), got {}",
                                       s.sheets.low, s.sheets.high));
    if (s.sheets.scales.empty()) throw InvalidInput("microstructure.sheets.scales: needs at least one scale");
    if (s.sweep.most < s.sweep.least)
        throw InvalidInput(fmt::format("microstructure.sweep.most: needs at least sweep.least ({} px), got {} px",
                                       s.sweep.least, s.sweep.most));
    if (s.R_E > s.R_C)
        throw InvalidInput(
            fmt::format("microstructure.R_E: needs a radius up to R_C ({} px), got {} px; a larger one "
                        "would take cracks for pores",
                        s.R_C, s.R_E));
}

Microstructure classify(images::Gray gray, const Settings& settings)
{
    check(settings);
    if (gray.level.empty()) throw InvalidInput("microstructure: the gray volume is empty");
    int S = static_cast<int>(settings.level);
    if (settings.threshold != ThresholdMethod::fixed) {
        const Histogram levels = histogram(gray.level);
        const auto found = settings.threshold == ThresholdMethod::moments ? moments_threshold(levels)
                           : settings.threshold == ThresholdMethod::otsu  ? otsu_threshold(levels)
                                                                          : entropy_threshold(levels);
        if (!found)
            throw InvalidInput(
                "microstructure.threshold: the volume has one gray level only, no method can part void from matter; "
                "set threshold = \"fixed\" and level");
        S = *found;
    }
    Microstructure micro;
    micro.matter = matter_of(gray.level, S);
    if (settings.sheets.on) {
        const SheetSettings& sheets = settings.sheets;
        micro.matter = difference(
            micro.matter, hysteresis(sheet_response(gray.level, sheets.scales), sheets.low, sheets.high, sheets.least));
    }
    if (micro.matter.count() == 0)
        throw ComputationFailed(
            fmt::format("microstructure: all {} voxels are below the threshold {}: no matter is "
                        "left; is the threshold too high, or the picture inverted (void must be dark)?",
                        gray.level.shape().voxels(), S));
    micro.threshold = S;
    micro.gray = std::move(gray);
    Classification c = classified(micro.matter, settings.R_C, settings.R_E, settings.border);
    micro.pore = std::move(c.pore);
    micro.crack = std::move(c.crack);
    if (micro.matter.count() == micro.gray.level.shape().voxels())
        notice(fmt::format("microstructure: no voxel is below the threshold {}: there is no void", S));
    else if (micro.pore.count() == 0)
        notice(fmt::format("microstructure: no void holds a ball of R_C = {} px: all of it is called crack",
                           settings.R_C));
    return micro;
}

}  // namespace craze::microstructure
