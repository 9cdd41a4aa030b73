// Pores and cracks: thresholds, porosities, sizes [2.4, 2.6, Figs. 4, 6, 7].

#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <tuple>

namespace craze::report {

namespace {

void gray_histogram(Work& work, const Json& summary)
{
    const auto csv = work.folder.csv("microstructure", "histogram.csv");
    if (!csv) return;
    const auto voxels = csv->numbers("voxels");
    const double all = std::accumulate(voxels.begin(), voxels.end(), 0.0);
    Figure f;
    f.id = "gray_histogram";
    f.caption =
        "Gray levels of the cleaned stack and the thresholds of three methods; voxels below the threshold are void.";
    f.paper = work.figure("Fig. 4");
    f.x = {"gray level", false, 0.0, 255.0};
    f.y.title = "share of voxels [%]";
    f.series = {{"", csv->numbers("level"), over(voxels, all * percent)}};
    const double used = find_number(summary, {"threshold.used"});
    bool shown = false;
    for (const auto& [key, name] :
         {std::pair{"threshold.otsu", "Otsu"}, {"threshold.moments", "moments"}, {"threshold.entropy", "entropy"}}) {
        const double at = find_number(summary, {key});
        if (!std::isfinite(at)) continue;
        shown = shown || at == used;
        f.guides.push_back({at, fmt::format("{} {:.0f}{}", name, at, at == used ? " (used)" : "")});
    }
    if (!shown && std::isfinite(used)) f.guides.push_back({used, fmt::format("fixed {:.0f} (used)", used)});
    work.page.figure(f);
}

void profiles(Work& work)
{
    Figure along_z, totals;
    along_z.id = "porosity_profile";
    along_z.caption = "Porosity of each slice along z.";
    along_z.x.title = "z [µm]";
    totals.id = "porosity_directions";
    totals.caption = "Total porosity of slices across each direction.";
    totals.x.title = "position [µm]";
    along_z.y = totals.y = {"porosity [%]", false, 0.0};
    for (const char axis : {'x', 'y', 'z'}) {
        const auto csv = work.folder.csv("microstructure", fmt::format("porosity_{}.csv", axis));
        if (!csv) continue;
        const auto at = over(csv->numbers(0), micro);
        totals.series.push_back({std::string("along ") + axis, at, over(csv->numbers("total"), percent)});
        if (axis != 'z') continue;
        for (const char* what : {"total", "pores", "cracks"})
            along_z.series.push_back({what, at, over(csv->numbers(what), percent)});
    }
    work.page.figure(along_z);
    work.page.figure(totals);
}

void representativeness(Work& work)
{
    const auto csv = work.folder.csv("microstructure", "porosity_scatter.csv");
    if (!csv) return;
    Figure f;
    f.id = "porosity_scatter";
    f.caption =
        "Standard deviation of the porosity of cubes against their edge: where it is small beside the porosity itself, "
        "such a cube "
        "stands for the whole.";
    f.x = {"edge of the cube [µm]", true};
    f.y = {"standard deviation of porosity [%]", true};
    for (const char* what : {"total", "pores", "cracks"})
        f.series.push_back(
            {what, over(csv->numbers("edge_m"), micro), over(csv->numbers(std::string(what) + "_deviation"), percent)});
    work.page.figure(f);
}

void pore_sizes(Work& work, const Json& summary)
{
    const auto csv = work.folder.csv("microstructure", "pores.csv");
    const double h = find_number(summary, {"voxel_size"}), R_C = find_number(summary, {"R_C_px"});
    if (!csv || !(h > 0.0)) return;
    auto radii = csv->numbers("inscribed_radius_px");
    Figure f;
    f.id = "pore_balls";
    f.caption =
        fmt::format("Largest ball inside each of the {} pores.", format_number(static_cast<double>(radii.size()), 9));
    f.paper = work.figure("Fig. 7b");
    f.x.title = "radius of the largest ball [µm]";
    f.y.title = "pores";
    f.series = {histogram("", radii, {}, micro / h)};
    if (std::isfinite(R_C)) f.guides.push_back({R_C * h / micro, fmt::format("R_C = {:.3g} µm", R_C * h / micro)});
    work.page.figure(f);
}

void local_thickness(Work& work)
{
    const auto csv = work.folder.csv("microstructure", "thickness.csv");
    if (!csv) return;
    Figure f;
    f.id = "local_thickness";
    f.caption = "Local thickness: diameter of the largest ball that holds a voxel of the void.";
    f.x = {"diameter [nm]", false, 0.0};
    f.y.title = "share of its volume [%]";
    for (const auto& [column, name] : {std::pair{"pore_voxels", "pores"}, {"crack_voxels", "cracks"}}) {
        auto voxels = csv->numbers(column);
        const double all = std::accumulate(voxels.begin(), voxels.end(), 0.0);
        if (all > 0.0) f.series.push_back({name, over(csv->numbers("diameter_m"), nano), over(voxels, all * percent)});
    }
    work.page.figure(f);
}

/// What the sweep of R_C and R_E measured [2.4.3], where one was asked for.
void sweeps(Work& work, const Json& summary)
{
    for (const auto& [file, id, radius, measure, caption] :
         {std::tuple{"sweep_R_C.csv", "sweep_R_C", "R_C_px", "thin_share",
                     "Closing radius tried with R_E = R_C: void classified as pore though thin, and porosities."},
          {"sweep_R_E.csv", "sweep_R_E", "R_E_px", "shell_share",
           "Erosion radius tried at the chosen R_C: crack voxels that are shells around pores, and porosities."}}) {
        const auto csv = work.folder.csv("microstructure", file);
        if (!csv) continue;
        Figure f;
        f.id = id;
        f.caption = caption;
        f.x.title = radius == std::string_view("R_C_px") ? "R_C = R_E [px]" : "R_E [px]";
        f.y = {"share [%]", false, 0.0};
        const auto at = csv->numbers(radius);
        f.series = {{measure == std::string_view("thin_share") ? "thin objects among pores" : "shells among cracks", at,
                     over(csv->numbers(measure), percent)},
                    {"porosity, pores", at, over(csv->numbers("porosity_pores"), percent)},
                    {"porosity, cracks", at, over(csv->numbers("porosity_cracks"), percent)}};
        const double proposed = find_number(summary, {fmt::format("sweep.proposed.{}", radius)});
        if (std::isfinite(proposed)) f.guides = {{proposed, fmt::format("proposed {:.3g} px", proposed)}};
        work.page.figure(f);
    }
}

}  // namespace

void write_microstructure(Work& work)
{
    if (!begin_room(work, "microstructure", "Pores and cracks")) return;
    const Json& summary = work.folder.summary("microstructure");
    work.page.add("<div class=\"row\">");
    gray_histogram(work, summary);
    pore_sizes(work, summary);
    profiles(work);
    local_thickness(work);
    representativeness(work);
    sweeps(work, summary);
    work.page.add("</div>");
    const auto picture = [&](std::string_view file, std::string_view caption, std::string_view paper) {
        const auto path = work.folder.room("microstructure") / file;
        if (std::filesystem::is_regular_file(path))
            work.page.picture(fmt::format("microstructure_{}", path.stem().string()), io::read_text(path), caption,
                              work.figure(paper));
    };
    picture("thresholds.png", "Three slices segmented by each threshold; framed: the one used.", "Fig. 4");
    picture("phases.png", "Three slices: gray levels, matter and void, pores (blue) and cracks (red).", "Fig. 6");
    picture("sweep_R_C.png", "The middle slice classified with each R_C = R_E.", "");
    picture("sweep_R_E.png", "The middle slice classified with each R_E.", "");
    end_room(work, "microstructure");
}

}  // namespace craze::report
