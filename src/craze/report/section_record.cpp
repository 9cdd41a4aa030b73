// How the results came about: settings, versions, machine, times.

#include "craze/core/json.hpp"
#include "craze/report/sections.hpp"

#include <fmt/format.h>

namespace craze::report {

namespace {

void times(Work& work)
{
    Table table{{"step", "time", "peak memory [MiB]"}, {}, ""};
    double sum = 0.0;
    for (const char* room : {"synth", "images", "microstructure", "mesh", "domain", "loading"}) {
        const Json& summary = work.folder.summary(room);
        const double seconds = find_number(summary, {"seconds"});
        if (summary.is_null()) continue;
        if (seconds > 0.0) sum += seconds;
        table.rows.push_back(
            {room, format_seconds(seconds), cell(find_number(summary, {"peak_memory_bytes"}), 1048576.0, 4)});
    }
    if (table.rows.empty()) return;
    table.rows.push_back({"all", format_seconds(sum), ""});
    work.page.subtitle("Times");
    work.page.add(html(table));
}

}  // namespace

void write_record(Work& work)
{
    work.page.section("run", "Record of the run");
    times(work);
    const Json& run = work.folder.run();
    if (run.is_null()) {
        work.page.remark("The folder holds no run.json: settings, versions and machine of this run are not known.");
        return;
    }
    Json rest = Json::object();
    for (const auto& [key, value] : run.items())
        if (key != "settings") rest[key] = value;
    work.page.subtitle("Run");
    work.page.add(summary_table(rest));
    if (const Json& settings = find(run, "settings"); !settings.is_null()) {
        work.page.subtitle("Settings");
        work.page.folded("Every setting of this run", summary_table(settings));
    }
}

}  // namespace craze::report
