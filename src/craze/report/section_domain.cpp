// Elements and bonds that stand for the matter [3, Figs. 10, 12, 13, 16].

#include "craze/core/json.hpp"
#include "craze/domain/room.hpp"
#include "craze/report/domain_pictures.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace craze::report {

namespace {

Figure bond_lengths(const domain::Domain& dense)
{
    std::vector<double> lengths;
    for (std::int32_t b = 0; b < dense.bonds.size(); ++b)
        lengths.push_back(domain::rest_length(dense, b) / (2.0 * dense.mean_radius));
    Figure f;
    f.id = "bond_lengths";
    f.caption = "Lengths of the bonds of the dense domain over the mean diameter of the elements [Eq. 4].";
    f.x.title = "bond length / mean diameter";
    f.y.title = "bonds [%]";
    if (lengths.empty()) return f;
    const std::vector<double> weights(lengths.size(), 100.0 / static_cast<double>(lengths.size()));
    f.series = {histogram("", lengths, weights, 1.0, 120)};
    auto& s = f.series.front();
    const auto first = std::find_if(s.y.begin(), s.y.end(), [](double v) { return v > 0.0; });
    const auto empty = first - s.y.begin();
    s.y.erase(s.y.begin(), first), s.x.erase(s.x.begin(), s.x.begin() + empty);
    return f;
}

Figure cardinalities(const domain::Domain& dense)
{
    std::vector<int> count(static_cast<std::size_t>(dense.elements.size()), 0);
    for (std::size_t b = 0; b < dense.bonds.i.size(); ++b)
        ++count[static_cast<std::size_t>(dense.bonds.i[b])], ++count[static_cast<std::size_t>(dense.bonds.j[b])];
    Figure f;
    f.id = "cardinality";
    f.x.title = "bonds of an element";
    f.y.title = "elements [%]";
    if (count.empty()) return f;
    f.caption = fmt::format("Bonds of each element of the dense domain; mean {:.3g}.",
                            2.0 * static_cast<double>(dense.bonds.i.size()) / static_cast<double>(count.size()));
    Series s{"", {}, {}, Mark::bars};
    s.y.assign(static_cast<std::size_t>(*std::max_element(count.begin(), count.end())) + 1, 0.0);
    for (const int c : count) s.y[static_cast<std::size_t>(c)] += 100.0 / static_cast<double>(count.size());
    for (std::size_t k = 0; k <= s.y.size(); ++k) s.x.push_back(static_cast<double>(k) - 0.5);
    f.series = {std::move(s)};
    return f;
}

}  // namespace

void write_domain(Work& work)
{
    if (!begin_room(work, "domain", "Discrete domain")) return;
    const auto discretisation = domain::load_discretisation(work.folder.room("domain"));
    if (work.settings.scenes) draw_domain(work, discretisation);
    work.page.add("<div class=\"row\">");
    auto thickness = thickness_figure(discretisation);
    thickness.paper = work.figure("Fig. 16");
    work.page.figure(thickness);
    if (const auto file = work.folder.room("domain") / "voxel_sizes.json"; std::filesystem::is_regular_file(file)) {
        auto sizes = voxel_size_figure(read_json(file));
        sizes.paper = work.figure("Fig. 16");
        if (!sizes.empty()) work.page.figure(sizes);
    }
    work.page.figure(cardinalities(discretisation.dense));
    work.page.figure(bond_lengths(discretisation.dense));
    work.page.add("</div>");
    end_room(work, "domain");
}

}  // namespace craze::report
