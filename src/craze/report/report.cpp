#include "craze/report/report.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"
#include "craze/io/atomic_file.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

namespace craze::report {

namespace {

using Writer = void (*)(Work&);

/// A section that cannot be written must not take the others with it.
void guarded(Writer write, Work& work, std::string_view name)
{
    check_interrupt();
    try {
        write(work);
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        notice(fmt::format("report: the section on {} is cut short: {}", name, error.what()));
        work.page.remark(fmt::format("This section is cut short: {}", error.what()));
    }
}

}  // namespace

void describe(Schema& schema, Settings& settings)
{
    schema.text("title", settings.title, "title of the page");
    schema.option("paper", settings.paper, {"automatic", "always", "never"},
                  "the paper's printed numbers beside ours; automatic: when the run starts from a synthetic coating");
    schema.integer("slices", settings.slices, {1, 64}, "slices in the viewer, evenly spaced along the stack");
    schema.integer("picture_width", settings.picture_width, {64, 2048}, "widest picture of a slice, pixels");
    schema.flag("scenes", settings.scenes, "crack surface and domain in 3D");
    schema.integer("triangles", settings.triangles, {100, 200'000}, "most triangles of the crack surface in the page");
    schema.integer("elements", settings.elements, {100, 200'000}, "most elements of the domain in the page");
    schema.integer("render_width", settings.render_width, {200, 6000}, "width of the rendered pictures, pixels");
}

void check(const Settings& settings)
{
    if (settings.title.find_first_not_of(" \t") == std::string::npos)
        throw InvalidInput(
            "[report] title: needs at least one letter, is empty; leave the key out for the default title");
}

std::filesystem::path write_report(const std::filesystem::path& out, const Settings& settings)
{
    check(settings);
    const OutputFolder folder(out);
    const auto target = out / "report";
    Page page(settings.title, target);
    const bool paper =
        settings.paper == PaperNumbers::always || (settings.paper == PaperNumbers::automatic && folder.has("synth"));
    Work work{folder, settings, paper, page};
    struct Part {
        std::string_view name;
        Writer write;
    };
    constexpr Part parts[] = {{"results", write_overview}, {"synth", write_synth},
                              {"images", write_images},    {"microstructure", write_microstructure},
                              {"mesh", write_mesh},        {"domain", write_domain},
                              {"loading", write_loading},  {"reproduction", write_reproduction},
                              {"the run", write_record}};
    for (const auto& [name, write] : parts) guarded(write, work, name);
    const auto file = target / "index.html";
    io::write_text(file, page.finish());
    return file;
}

}  // namespace craze::report
