#include "craze/pipeline/run_record.hpp"

#include "craze/core/json.hpp"
#include "craze/core/parallel.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/version.hpp"

#include <fmt/chrono.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

namespace craze::pipeline {

namespace {

std::string processor()
{
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

Json machine()
{
    utsname system{};
    uname(&system);
    return {{"processor", processor()},
            {"cores", omp_get_num_procs()},
            {"memory_bytes", sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGE_SIZE)},
            {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)}};
}

}  // namespace

Json run_record(const Settings& settings, const RunOptions& options, const std::vector<Done>& done, bool finished)
{
    Settings shown = settings;
    Json record;
    record["craze"] = version;
    record["compiler"] = __VERSION__;
    record["time"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    record["settings_file"] = options.settings_file.string();
    record["overrides"] = options.overrides;
    record["threads"] = threads();
    record["machine"] = machine();
    record["settings"] = settings_json([&](Schema& schema) { describe(schema, shown); });
    Json rooms = Json::object();
    for (const Done& room : done)
        rooms[room.name] = {{"key", room.key}, {"skipped", room.skipped}, {"seconds", room.seconds}};
    record["rooms"] = rooms;
    record["peak_memory_bytes"] = peak_memory();
    record["finished"] = finished;
    return record;
}

}  // namespace craze::pipeline
