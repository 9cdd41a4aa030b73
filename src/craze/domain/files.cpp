#include "craze/domain/files.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/index.hpp"
#include "craze/core/units.hpp"
#include "craze/domain/draft.hpp"
#include "craze/domain/validity.hpp"
#include "craze/domain/vtkhdf.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace craze::domain {

namespace fs = std::filesystem;

namespace {

using Text = fmt::memory_buffer;
template <class... Values>
void add(Text& out, fmt::format_string<Values...> format, Values&&... values)
{
    fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}
void write(const Text& text, const fs::path& file) { io::write_text(file, {text.data(), text.size()}); }

void write_bonds(const Domain& d, Text& out, char separator)
{
    for (std::int32_t b = 0; b < d.bonds.size(); ++b)
        add(out, "{1}{0}{2}{0}{3}{0}{4}\n", separator, d.bonds.i[at(b)], d.bonds.j[at(b)],
            d.bonds.kind[at(b)] == BondKind::beam ? "beam" : "contact_beam", d.bonds.thickness[at(b)]);
}

void write_spheres(const Domain& d, Text& out, char separator)
{
    for (std::int32_t e = 0; e < d.elements.size(); ++e)
        add(out, "{1}{0}{2}{0}{3}{0}{4}\n", separator, d.elements.x[at(e)], d.elements.y[at(e)], d.elements.z[at(e)],
            d.elements.r[at(e)]);
}

void write_near(const Domain& d, const fs::path& folder)
{
    Text out;
    add(out, "i,j,T\n");
    for (std::int32_t p = 0; p < d.near.size(); ++p)
        add(out, "{},{},{}\n", d.near.i[at(p)], d.near.j[at(p)], d.near.thickness[at(p)]);
    write(out, folder / "near.csv");
}

void write_csv(const Domain& d, const fs::path& folder)
{
    Text elements, bonds;
    for (const std::string& remark : remarks(d)) add(elements, "# {}\n", remark);
    add(elements, "x,y,z,r\n");
    write_spheres(d, elements, ',');
    add(bonds, "i,j,kind,T\n");
    write_bonds(d, bonds, ',');
    write(elements, folder / "elements.csv");
    write(bonds, folder / "bonds.csv");
    write_near(d, folder);
}

void write_yade(const Domain& d, const fs::path& folder)
{
    Text spheres, bonds;
    add(spheres, "#format x_y_z_r\n");
    for (const std::string& remark : remarks(d)) add(spheres, "# {}\n", remark);
    write_spheres(d, spheres, ' ');
    add(bonds, "# i j kind T\n");
    write_bonds(d, bonds, ' ');
    write(spheres, folder / "spheres.txt");
    write(bonds, folder / "bonds.txt");
    write_near(d, folder);
}

void write_lammps(const Domain& d, const fs::path& folder, double density, bool hybrid)
{
    const double rho = d.dense_volume > 0.0 ? density * d.box.x * d.box.y * d.box.z / d.dense_volume : density;
    Text out;
    add(out, "craze: units si; {}\n\n", fmt::join(remarks(d), "; "));
    add(out, "{} atoms\n{} bonds\n1 atom types\n2 bond types\n", d.elements.size(), d.bonds.size());
    std::vector<std::int32_t> bonds_of(d.elements.r.size(), 0);
    for (std::int32_t b = 0; b < d.bonds.size(); ++b)
        ++bonds_of[at(d.bonds.i[at(b)])], ++bonds_of[at(d.bonds.j[at(b)])];
    add(out, "{} extra bond per atom\n\n", bonds_of.empty() ? 0 : *std::ranges::max_element(bonds_of));
    for (int axis = 0; axis < 3; ++axis) add(out, "0 {0} {1}lo {1}hi\n", d.box[axis], "xyz"[axis]);
    add(out, "\nAtoms # {}\n\n", hybrid ? "hybrid" : "bpm/sphere");
    for (std::int32_t e = 0; e < d.elements.size(); ++e) {
        const auto& el = d.elements;
        if (hybrid)  // atom_style hybrid bond sphere: id type x y z molecule diameter density
            add(out, "{} 1 {} {} {} 1 {} {}\n", e + 1, el.x[at(e)], el.y[at(e)], el.z[at(e)], 2.0 * el.r[at(e)], rho);
        else  // id molecule type diameter density x y z
            add(out, "{} 1 1 {} {} {} {} {}\n", e + 1, 2.0 * el.r[at(e)], rho, el.x[at(e)], el.y[at(e)], el.z[at(e)]);
    }
    if (d.bonds.size() > 0) add(out, "\nBonds\n\n");
    for (std::int32_t b = 0; b < d.bonds.size(); ++b) {
        const bool contact = d.bonds.kind[at(b)] == BondKind::contact_beam;
        add(out, "{} {} {} {}", b + 1, contact ? 2 : 1, d.bonds.i[at(b)] + 1, d.bonds.j[at(b)] + 1);
        if (contact) add(out, " # T = {}", d.bonds.thickness[at(b)]);
        add(out, "\n");
    }
    write(out, folder / "domain.data");
    write_near(d, folder);
}

std::string guessed_format(const fs::path& file)
{
    fs::path name = file;
    if (name.extension() == ".gz") name.replace_extension();
    const std::string ending = name.extension().string();
    if (ending == ".vtkhdf" || ending == ".hdf" || ending == ".h5") return "vtkhdf";
    if (ending == ".csv") return "csv";
    if (ending == ".data" || ending == ".lmp" || ending == ".lammps") return "lammps";
    io::TextLines lines(file);
    if (!lines.next()) throw InvalidInput(fmt::format("{}: is empty", file.string()));
    if (lines.words().size() == 2) return "listing";
    if (lines.words().size() == 4) return "yade";
    throw InvalidInput(fmt::format("{}: the format cannot be told from \"{}\"; name it: {}", file.string(), ending,
                                   fmt::join(written_formats(), ", ")));
}

}  // namespace

const std::vector<std::string>& written_formats()
{
    static const std::vector<std::string> all{"csv", "lammps", "lammps_hybrid", "yade", "vtkhdf"};
    return all;
}

void write_domain(const Domain& d, const std::string& format, const fs::path& folder, double density)
{
    if (format == "csv") return write_csv(d, folder);
    if (format == "lammps" || format == "lammps_hybrid")
        return write_lammps(d, folder, density, format == "lammps_hybrid");
    if (format == "yade") return write_yade(d, folder);
    if (format == "vtkhdf") return write_vtkhdf(d, folder / "domain.vtkhdf");
    const auto& known = written_formats();
    const std::string nearest = nearest_name(format, known.data(), known.data() + known.size());
    throw InvalidInput(fmt::format("domain format \"{}\" is unknown; there is {}{}", format, fmt::join(known, ", "),
                                   nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
}

std::string format_of(const Source& source)
{
    return source.format == "auto" ? guessed_format(source.elements) : source.format;
}

namespace {

Domain from_vtkhdf(const Source& source)
{
    const auto needs = [&](bool good, const char* what) {
        if (!good) throw InvalidInput(fmt::format("{}: {}", source.elements.string(), what));
    };
    needs(source.unit == 1.0, "a VTKHDF file of craze is in metres; needs no unit");
    needs(source.near.empty(), "a VTKHDF file of craze holds its near pairs; needs no file of them");
    Domain d = read_vtkhdf(source.elements);
    if (source.box) d.box = *source.box;
    if (source.mean_radius) d.mean_radius = *source.mean_radius;
    if (source.box || source.mean_radius)
        check_domain(d, [&](Part part, std::size_t k) {
            return fmt::format("{}: {} {}", source.elements.string(), name_of(part), k);
        });
    return d;
}

}  // namespace

Domain read_domain(const Source& source)
{
    const std::string format = format_of(source);
    if (!source.bonds.empty() && format != "csv" && format != "yade")
        throw InvalidInput(fmt::format("{}: the format {} holds its bonds in one file; needs no file of bonds, got {}",
                                       source.elements.string(), format, source.bonds.string()));
    if (format == "vtkhdf") return from_vtkhdf(source);
    Draft draft;
    draft.elements_file = source.elements;
    draft.bonds_file = source.bonds.empty() ? source.elements : source.bonds;
    draft.near_file = source.near;
    if (format == "csv")
        read_csv(source, draft);
    else if (format == "lammps" || format == "lammps_hybrid")
        read_lammps(source, draft);
    else if (format == "yade")
        read_yade(source, draft);
    else if (format == "listing")
        read_listing(source, draft);
    else
        throw InvalidInput(fmt::format("domain format \"{}\" is unknown; there is {}, listing", format,
                                       fmt::join(written_formats(), ", ")));
    if (!source.near.empty()) read_near_csv(source, draft);
    return finish(std::move(draft), source);
}

}  // namespace craze::domain
