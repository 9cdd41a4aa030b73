#include "craze/domain/draft.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/index.hpp"
#include "craze/domain/cells.hpp"
#include "craze/domain/validity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>

namespace craze::domain {

namespace {

std::vector<double> numbers_after(std::string_view text, std::string_view key)
{
    const std::size_t found = text.find(key);
    if (found == std::string_view::npos) return {};
    text.remove_prefix(found + key.size());
    std::vector<double> values;
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(" =\t"), text.size()));
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{}) return values;
        values.push_back(value);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
}

void scale(Draft& d, double unit)
{
    for (auto* axis : {&d.elements.x, &d.elements.y, &d.elements.z, &d.elements.r})
        for (double& value : *axis) value *= unit;
    for (auto* links : {&d.bonds, &d.near})
        for (Draft::Link& link : *links) link.thickness *= unit;
}

/// New order of elements, or none where the file's is good enough for the caches.
std::vector<std::int32_t> better_order(const Elements& e, const Vec3& box)
{
    std::int64_t falls = 0;
    for (std::int32_t k = 1; k < e.size(); ++k)
        falls += morton_code(e.centre(k), box) < morton_code(e.centre(k - 1), box);
    if (falls * 100 <= e.size()) return {};
    return morton_order(box, e.x, e.y, e.z);
}

void reorder(Draft& d, const std::vector<std::int32_t>& order)
{
    std::vector<std::int64_t> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) place[at(order[k])] = static_cast<std::int64_t>(k);
    const auto permute = [&](auto& values) {
        auto sorted = values;
        for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[at(order[k])];
        values = std::move(sorted);
    };
    permute(d.elements.x), permute(d.elements.y), permute(d.elements.z), permute(d.elements.r);
    permute(d.element_line);
    for (auto* links : {&d.bonds, &d.near})
        for (Draft::Link& link : *links) link.i = place[at(link.i)], link.j = place[at(link.j)];
}

/// What concerns indices, asked in the file's own numbers before anything is sorted.
void check_links(const std::vector<Draft::Link>& links, const std::filesystem::path& file, const char* what,
                 std::int64_t elements)
{
    std::unordered_map<std::int64_t, std::int64_t> seen;
    seen.reserve(links.size());
    for (const Draft::Link& link : links) {
        const auto refuse = [&](const std::string& why) {
            throw InvalidInput(fmt::format("{}, line {}: {} {}", file.string(), link.line, what, why));
        };
        for (const std::int64_t e : {link.i, link.j})
            if (e < 0 || e >= elements) refuse(fmt::format("names element {}; there are 0 to {}", e, elements - 1));
        if (link.i == link.j) refuse(fmt::format("joins element {} to itself", link.i));
        const auto [before, first] =
            seen.emplace(std::min(link.i, link.j) * elements + std::max(link.i, link.j), link.line);
        if (!first) refuse(fmt::format("joins {} and {} again, after line {}", link.i, link.j, before->second));
    }
}

void sort_links(std::vector<Draft::Link>& links)
{
    for (Draft::Link& link : links)
        if (link.i > link.j) std::swap(link.i, link.j);
    std::ranges::sort(links, [](const auto& a, const auto& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
}

}  // namespace

void Draft::add_element(const io::TextLines& line, const Vec3& centre, double radius)
{
    elements.x.push_back(centre.x);
    elements.y.push_back(centre.y);
    elements.z.push_back(centre.z);
    elements.r.push_back(radius);
    element_line.push_back(line.number());
}

void read_remark(std::string_view comment, Draft& draft)
{
    if (const auto v = numbers_after(comment, "box_m"); v.size() == 3) draft.box = Vec3{v[0], v[1], v[2]};
    if (const auto v = numbers_after(comment, "mean_radius_m"); v.size() == 1) draft.mean_radius = v[0];
    if (const auto v = numbers_after(comment, "dense_volume_m3"); v.size() == 1) draft.dense_volume = v[0];
}

std::vector<std::string> remarks(const Domain& d)
{
    return {fmt::format("box_m = {} {} {}", d.box.x, d.box.y, d.box.z),
            fmt::format("mean_radius_m = {}", d.mean_radius), fmt::format("dense_volume_m3 = {}", d.dense_volume)};
}

Domain finish(Draft draft, const Source& source)
{
    if (draft.elements.size() == 0)
        throw InvalidInput(fmt::format("{}: holds no element", draft.elements_file.string()));
    if (!(source.unit > 0.0 && std::isfinite(source.unit)))
        throw InvalidInput(fmt::format("import: needs a positive unit of length, got {} m", source.unit));
    scale(draft, source.unit);

    const Elements& e = draft.elements;
    Domain d;
    for (std::int32_t k = 0; k < e.size(); ++k)
        for (const double value : {e.x[at(k)], e.y[at(k)], e.z[at(k)], e.r[at(k)]})
            if (!std::isfinite(value))
                throw InvalidInput(fmt::format("{}, line {}: element {} is not finite", draft.elements_file.string(),
                                               draft.element_line[at(k)], k));
    if (source.box) {
        d.box = *source.box;
    } else if (draft.box) {
        d.box = *draft.box;
    } else {
        for (std::int32_t k = 0; k < e.size(); ++k)
            for (int axis = 0; axis < 3; ++axis) d.box[axis] = std::max(d.box[axis], e.centre(k)[axis] + e.r[at(k)]);
    }
    d.mean_radius = source.mean_radius ? *source.mean_radius
                    : draft.mean_radius
                        ? *draft.mean_radius
                        : std::accumulate(e.r.begin(), e.r.end(), 0.0) / static_cast<double>(e.r.size());

    check_links(draft.bonds, draft.bonds_file, "bond", e.size());
    check_links(draft.near, draft.near_file, "near pair", e.size());
    if (const auto order = better_order(e, d.box); !order.empty()) reorder(draft, order);
    sort_links(draft.bonds);
    sort_links(draft.near);

    d.elements = std::move(draft.elements);
    double spheres = 0.0;
    for (const double r : d.elements.r) spheres += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    const double dense_volume = draft.dense_volume.value_or(spheres);
    d.dense_volume = dense_volume;
    for (const Draft::Link& b : draft.bonds) {
        d.bonds.i.push_back(static_cast<std::int32_t>(b.i));
        d.bonds.j.push_back(static_cast<std::int32_t>(b.j));
        d.bonds.kind.push_back(b.contact ? BondKind::contact_beam : BondKind::beam);
        d.bonds.thickness.push_back(b.thickness);
    }
    for (const Draft::Link& p : draft.near) {
        d.near.i.push_back(static_cast<std::int32_t>(p.i));
        d.near.j.push_back(static_cast<std::int32_t>(p.j));
        d.near.thickness.push_back(p.thickness);
    }
    check_domain(d, [&](Part part, std::size_t index) {
        const auto& file = part == Part::element ? draft.elements_file
                           : part == Part::bond  ? draft.bonds_file
                                                 : draft.near_file;
        const std::int64_t line = part == Part::element ? draft.element_line[index]
                                  : part == Part::bond  ? draft.bonds[index].line
                                                        : draft.near[index].line;
        return fmt::format("{}, line {}: {}", file.string(), line, name_of(part));
    });

    if (!draft.has_bonds) {
        d = join(std::move(d.elements), d.box, d.mean_radius, source.bonding);
    } else if (!draft.has_near) {
        const Pairs pairs = pairs_within(d.elements, d.box, source.bonding.near_gap * d.mean_radius);
        for (std::size_t p = 0, b = 0; p < pairs.i.size(); ++p) {
            const auto key = std::pair{pairs.i[p], pairs.j[p]};
            while (b < d.bonds.i.size() && std::pair{d.bonds.i[b], d.bonds.j[b]} < key) ++b;
            if (b < d.bonds.i.size() && std::pair{d.bonds.i[b], d.bonds.j[b]} == key) continue;
            d.near.i.push_back(pairs.i[p]);
            d.near.j.push_back(pairs.j[p]);
            d.near.thickness.push_back(0.0);
        }
    }
    d.dense_volume = dense_volume;  // join, which knows the spheres alone, has set its own
    return d;
}

}  // namespace craze::domain
