#include "craze/domain/draft.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

namespace craze::domain {

using io::TextLines;

namespace {

/// Where each wanted column stands; the columns' own order where there is no header.
class Columns {
public:
    Columns(TextLines& lines, std::vector<std::string_view> names, std::size_t needed)
    {
        const auto is_name = [&](std::string_view word) { return std::ranges::find(names, word) != names.end(); };
        for (std::size_t k = 0; k < names.size(); ++k) at_.push_back(k);
        if (lines.words().empty() || !std::ranges::any_of(lines.words(), is_name)) return;
        has_header_ = true;
        for (std::size_t k = 0; k < names.size(); ++k) {
            const auto found = std::ranges::find(lines.words(), names[k]);
            at_[k] = static_cast<std::size_t>(found - lines.words().begin());
            if (found == lines.words().end() && k < needed)
                lines.refuse(fmt::format("needs the column \"{}\" in the header", names[k]));
            if (found == lines.words().end()) at_[k] = absent;
        }
    }
    bool has_header() const { return has_header_; }
    std::size_t operator[](std::size_t k) const { return at_[k]; }
    bool has(std::size_t k, const TextLines& lines) const { return at_[k] < lines.words().size(); }

private:
    static constexpr std::size_t absent = 1U << 20U;
    std::vector<std::size_t> at_;
    bool has_header_ = false;
};

bool is_contact(const TextLines& lines, std::string_view word)
{
    if (word == "beam" || word == "0") return false;
    if (word == "contact_beam" || word == "1") return true;
    lines.refuse(fmt::format("needs the kind beam or contact_beam, got \"{}\"", word));
}

void read_bond_table(TextLines lines, Draft& draft)
{
    draft.has_bonds = true;
    if (!lines.next()) return;
    const Columns column(lines, {"i", "j", "kind", "T"}, 2);
    if (column.has_header() && !lines.next()) return;
    do {
        Draft::Link bond{lines.integer(column[0], "i"), lines.integer(column[1], "j"), false, 0.0, lines.number()};
        if (column.has(2, lines)) bond.contact = is_contact(lines, lines.words()[column[2]]);
        if (column.has(3, lines)) bond.thickness = lines.real(column[3], "T");
        if (!bond.contact && bond.thickness != 0.0)
            lines.refuse("gives a crack thickness to a beam; needs kind contact_beam");
        draft.bonds.push_back(bond);
    } while (lines.next());
}

void read_sphere_table(TextLines lines, Draft& draft)
{
    bool first = true;
    Columns* column = nullptr;
    std::optional<Columns> columns;
    while (lines.next_raw()) {
        if (!lines.comment().empty()) read_remark(lines.comment(), draft);
        if (lines.words().empty()) continue;
        if (first) {
            columns.emplace(lines, std::vector<std::string_view>{"x", "y", "z", "r"}, 4);
            column = &*columns;
            first = false;
            if (column->has_header()) continue;
        }
        draft.add_element(lines,
                          {lines.real((*column)[0], "x"), lines.real((*column)[1], "y"), lines.real((*column)[2], "z")},
                          lines.real((*column)[3], "r"));
    }
}

}  // namespace

void read_csv(const Source& source, Draft& draft)
{
    read_sphere_table(TextLines(source.elements, ",;"), draft);
    if (!source.bonds.empty()) read_bond_table(TextLines(source.bonds, ",;"), draft);
}

void read_near_csv(const Source& source, Draft& draft)
{
    draft.has_near = true;
    TextLines lines(source.near, ",;");
    if (!lines.next()) return;
    const Columns column(lines, {"i", "j", "T"}, 2);
    if (column.has_header() && !lines.next()) return;
    do {
        draft.near.push_back({lines.integer(column[0], "i"), lines.integer(column[1], "j"), false,
                              column.has(2, lines) ? lines.real(column[2], "T") : 0.0, lines.number()});
    } while (lines.next());
}

void read_yade(const Source& source, Draft& draft)
{
    read_sphere_table(TextLines(source.elements), draft);
    if (!source.bonds.empty()) read_bond_table(TextLines(source.bonds), draft);
}

void read_listing(const Source& source, Draft& draft)
{
    TextLines lines(source.elements);
    if (!lines.next()) throw InvalidInput(fmt::format("{}: is empty", source.elements.string()));
    const std::int64_t elements = lines.integer(0, "the number of elements"),
                       bonds = lines.integer(1, "the number of bonds");
    if (elements < 1 || bonds < 0) lines.refuse("needs at least one element and no negative number of bonds");
    const auto next = [&](const char* what, std::int64_t k, std::int64_t n) {
        if (!lines.next()) lines.refuse(fmt::format("the file ends after {} of {} {}", k, n, what));
    };
    for (std::int64_t e = 0; e < elements; ++e) {
        next("elements", e, elements);
        draft.add_element(lines, {lines.real(0, "x"), lines.real(1, "y"), lines.real(2, "z")}, lines.real(3, "r"));
    }
    draft.has_bonds = bonds > 0;
    for (std::int64_t b = 0; b < bonds; ++b) {
        next("bonds", b, bonds);
        draft.bonds.push_back({lines.integer(0, "i"), lines.integer(1, "j"), false, 0.0, lines.number()});
    }
}

namespace {

/// Atoms and bonds of a LAMMPS data file, whose numbers need not be in order.
class LammpsReader {
public:
    LammpsReader(const Source& source, Draft& draft) : lines_(source.elements), draft_(draft), unit_(source.unit) {}

    void read()
    {
        if (!lines_.next_raw()) lines_.refuse("is empty");
        read_remark(lines_.line(), draft_);
        header();
        for (; !at_end_; section()) {}
        if (static_cast<std::int64_t>(draft_.elements.r.size()) != atoms_)
            lines_.refuse(fmt::format("the file ends after {} of {} atoms", draft_.elements.r.size(), atoms_));
        if (static_cast<std::int64_t>(draft_.bonds.size()) != bonds_)
            lines_.refuse(fmt::format("the file ends after {} of {} bonds", draft_.bonds.size(), bonds_));
        draft_.has_bonds = bonds_ > 0;
    }

private:
    bool word_is(std::size_t k, std::string_view word) const
    {
        return k < lines_.words().size() && lines_.words()[k] == word;
    }
    bool advance() { return !(at_end_ = !lines_.next()); }

    void header()
    {
        Vec3 box;
        while (advance()) {
            const char first = lines_.words()[0][0];
            if ((first >= 'A' && first <= 'Z')) break;
            if (word_is(1, "atoms")) atoms_ = lines_.integer(0, "the number of atoms");
            if (word_is(1, "bonds")) bonds_ = lines_.integer(0, "the number of bonds");
            if (word_is(3, "xy")) lines_.refuse("tilts the box; needs a box of right angles");
            for (int axis = 0; axis < 3; ++axis)
                if (word_is(2, std::array{"xlo", "ylo", "zlo"}[static_cast<std::size_t>(axis)])) {
                    low_[axis] = lines_.real(0, "the box");
                    box[axis] = (lines_.real(1, "the box") - low_[axis]) * unit_;
                }
        }
        if (atoms_ < 1) lines_.refuse("needs a number of atoms before the first section");
        if (!draft_.box) draft_.box = box;
    }

    void section()
    {
        const std::string name(lines_.words()[0]),
            style(lines_.comment().substr(std::min(lines_.comment().find_first_not_of(' '), lines_.comment().size())));
        if (name == "Atoms") return read_atoms(style);
        if (name == "Bonds") return read_bonds();
        while (advance())  // masses, velocities, coefficients: not asked for
            if (const char first = lines_.words()[0][0]; first >= 'A' && first <= 'Z') return;
    }

    void read_atoms(const std::string& style)
    {
        const bool hybrid = style.starts_with("hybrid");
        if (!hybrid && !style.starts_with("bpm/sphere") && !style.empty())
            lines_.refuse(fmt::format("needs atoms of style bpm/sphere or hybrid (bond sphere), got \"{}\"", style));
        for (auto* values : {&draft_.elements.x, &draft_.elements.y, &draft_.elements.z, &draft_.elements.r})
            values->resize(static_cast<std::size_t>(atoms_));
        draft_.element_line.assign(static_cast<std::size_t>(atoms_), 0);
        for (std::int64_t k = 0; k < atoms_; ++k) {
            if (!advance()) lines_.refuse(fmt::format("the file ends after {} of {} atoms", k, atoms_));
            const std::int64_t id = lines_.integer(0, "the atom's number");
            if (id < 1 || id > atoms_) lines_.refuse(fmt::format("atom {} is not one of 1 to {}", id, atoms_));
            const auto e = static_cast<std::size_t>(id - 1);
            if (draft_.element_line[e] != 0)
                lines_.refuse(fmt::format("atom {} was given before, in line {}", id, draft_.element_line[e]));
            const std::size_t xyz = hybrid ? 2 : 5, diameter = hybrid ? 6 : 3;
            draft_.elements.x[e] = lines_.real(xyz, "x") - low_.x;
            draft_.elements.y[e] = lines_.real(xyz + 1, "y") - low_.y;
            draft_.elements.z[e] = lines_.real(xyz + 2, "z") - low_.z;
            draft_.elements.r[e] = 0.5 * lines_.real(diameter, "the diameter");
            draft_.element_line[e] = lines_.number();
        }
        advance();
    }

    /// The element of an atom's number in this line.
    std::int64_t atom(std::size_t k, const char* what)
    {
        const std::int64_t id = lines_.integer(k, what);
        if (id < 1 || id > atoms_) lines_.refuse(fmt::format("names atom {}; there are 1 to {}", id, atoms_));
        return id - 1;
    }

    void read_bonds()
    {
        for (std::int64_t k = 0; k < bonds_; ++k) {
            if (!advance()) lines_.refuse(fmt::format("the file ends after {} of {} bonds", k, bonds_));
            const std::int64_t type = lines_.integer(1, "the bond type");
            if (type != 1 && type != 2)
                lines_.refuse(fmt::format("needs bond type 1 (beam) or 2 (contact beam), got {}", type));
            Draft::Link bond{atom(2, "the first atom"), atom(3, "the second atom"), type == 2, 0.0, lines_.number()};
            if (bond.i == bond.j) lines_.refuse(fmt::format("joins atom {} to itself", bond.i + 1));
            if (const std::size_t T = lines_.comment().find("T = "); T != std::string_view::npos) {
                const std::string_view number = lines_.comment().substr(T + 4);
                if (std::from_chars(number.data(), number.data() + number.size(), bond.thickness).ec != std::errc{})
                    lines_.refuse(fmt::format("needs a number after \"T =\", got \"{}\"", number));
            }
            draft_.bonds.push_back(bond);
        }
        advance();
    }

    TextLines lines_;
    Draft& draft_;
    double unit_;
    Vec3 low_;
    std::int64_t atoms_ = 0, bonds_ = 0;
    bool at_end_ = false;
};

}  // namespace

void read_lammps(const Source& source, Draft& draft) { LammpsReader(source, draft).read(); }

}  // namespace craze::domain
