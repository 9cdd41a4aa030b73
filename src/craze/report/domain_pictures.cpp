#include "craze/report/domain_pictures.hpp"

#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/report/render.hpp"
#include "craze/report/scene_data.hpp"
#include "craze/report/slices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace craze::report {

namespace {

constexpr const char* matter_colour = "#b9c0ca";
constexpr const char* cracked_colour = "#e8a070";

/// Elements with a cut bond; those in pores apart.
std::vector<std::uint8_t> touched_by_cracks(const domain::Discretisation& d)
{
    std::vector<std::uint8_t> out(d.in_pore.size(), 0);
    for (std::size_t b = 0; b < d.bonds.cut.size(); ++b)
        if (d.bonds.cut[b] != 0)
            out[static_cast<std::size_t>(d.dense.bonds.i[b])] = out[static_cast<std::size_t>(d.dense.bonds.j[b])] = 1;
    return out;
}

/// A crack counts where both ends of the bond are matter.
bool is_contact_beam(const domain::Discretisation& d, std::size_t b)
{
    return d.bonds.cut[b] != 0 && d.in_pore[static_cast<std::size_t>(d.dense.bonds.i[b])] == 0 &&
           d.in_pore[static_cast<std::size_t>(d.dense.bonds.j[b])] == 0;
}

double quantile(std::vector<double> values, double q)
{
    if (values.empty()) return 0.0;
    const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

struct Balls {
    std::vector<Vec3> centres;
    std::vector<double> radii;
    void add(const Vec3& c, double r) { centres.push_back(c), radii.push_back(r); }
};

struct Cuts {
    std::vector<Vec3> ends;
    std::vector<double> thickness;  // T2, m
};

std::string still_of(const Scene& scene, const Settings& settings)
{
    return io::png_bytes(render(scene, {settings.render_width, settings.render_width * 3 / 4}));
}

}  // namespace

double share_shown(const domain::Domain& dense, std::int64_t most)
{
    const auto count = [&](double share) {
        std::int64_t inside = 0;
        for (std::int32_t e = 0; e < dense.elements.size(); ++e) {
            const Vec3 c = dense.elements.centre(e);
            bool in = true;
            for (int axis = 0; axis < 3; ++axis) in = in && std::abs(c[axis] / dense.box[axis] - 0.5) <= 0.5 * share;
            inside += in;
        }
        return inside;
    };
    if (dense.elements.size() <= most) return 1.0;
    double share = std::cbrt(static_cast<double>(most) / static_cast<double>(dense.elements.size()));
    while (count(share) > most) share *= 0.99;
    return share;
}

Figure thickness_figure(const domain::Discretisation& d)
{
    std::vector<double> T1, T2;
    for (std::size_t b = 0; b < d.bonds.cut.size(); ++b)
        if (is_contact_beam(d, b)) T1.push_back(d.bonds.T1[b]), T2.push_back(d.bonds.T2[b]);
    Figure f;
    f.id = "crack_thickness";
    f.x.title = "crack thickness [nm]";
    f.y.title = "contact beams [%]";
    if (T1.empty()) return f;
    f.caption = fmt::format(
        "Thickness of the crack in each of {} contact beams, by voxels (T1) and by gray levels (T2); median T2 {:.3g} "
        "nm.",
        format_number(static_cast<double>(T2.size()), 9), quantile(T2, 0.5) / nano);
    const double most = std::max({quantile(T1, 0.995), quantile(T2, 0.995), 4.0 * nano});
    const int bins = std::clamp(static_cast<int>(most / (4.0 * nano)), 1, 100);
    const double one = 100.0 / static_cast<double>(T1.size());
    const std::vector<double> weights(T1.size(), one);
    f.series = {histogram("T2, intensity [Eq. 15]", T2, weights, nano, bins, most)};
    auto binary = histogram("T1, binary [Eq. 14]", T1, weights, nano, bins, most);
    for (std::size_t k = 0; k + 1 < binary.x.size(); ++k) binary.x[k] = 0.5 * (binary.x[k] + binary.x[k + 1]);
    binary.x.pop_back();
    binary.mark = Mark::dashed;
    f.series.push_back(std::move(binary));
    return f;
}

Figure voxel_size_figure(const Json& study)
{
    Figure f;
    f.id = "voxel_sizes";
    f.x.title = "crack thickness [nm]";
    f.y.title = "contact beams [%]";
    std::string medians;
    int colour = 0;
    for (const Json& at : study) {
        const double all = at.value("cut_bonds", 0.0), bar = at.value("bar_m", 0.0) / nano;
        if (!(all > 0.0)) continue;
        const std::string size = fmt::format("{:.3g} nm", at.value("voxel_size_m", 0.0) / nano);
        for (const auto& [key, name, mark] : {std::tuple{"T2", "T2", Mark::line}, {"T1", "T1", Mark::dashed}}) {
            Series s{fmt::format("{}, voxels of {}", name, size), {}, {}, mark, colour};
            for (const Json& count : at[key]["counts"]) {
                s.x.push_back((static_cast<double>(s.x.size()) + 0.5) * bar);
                s.y.push_back(100.0 * count.get<double>() / all);
            }
            f.series.push_back(std::move(s));
        }
        ++colour;
        medians += fmt::format("; voxels of {}: {:.0f} bonds cut, medians T2 {:.3g}, T1 {:.3g} nm", size, all,
                               at["T2"].value("median_m", 0.0) / nano, at["T1"].value("median_m", 0.0) / nano);
    }
    std::size_t shown = 0;  // bars up to the last that holds a thousandth
    for (const Series& s : f.series)
        for (std::size_t k = shown; k < s.y.size(); ++k)
            if (s.y[k] > 0.1) shown = k + 1;
    for (Series& s : f.series) s.x.resize(std::min(shown, s.x.size())), s.y.resize(s.x.size());
    f.caption =
        "Thickness of the crack in each cut bond where the stack is seen with coarser voxels and threshold, classes, "
        "surface and cut bonds are made again" +
        medians + ".";
    return f;
}

void draw_domain(Work& work, const domain::Discretisation& d)
{
    const auto& elements = d.dense.elements;
    const auto touched = touched_by_cracks(d);
    const double share = share_shown(d.dense, work.settings.elements);
    const Vec3 low = d.dense.box * (0.5 * (1.0 - share)), box = d.dense.box * share;
    const auto shown = [&](const Vec3& c) {
        for (int axis = 0; axis < 3; ++axis)
            if (c[axis] < low[axis] || c[axis] > low[axis] + box[axis]) return false;
        return true;
    };

    Scene whole, removed, cut;
    whole.box = removed.box = cut.box = d.dense.box;
    Balls matter, cracked, pores;
    const Colour plain = colour_of(matter_colour), warm = colour_of(cracked_colour);
    for (std::int32_t e = 0; e < elements.size(); ++e) {
        const auto k = static_cast<std::size_t>(e);
        const Vec3 c = elements.centre(e);
        const bool pore = d.in_pore[k] != 0;
        if (pore)
            removed.spheres.push_back({c, elements.r[k], viridis(c.z / d.dense.box.z)});
        else
            whole.spheres.push_back({c, elements.r[k], touched[k] != 0 ? warm : plain});
        if (shown(c)) (pore ? pores : touched[k] != 0 ? cracked : matter).add(c - low, elements.r[k]);
    }
    Cuts cuts;
    std::vector<double> all_T2;
    for (std::size_t b = 0; b < d.bonds.cut.size(); ++b)
        if (is_contact_beam(d, b)) all_T2.push_back(d.bonds.T2[b]);
    const double T2_most = std::max(quantile(all_T2, 0.95), 1e-12);
    for (std::size_t b = 0; b < d.bonds.cut.size(); ++b) {
        if (!is_contact_beam(d, b)) continue;
        const Vec3 from = elements.centre(d.dense.bonds.i[b]), to = elements.centre(d.dense.bonds.j[b]);
        cut.sticks.push_back({from, to, 0.22 * d.dense.mean_radius, viridis(d.bonds.T2[b] / T2_most)});
        if (!shown(from) || !shown(to)) continue;
        cuts.ends.push_back(from - low), cuts.ends.push_back(to - low);
        cuts.thickness.push_back(d.bonds.T2[b]);
    }
    std::vector<std::uint8_t> shade;
    for (const double T : cuts.thickness)
        shade.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, T / T2_most))));

    const double extent = std::max({box.x, box.y, box.z});
    std::vector<Json> parts{balls_part("matter", matter_colour, matter.centres, matter.radii, {}, extent),
                            balls_part("beside a crack", cracked_colour, cracked.centres, cracked.radii, {}, extent),
                            balls_part("taken by pores", pore_colour, pores.centres, pores.radii, {}, extent),
                            lines_part("bonds cut by cracks", crack_colour, cuts.ends, shade, extent)};
    parts[2]["hidden"] = true;
    const auto caption = fmt::format(
        "The discrete domain: elements of matter, those beside a crack in orange; elements taken by pores and the "
        "bonds that cracks cut can be shown "
        "too.{}",
        share < 1.0
            ? fmt::format(" The page shows the middle {:.0f} % of each edge; the picture shows all.", 100.0 * share)
            : std::string());
    work.page.viewer("domain_scene", "scene",
                     scene_json(box, std::move(parts), "T2 of cut bonds [nm]", 0.0, std::round(T2_most / nano)),
                     caption, still_of(whole, work.settings), work.figure("Fig. 10"));
    check_interrupt();
    work.page.add("<div class=\"row\">");
    if (!removed.spheres.empty())
        work.page.picture("removed_elements", still_of(removed, work.settings),
                          fmt::format("The {} elements whose centres lie in pores, coloured by height.",
                                      format_number(static_cast<double>(removed.spheres.size()), 9)),
                          work.figure("Fig. 12"));
    if (!cut.sticks.empty())
        work.page.picture(
            "cut_bonds", still_of(cut, work.settings),
            fmt::format(
                "The {} bonds that cross a crack, coloured by its thickness T2 from 0 (dark) to {:.3g} nm (yellow).",
                format_number(static_cast<double>(cut.sticks.size()), 9), T2_most / nano),
            work.figure("Fig. 13"));
    work.page.add("</div>");
}

}  // namespace craze::report
