#include "craze/microstructure/sweep.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/microstructure/distance.hpp"
#include "craze/microstructure/figures.hpp"
#include "craze/microstructure/morphology.hpp"
#include "craze/microstructure/objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace craze::microstructure {

namespace {

constexpr double elongated = 4.0;     // longest semi-axis over inscribed radius
constexpr double shell_depth = 0.75;  // of R_C: a ball of R_C stays (sqrt 3 - 1) R_C short of the corner of a cube

double share(std::int64_t part, std::int64_t whole)
{
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

double thin_share(const Mask& pores, const Volume<std::int32_t>& squared)
{
    std::int64_t thin = 0, all = 0;
    for (const Object& object : measured(pores, components(pores), squared)) {
        all += object.volume;
        if (object.semi_axes[0] > elongated * object.inscribed_radius) thin += object.volume;
    }
    return share(thin, all);
}

double shell_share(const Mask& closed_pores, double R_C, const Mask& crack, const Components& cracks)
{
    const Mask far = difference(crack, dilated(closed_pores, Ball(shell_depth * R_C)));
    std::vector<std::uint8_t> shell(static_cast<std::size_t>(cracks.count), 1);
    const Shape& s = crack.shape();
    for (std::int64_t r = 0; r < s.ny * s.nz; ++r) {
        const auto row = far.row(r % s.ny, r / s.ny);
        for (auto i = cracks.row_begin[static_cast<std::size_t>(r)];
             i < cracks.row_begin[static_cast<std::size_t>(r) + 1]; ++i) {
            const Run& run = cracks.runs[static_cast<std::size_t>(i)];
            auto& is_shell = shell[static_cast<std::size_t>(run.label)];
            for (std::int32_t x = run.first; is_shell != 0 && x <= run.last; ++x)
                if (((row[static_cast<std::size_t>(x >> 6)] >> (x & 63)) & 1U) != 0) is_shell = 0;
        }
    }
    const auto volume = volumes(cracks);
    std::int64_t in_shells = 0, all = 0;
    for (std::size_t k = 0; k < volume.size(); ++k) {
        all += volume[k];
        if (shell[k] != 0) in_shells += volume[k];
    }
    return share(in_shells, all);
}

SweepRow tried(const Mask& matter, double R_C, double R_E, Border border, const Volume<std::int32_t>* squared)
{
    const Classification c = classified(matter, R_C, R_E, border);
    const Components cracks = components(c.crack);
    SweepRow row{R_C, R_E, {porosity(c.pore), porosity(c.crack)}, components(c.pore).count, cracks.count};
    if (squared != nullptr) row.thin_share = thin_share(c.closed, *squared);
    row.shell_share = shell_share(c.closed, R_C, c.crack, cracks);
    return row;
}

// The first row with at most `limit`, else the one with least.
const SweepRow& chosen(const std::vector<SweepRow>& rows, double SweepRow::*measure, double limit, const char* what)
{
    for (const SweepRow& row : rows)
        if (row.*measure <= limit) return row;
    const auto& best = *std::min_element(
        rows.begin(), rows.end(), [measure](const SweepRow& a, const SweepRow& b) { return a.*measure < b.*measure; });
    notice(fmt::format("microstructure sweep: no {} brings its measure down to {:.3g}; the best reaches {:.3g}", what,
                       limit, best.*measure));
    return best;
}

std::string csv_of(const std::vector<SweepRow>& rows)
{
    std::string csv = "R_C_px,R_E_px,porosity_pores,porosity_cracks,pores,cracks,thin_share,shell_share\n";
    for (const SweepRow& r : rows)
        fmt::format_to(std::back_inserter(csv), "{},{},{:.6f},{:.6f},{},{},{:.6f},{:.6f}\n", r.R_C, r.R_E,
                       r.porosity.pores, r.porosity.cracks, r.pores, r.cracks, r.thin_share, r.shell_share);
    return csv;
}

void draw(const std::vector<SweepRow>& rows, double R_C, double R_E, bool erosion, const images::Gray& gray,
          const Mask& matter, Border border, const std::filesystem::path& file)
{
    std::vector<Tile> tiles;
    for (const SweepRow& row : rows) {
        const Classification c = classified(matter, row.R_C, row.R_E, border);
        tiles.push_back({phases_over_gray(gray.level, c.pore, c.crack, gray.level.shape().nz / 2, 320),
                         erosion ? fmt::format("RE={}", row.R_E) : fmt::format("RC=RE={}", row.R_C),
                         erosion ? row.R_E == R_E : row.R_C == R_C});
    }
    io::write_png(file, montage(tiles, 5));
}

}  // namespace

Sweep swept(const Mask& matter, const Settings& settings)
{
    const SweepSettings& s = settings.sweep;
    if (matter.count() == matter.shape().voxels())
        throw InvalidInput("microstructure sweep: there is no void; is the threshold too low?");
    const Volume<std::int32_t> squared = squared_distance(matter);
    const auto steps = static_cast<std::int64_t>((s.most - s.least) / s.step + 1e-9) + 1;
    Progress progress("sweep of R_C and R_E", 2 * steps);
    Sweep sweep;
    for (std::int64_t i = 0; i < steps; ++i, progress.advance()) {
        const double R = s.least + static_cast<double>(i) * s.step;
        sweep.closing.push_back(tried(matter, R, R, settings.border, &squared));
    }
    sweep.R_C = chosen(sweep.closing, &SweepRow::thin_share, s.thin_share, "R_C").R_C;
    std::vector<SweepRow> up_to_R_C;
    for (std::int64_t i = 0; i < steps; ++i, progress.advance()) {
        const double R = s.least + static_cast<double>(i) * s.step;
        sweep.erosion.push_back(tried(matter, sweep.R_C, R, settings.border, nullptr));
        if (R <= sweep.R_C) up_to_R_C.push_back(sweep.erosion.back());
    }
    sweep.R_E = chosen(up_to_R_C, &SweepRow::shell_share, s.shell_share, "R_E").R_E;
    return sweep;
}

void save(const Sweep& sweep, const images::Gray& gray, const Mask& matter, const Settings& settings,
          const std::filesystem::path& folder)
{
    io::write_text(folder / "sweep_R_C.csv", csv_of(sweep.closing));
    io::write_text(folder / "sweep_R_E.csv", csv_of(sweep.erosion));
    draw(sweep.closing, sweep.R_C, sweep.R_E, false, gray, matter, settings.border, folder / "sweep_R_C.png");
    draw(sweep.erosion, sweep.R_C, sweep.R_E, true, gray, matter, settings.border, folder / "sweep_R_E.png");
}

Json summary(const Sweep& sweep)
{
    const auto rows = [](const std::vector<SweepRow>& from) {
        Json list = Json::array();
        for (const SweepRow& r : from)
            list.push_back({{"R_C_px", r.R_C},
                            {"R_E_px", r.R_E},
                            {"pores", r.porosity.pores},
                            {"cracks", r.porosity.cracks},
                            {"thin_share", r.thin_share},
                            {"shell_share", r.shell_share}});
        return list;
    };
    return {{"proposed", {{"R_C_px", sweep.R_C}, {"R_E_px", sweep.R_E}}},
            {"closing", rows(sweep.closing)},
            {"erosion", rows(sweep.erosion)}};
}

}  // namespace craze::microstructure
