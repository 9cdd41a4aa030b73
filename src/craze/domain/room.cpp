#include "craze/domain/room.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/domain/cracks.hpp"
#include "craze/domain/pores.hpp"
#include "craze/domain/quality.hpp"
#include "craze/domain/vtkhdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::domain {

namespace fs = std::filesystem;

namespace {

/// Adds the cracks of the images to those that the pairs bring.
void cut(PairCracks& cracks, const Elements& elements, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
         double R_B, const microstructure::Microstructure& micro, const mesh::CrackSurface& surface, const Settings& s)
{
    PairCracks found;
    found.cut = s.cut_by == CutBy::surface ? triangles_met(elements, i, j, surface)
                                           : crack_voxel_runs_met(elements, i, j, micro.crack, micro.gray.voxel_size);
    measure_thickness(found, elements, i, j, R_B, micro, s.counted);
    for (std::size_t p = 0; p < i.size(); ++p) {
        if (found.cut[p] == 0) continue;
        cracks.cut[p] = found.cut[p];
        cracks.T1[p] = found.T1[p];
        cracks.T2[p] = found.T2[p];
    }
}

Source source(const Settings& s)
{
    Source from;
    from.elements = s.import_from.elements;
    from.bonds = s.import_from.bonds;
    from.near = s.import_from.near;
    from.format = s.import_from.format;
    from.unit = s.import_from.unit;
    if (s.import_from.box.size() == 3)
        from.box = Vec3{s.import_from.box[0], s.import_from.box[1], s.import_from.box[2]};
    from.mean_radius = s.mean_radius;
    from.bonding = {s.cardinality, s.near_gap};
    return from;
}

}  // namespace

Recipe recipe(const Settings& s, double mean_radius)
{
    const double share = s.dispersion_means == DispersionMeans::total_width ? 0.5 : 1.0;
    return {mean_radius, share * s.dispersion, s.density, s.periodic, static_cast<std::uint64_t>(s.seed)};
}

Domain pack(const Vec3& box, double mean_radius, const Settings& s)
{
    PackingReport report;
    Elements elements = pack_elements(box, recipe(s, mean_radius), &report);
    say(fmt::format("domain: {} elements packed in {} steps, {:.1f} s", elements.size(), report.iterations,
                    report.seconds));
    if (!report.settled)
        notice(fmt::format("domain: the packing has not come to rest after {} steps (residual {:.2g})",
                           report.iterations, report.residual));
    if (report.overlap > 0.025)
        notice(
            fmt::format("domain: elements overlap by {:.1f} % on average: the packing is squeezed; a lower "
                        "domain.density or less dispersion lets them just touch",
                        100.0 * report.overlap));
    return join(std::move(elements), box, mean_radius, {s.cardinality, s.near_gap}, s.periodic);
}

Discretisation discretise(const microstructure::Microstructure& micro, const mesh::CrackSurface& surface, double R_C,
                          const Settings& s)
{
    check(s);
    const double h = micro.gray.voxel_size;
    const Shape& n = micro.crack.shape();
    const Vec3 box = h * Vec3{static_cast<double>(n.nx), static_cast<double>(n.ny), static_cast<double>(n.nz)};
    const double mean_radius = s.mean_radius.value_or(R_C * h);
    if (mean_radius > 1.0001 * R_C * h)
        notice(
            fmt::format("domain: R_DE = {} is larger than R_C = {}: pores smaller than an element may be lost [Eq. 8]",
                        format_quantity(mean_radius, Dimension::length), format_quantity(R_C * h, Dimension::length)));
    if (mean_radius < 0.9999 * R_C * h)
        notice(
            fmt::format("domain: R_DE = {} is smaller than R_C = {}: cracks may be thicker than bonds are long; their "
                        "thickness is then bounded to L_0 [Eqs. 9, 10]",
                        format_quantity(mean_radius, Dimension::length), format_quantity(R_C * h, Dimension::length)));
    if (!s.import_from.elements.empty()) {
        Settings in_the_stack = s;
        if (s.import_from.box.empty()) in_the_stack.import_from.box = {box.x, box.y, box.z};
        return discretise(read_domain(source(in_the_stack)), micro, surface, s);
    }
    return discretise(pack(box, mean_radius, s), micro, surface, s);
}

Discretisation as_discretisation(Domain domain)
{
    Discretisation d;
    d.in_pore.assign(domain.elements.r.size(), 0);
    d.bonds.T1 = d.bonds.T2 = domain.bonds.thickness;
    for (BondKind& kind : domain.bonds.kind) {
        d.bonds.cut.push_back(kind == BondKind::contact_beam);
        kind = BondKind::beam;
    }
    d.near.T1 = d.near.T2 = domain.near.thickness;
    for (const double T : domain.near.thickness) d.near.cut.push_back(T > 0.0);
    domain.bonds.thickness.assign(domain.bonds.i.size(), 0.0);
    domain.near.thickness.assign(domain.near.i.size(), 0.0);
    d.dense = std::move(domain);
    return d;
}

Discretisation import_domain(const Settings& s)
{
    check(s);
    const Source from = source(s);
    Discretisation d = as_discretisation(read_domain(from));
    if (format_of(from) == "vtkhdf") read_defects_vtkhdf(from.elements, d);
    return d;
}

Discretisation discretise(Domain domain, const microstructure::Microstructure& micro, const mesh::CrackSurface& surface,
                          const Settings& s)
{
    Discretisation d = as_discretisation(std::move(domain));
    const double h = micro.gray.voxel_size, R_B = s.r_tilde * d.dense.mean_radius;
    const Shape& n = micro.pore.shape();
    d.in_pore = carve(d.dense.elements, micro.pore, h);
    d.p_vx = static_cast<double>(micro.pore.count()) / static_cast<double>(n.voxels());
    check_interrupt();
    cut(d.bonds, d.dense.elements, d.dense.bonds.i, d.dense.bonds.j, R_B, micro, surface, s);
    check_interrupt();
    cut(d.near, d.dense.elements, d.dense.near.i, d.dense.near.j, R_B, micro, surface, s);
    return d;
}

void save(const Discretisation& discretisation, const Settings& s, const fs::path& folder, double density)
{
    write_vtkhdf(discretisation, folder / "domain.vtkhdf");
    if (s.write.empty()) return;
    const Domain specimen = with_defects(discretisation, {});
    for (const std::string& format : s.write) write_domain(specimen, format, folder / "specimen" / format, density);
}

Discretisation load_discretisation(const fs::path& folder)
{
    return read_discretisation_vtkhdf(folder / "domain.vtkhdf");
}

Json summary(const Discretisation& d)
{
    const Domain specimen = with_defects(d, {});
    std::vector<double> T1, T2;
    std::int64_t crossed_twice = 0, thin = 0;
    for (std::size_t b = 0; b < d.bonds.cut.size(); ++b) {
        if (d.bonds.cut[b] == 0) continue;
        T1.push_back(d.bonds.T1[b]);
        T2.push_back(d.bonds.T2[b]);
        crossed_twice += d.bonds.cut[b] > 1;
        thin += d.bonds.T2[b] == 0.0;
    }
    const auto five = [](std::vector<double> values) {
        const auto v = five_numbers(std::move(values));
        return Json{{"least", v[0]}, {"quartile", v[1]}, {"median", v[2]}, {"upper_quartile", v[3]}, {"most", v[4]}};
    };
    const Quality dense = quality(d.dense), cracked = quality(specimen);
    const double p_DE = discrete_porosity(d);
    Json json;
    json["box_m"] = {d.dense.box.x, d.dense.box.y, d.dense.box.z};
    json["mean_radius_m"] = d.dense.mean_radius;
    json["elements"] = d.dense.elements.size();
    json["bonds"] = d.dense.bonds.size();
    json["near_pairs"] = d.dense.near.size();
    json["dense"] = as_json(dense);
    json["p_vx"] = d.p_vx;
    json["p_DE"] = p_DE;
    json["p_DE_over_p_vx"] = d.p_vx > 0.0 ? Json(p_DE / d.p_vx) : Json(nullptr);
    json["cut_bonds"] = T1.size();
    json["cut_bonds_meeting_more_than_one_triangle"] = crossed_twice;
    json["cut_bonds_of_zero_T2"] = thin;
    json["T1_m"] = five(std::move(T1));
    json["T2_m"] = five(std::move(T2));
    json["specimen"] = {{"elements", specimen.elements.size()},
                        {"bonds", specimen.bonds.size()},
                        {"contact_beams", std::ranges::count(specimen.bonds.kind, BondKind::contact_beam)},
                        {"near_pairs", specimen.near.size()},
                        {"rattlers", cracked.rattlers},
                        {"components", cracked.components},
                        {"largest_component", cracked.largest_component}};
    return json;
}

}  // namespace craze::domain
