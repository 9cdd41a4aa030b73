#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/io/triangles.hpp"
#include "craze/mesh/mesh.hpp"
#include "craze/mesh/pictures.hpp"

#include <fmt/format.h>

#include <iterator>

namespace craze::mesh {

namespace {

namespace fs = std::filesystem;
using Text = std::back_insert_iterator<std::string>;

void write_cracks(const CrackMeasures& m, const fs::path& file)
{
    std::string text =
        "crack,area_m2,radius_m,opening_m,flatness,x_m,y_m,z_m,normal_x,normal_y,normal_z,triangles,at_border,spans_x,"
        "spans_y,spans_z\n";
    for (std::size_t k = 0; k < m.cracks.size(); ++k) {
        const SingleCrack& c = m.cracks[k];
        fmt::format_to(
            Text(text),
            "{},{:.6g},{:.6g},{:.6g},{:.4f},{:.6g},{:.6g},{:.6g},{:.5f},{:.5f},{:.5f},{},{:d},{:d},{:d},{:d}\n", k,
            c.area, c.radius, c.opening, c.flatness, c.centre.x, c.centre.y, c.centre.z, c.normal.x, c.normal.y,
            c.normal.z, c.triangles, c.at_border, c.spans[0], c.spans[1], c.spans[2]);
    }
    io::write_text(file, text);
}

void write_poles(const PoleFigure& poles, const fs::path& file)
{
    std::string text = "cos_from,cos_to,azimuth_from_deg,azimuth_to_deg,share,times_uniform\n";
    for (int ring = 0; ring < PoleFigure::rings; ++ring)
        for (int sector = 0; sector < PoleFigure::sectors; ++sector)
            fmt::format_to(Text(text), "{:.6f},{:.6f},{},{},{:.8g},{:.6g}\n", 1.0 - (ring + 1.0) / PoleFigure::rings,
                           1.0 - static_cast<double>(ring) / PoleFigure::rings, sector * 360 / PoleFigure::sectors,
                           (sector + 1) * 360 / PoleFigure::sectors,
                           poles.share[static_cast<std::size_t>(sector + PoleFigure::sectors * ring)],
                           poles.times_uniform(ring, sector));
    io::write_text(file, text);
}

void write_rose(const Rose& rose, const fs::path& file)
{
    std::string text = "angle_from_deg,angle_to_deg,section_x,section_y,section_z\n";
    for (std::size_t k = 0; k < Rose::bins; ++k)
        fmt::format_to(Text(text), "{},{},{:.8g},{:.8g},{:.8g}\n", k * 180 / Rose::bins, (k + 1) * 180 / Rose::bins,
                       rose.share[0][k], rose.share[1][k], rose.share[2][k]);
    io::write_text(file, text);
}

void write_openings(const CrackMeasures& m, double voxel_size, const fs::path& file)
{
    std::string text = "opening_from_m,opening_to_m,share\n";
    const double step = Openings::step * voxel_size;
    for (std::size_t k = 0; k < m.openings.share.size(); ++k)
        fmt::format_to(Text(text), "{:.6g},{:.6g},{:.8g}\n", static_cast<double>(k) * step,
                       static_cast<double>(k + 1) * step, m.openings.share[k]);
    io::write_text(file, text);
}

Json array_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

}  // namespace

void save(const CrackSurface& surface, const fs::path& folder)
{
    io::TriangleView view{surface.vertices, surface.triangles};
    if (!surface.sides.empty()) view.fields.push_back({"sides", std::span(surface.sides)});
    io::write_ply(folder / "cracks.ply", view);
}

void save(const CrackSurface& surface, const CrackMeasures& measures, const Settings& settings, const fs::path& folder)
{
    save(surface, folder);
    write_cracks(measures, folder / "cracks.csv");
    write_poles(measures.poles, folder / "pole_figure.csv");
    write_rose(measures.rose, folder / "rose.csv");
    write_openings(measures, measures.voxel_size, folder / "openings.csv");
    io::write_png(folder / "pole_figure.png", pole_figure_picture(measures.poles));
    io::write_png(folder / "rose.png", rose_picture(measures.rose));
    if (settings.stl) io::write_stl(folder / "cracks.stl", {surface.vertices, surface.triangles});
    if (settings.vtp) {
        io::TriangleView view{surface.vertices, surface.triangles};
        if (!surface.sides.empty()) view.fields.push_back({"sides", std::span(surface.sides)});
        view.fields.push_back({"crack", std::span(measures.crack_of)});
        view.fields.push_back({"opening_m", std::span(measures.opening_of)});
        io::write_vtp(folder / "cracks.vtp", view);
    }
}

CrackSurface load_surface(const fs::path& folder)
{
    io::TriangleMesh mesh = io::read_ply(folder / "cracks.ply", "sides");
    // A surface drawn or edited elsewhere may have no such property: its triangles are the sheet.
    if (mesh.tags.size() != mesh.triangles.size()) mesh.tags.clear();
    return {std::move(mesh.vertices), std::move(mesh.triangles), std::move(mesh.tags)};
}

Json summary(const CrackSurface& surface, const CrackMeasures& m)
{
    Json json;
    json["vertices"] = surface.vertices.size();
    json["triangles"] = surface.triangles.size();
    json["area_m2"] = m.area;
    json["triangle_area_m2"] = m.triangle_area;
    json["area_per_volume_1_per_m"] = m.area / m.volume;
    json["cracks"] = m.cracks.size();
    json["largest_share"] = m.largest_share;
    json["spans"] = m.spans;
    json["crack_density"] = m.crack_density;
    json["crack_density_tensor"] = m.density_tensor;
    json["fabric_tensor"] = m.fabric;
    json["opening_m"] = {{"mean", m.openings.mean},
                         {"q10", m.openings.quantiles[0]},
                         {"median", m.openings.quantiles[1]},
                         {"q90", m.openings.quantiles[2]}};
    if (!m.cracks.empty())
        json["largest"] = {{"radius_m", m.cracks[0].radius},
                           {"opening_m", m.cracks[0].opening},
                           {"normal", array_of(m.cracks[0].normal)},
                           {"flatness", m.cracks[0].flatness}};
    const MeshQuality& q = m.quality;
    json["quality"] = {{"duplicate_triangles", q.duplicate_triangles},
                       {"degenerate_triangles", q.degenerate_triangles},
                       {"unused_vertices", q.unused_vertices},
                       {"edges", q.edges},
                       {"rim_edges", q.rim_edges},
                       {"branching_edges", q.branching_edges},
                       {"branching_vertices", q.branching_vertices},
                       {"euler_number", q.euler_number},
                       {"clean", q.clean()},
                       {"manifold", q.manifold()}};
    return json;
}

}  // namespace craze::mesh
