#include "craze/microstructure/analysis.hpp"

#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/microstructure/distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace craze::microstructure {

namespace {

std::string objects_csv(const std::vector<Object>& objects)
{
    std::string csv =
        "label,volume_px3,surface_px2,equivalent_radius_px,inscribed_radius_px,mean_thickness_px,sphericity,"
        "centroid_x_px,centroid_y_px,centroid_z_px,semi_axis_a_px,semi_axis_b_px,semi_axis_c_px,major_x,major_y,major_"
        "z,minor_x,minor_y,minor_z,"
        "at_border\n";
    for (std::size_t k = 0; k < objects.size(); ++k) {
        const Object& o = objects[k];
        fmt::format_to(std::back_inserter(csv),
                       "{},{},{:.2f},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.5f},"
                       "{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{}\n",
                       k + 1, o.volume, o.surface, o.equivalent_radius, o.inscribed_radius, o.mean_thickness,
                       o.sphericity, o.centroid.x, o.centroid.y, o.centroid.z, o.semi_axes[0], o.semi_axes[1],
                       o.semi_axes[2], o.major.x, o.major.y, o.major.z, o.minor.x, o.minor.y, o.minor.z,
                       o.at_border ? 1 : 0);
    }
    return csv;
}

double quantile(std::vector<double> values, double q)
{
    if (values.empty()) return 0.0;
    const auto k = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
    return values[k];
}

Json optional_level(const std::optional<int>& S) { return S ? Json(*S) : Json(nullptr); }

Json pores_json(const Analysis& a, double h)
{
    std::vector<double> inscribed, equivalent, sphericity;
    std::int64_t border = 0, small = 0, small_volume = 0;
    for (const Object& o : a.pores) {
        inscribed.push_back(o.inscribed_radius);
        equivalent.push_back(o.equivalent_radius);
        if (o.at_border)
            ++border;
        else
            sphericity.push_back(o.sphericity);
        if (!(o.inscribed_radius > a.R_C)) ++small, small_volume += o.volume;
    }
    return {{"count", a.pores.size()},
            {"at_border", border},
            {"without_ball_of_R_C", small},
            {"without_ball_of_R_C_px3", small_volume},
            {"inscribed_radius_min_px", quantile(inscribed, 0)},
            {"inscribed_radius_median_px", quantile(inscribed, 0.5)},
            {"inscribed_radius_max_px", quantile(inscribed, 1)},
            {"equivalent_radius_median", quantile(equivalent, 0.5) * h},
            {"sphericity_median", quantile(sphericity, 0.5)}};
}

Json cracks_json(const Analysis& a, const Shape& shape)
{
    std::int64_t all = 0, largest = 0;
    bool spans[3] = {};
    for (const Object& o : a.cracks) {
        all += o.volume;
        largest = std::max(largest, o.volume);
        for (int axis = 0; axis < 3; ++axis) spans[axis] = spans[axis] || o.spans(axis, shape);
    }
    return {{"count", a.cracks.size()},
            {"largest_share", all > 0 ? static_cast<double>(largest) / static_cast<double>(all) : 0.0},
            {"spans_x", spans[0]},
            {"spans_y", spans[1]},
            {"spans_z", spans[2]}};
}

Json thickness_json(const Analysis& a, const std::vector<std::int64_t>& voxels, double h)
{
    Thickness t;
    t.diameter = a.diameters;
    Json out;
    for (const auto& [name, q] : {std::pair{"q05", 0.05}, {"q25", 0.25}, {"median", 0.5}, {"q75", 0.75}, {"q95", 0.95}})
        out[name] = thickness_quantile(t, voxels, q) * h;
    return out;
}

}  // namespace

Analysis analyse(const Microstructure& micro, const Settings& settings)
{
    Analysis a;
    a.R_C = settings.R_C;
    a.levels = histogram(micro.gray.level);
    a.moments = moments_threshold(a.levels);
    a.otsu = otsu_threshold(a.levels);
    a.entropy = entropy_threshold(a.levels);
    a.whole = porosity(micro);
    a.profiles = porosity_profiles(micro);
    a.scatter = porosity_scatter(micro);
    const Volume<std::int32_t> squared = squared_distance(micro.matter);
    const Thickness thickness = local_thickness(squared, settings.thickness_step);
    const auto single = [&](const Mask& mask) {
        const Components each = components(mask, settings.connectivity);
        auto objects = measured(mask, each, squared);
        const auto mean = mean_thickness(thickness, each);
        for (std::size_t k = 0; k < objects.size(); ++k) objects[k].mean_thickness = mean[k];
        return objects;
    };
    a.pores = single(micro.pore);
    a.cracks = single(micro.crack);
    a.diameters = thickness.diameter;
    a.pore_thickness = thickness_histogram(thickness, micro.pore);
    a.crack_thickness = thickness_histogram(thickness, micro.crack);
    return a;
}

void save(const Analysis& a, const Microstructure& micro, const std::filesystem::path& folder)
{
    std::string csv = "level,voxels\n";
    for (std::size_t i = 0; i < a.levels.size(); ++i)
        fmt::format_to(std::back_inserter(csv), "{},{}\n", i, a.levels[i]);
    io::write_text(folder / "histogram.csv", csv);
    const double h = micro.gray.voxel_size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const char name = "xyz"[axis];
        csv = fmt::format("{}_m,total,pores,cracks\n", name);
        for (std::size_t i = 0; i < a.profiles.along[axis].size(); ++i) {
            const Porosity& p = a.profiles.along[axis][i];
            fmt::format_to(std::back_inserter(csv), "{:.6g},{:.6g},{:.6g},{:.6g}\n", (static_cast<double>(i) + 0.5) * h,
                           p.total(), p.pores, p.cracks);
        }
        io::write_text(folder / fmt::format("porosity_{}.csv", name), csv);
    }
    csv = "edge_px,edge_m,cubes,total,pores,cracks,total_deviation,pores_deviation,cracks_deviation\n";
    for (const Scatter& s : a.scatter)
        fmt::format_to(std::back_inserter(csv), "{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", s.edge,
                       static_cast<double>(s.edge) * h, s.cubes, s.mean.total(), s.mean.pores, s.mean.cracks,
                       s.total_deviation, s.pores_deviation, s.cracks_deviation);
    io::write_text(folder / "porosity_scatter.csv", csv);
    io::write_text(folder / "pores.csv", objects_csv(a.pores));
    io::write_text(folder / "cracks.csv", objects_csv(a.cracks));
    csv = "diameter_px,diameter_m,pore_voxels,crack_voxels\n";
    for (std::size_t k = 1; k < a.diameters.size(); ++k)
        fmt::format_to(std::back_inserter(csv), "{:.4f},{:.6g},{},{}\n", a.diameters[k], a.diameters[k] * h,
                       a.pore_thickness[k], a.crack_thickness[k]);
    io::write_text(folder / "thickness.csv", csv);
}

Json summary(const Microstructure& micro, const Analysis& a)
{
    const double h = micro.gray.voxel_size;
    const Shape& s = micro.matter.shape();
    Json out;
    out["shape_px"] = {s.nx, s.ny, s.nz};
    out["voxel_size"] = h;
    out["threshold"] = {{"used", micro.threshold},
                        {"moments", optional_level(a.moments)},
                        {"otsu", optional_level(a.otsu)},
                        {"entropy", optional_level(a.entropy)}};
    if (const auto two = preserving_moments(a.levels))
        out["threshold"]["two_levels"] = {{"void", two->z0}, {"matter", two->z1}, {"void_share", two->p0}};
    out["porosity"] = {{"total", a.whole.total()}, {"pores", a.whole.pores}, {"cracks", a.whole.cracks}};
    out["R_C_px"] = a.R_C;
    out["pores"] = pores_json(a, h);
    out["cracks"] = cracks_json(a, s);
    out["pore_thickness"] = thickness_json(a, a.pore_thickness, h);
    out["crack_thickness"] = thickness_json(a, a.crack_thickness, h);
    out["representative_edge_10_percent"] = representative_edge(a.scatter, 0.1) * h;
    return out;
}

}  // namespace craze::microstructure
