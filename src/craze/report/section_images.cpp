// Images: slices, and a quality sheet per step [2.3, Fig. 3].

#include "craze/core/json.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/report/sections.hpp"
#include "craze/report/slices.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace craze::report {

namespace fs = std::filesystem;

namespace {

/// Pictures that a room left, in the order of their names.
void pictures(Work& work, std::string_view room, std::string_view begin, const std::string& caption,
              const std::string& paper)
{
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(work.folder.room(room)))
        if (entry.path().extension() == ".png" && entry.path().filename().string().starts_with(begin))
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    constexpr std::int64_t widest = 1200;
    for (const auto& file : files) {
        auto name = file.stem().string().substr(begin.size());
        name.erase(0, name.find_first_not_of("0123456789_"));
        std::replace(name.begin(), name.end(), '_', ' ');
        auto picture = io::read_png(file);
        if (picture.channels == 1) picture = averaged_down(picture, (picture.width + widest - 1) / widest);
        work.page.picture(fmt::format("{}_{}", room, file.stem().string()), io::png_bytes(picture),
                          fmt::format("{}: {}.", caption, name), paper);
    }
}

void quality_sheet(Work& work, const Json& steps)
{
    if (!steps.is_array() || steps.empty()) return;
    work.page.subtitle("Quality after each step");
    struct Column {
        const char* title;
        std::initializer_list<std::string_view> keys;
    };
    const Column columns[] = {{"noise σ [gray]", {"noise"}},   {"stripes rms [gray]", {"stripes"}},
                              {"shading [gray]", {"shading"}}, {"solid [gray]", {"solid_level"}},
                              {"void [gray]", {"dark_level"}}, {"contrast / noise", {"contrast_to_noise"}}};
    Table table{{"step"}, {}, ""};
    for (const auto& c : columns) table.head.emplace_back(c.title);
    for (const Json& step : steps) {
        std::vector<std::string> row{escape(step.value("step", std::string("?")))};
        for (const auto& c : columns) row.push_back(cell(find_number(step, c.keys), 1.0, 3));
        table.rows.push_back(std::move(row));
    }
    work.page.add(html(table));
}

/// All columns of a CSV over its first; a first abscissa of 0 has no place on a logarithmic axis nor meaning here.
Figure plain_plot(const CsvColumns& csv, std::string id, std::string caption, Axis x, Axis y)
{
    Figure f;
    f.id = std::move(id), f.caption = std::move(caption), f.x = std::move(x), f.y = std::move(y);
    for (std::size_t c = 1; c < csv.names.size(); ++c) {
        auto name = csv.names[c];
        std::replace(name.begin(), name.end(), '_', ' ');
        f.series.push_back({name, csv.numbers(0), csv.numbers(c)});
        auto& series = f.series.back();
        if (f.y.log && !series.x.empty() && series.x.front() == 0.0)
            series.x.erase(series.x.begin()), series.y.erase(series.y.begin());
    }
    return f;
}

}  // namespace

void write_synth(Work& work)
{
    if (!work.folder.has("synth")) return;
    begin_room(work, "synth", "Synthetic coating");
    work.page.text(
        "The stack of this run is artificial: pores and cracks of known place, size and aperture, photographed with "
        "the "
        "faults of a microscope. The truth is written beside the stack and never read by the chain.");
    end_room(work, "synth");
}

void write_images(Work& work)
{
    const bool there = begin_room(work, "images", "Images");
    write_slices(work);
    if (!there) return;
    quality_sheet(work, find(work.folder.summary("images"), "quality"));
    work.page.add("<div class=\"row\">");
    if (const auto csv = work.folder.csv("images", "transforms.csv"); csv && csv->has("shift_x_px"))
        work.page.figure([&] {
            Figure f;
            f.id = "alignment";
            f.caption = "Correction of each slice by the alignment.";
            f.x.title = "slice";
            f.y.title = "correction [px]";
            f.series = {{"x", csv->numbers(0), csv->numbers("shift_x_px")},
                        {"y", csv->numbers(0), csv->numbers("shift_y_px")}};
            return f;
        }());
    if (const auto csv = work.folder.csv("images", "spectrum.csv"))
        work.page.figure(plain_plot(*csv, "stripe_spectrum",
                                    "Power of what runs along the stripes against waves across them, after each step.",
                                    {"waves per pixel across the stripes"}, {"power [gray²]", true}));
    if (const auto csv = work.folder.csv("images", "profile.csv"))
        work.page.figure(
            plain_plot(*csv, "illumination",
                       "Gray level of the solid in layers along the gradient of illumination, before it was removed.",
                       {"layer [px]"}, {"gray level"}));
    work.page.add("</div>");
    pictures(work, "images", "strip_", "Three slices after the step", work.figure("Fig. 3"));
    end_room(work, "images");
}

}  // namespace craze::report
