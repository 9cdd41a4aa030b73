#include "craze/pipeline/steps.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/hash.hpp"
#include "craze/core/json.hpp"
#include "craze/core/progress.hpp"
#include "craze/core/version.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

namespace craze::pipeline {

namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> keys_of(const std::vector<Step>& steps)
{
    std::map<std::string, std::string> keys;
    for (const Step& step : steps) {
        Hash hash;
        hash.add(version).add(step.name).add(step.content);
        for (const std::string& before : step.after) hash.add(keys.at(before));
        keys[step.name] = hash.digest();
    }
    return keys;
}

// The key in a step's stamp, empty where there is none.
std::string stamped(const fs::path& out, const std::string& name)
{
    const fs::path file = out / name / "stamp.json";
    if (!fs::exists(file)) return "";
    const Json stamp = Json::parse(io::read_text(file), nullptr, false);
    return stamp.is_object() ? stamp.value("key", "") : "";
}

/// What lies in a folder, with the time each file was written.
std::map<fs::path, fs::file_time_type> files_in(const fs::path& folder)
{
    std::map<fs::path, fs::file_time_type> files;
    std::error_code error;
    for (auto at = fs::recursive_directory_iterator(folder, error); at != fs::recursive_directory_iterator();
         at.increment(error)) {
        if (error) break;
        if (at->is_regular_file(error)) files[at->path()] = at->last_write_time(error);
    }
    return files;
}

/// Takes the stamp away while a step works, and gives it back if the step fails with all its files untouched.
class StampAside {
public:
    explicit StampAside(fs::path folder) : folder_(std::move(folder))
    {
        if (fs::exists(folder_ / "stamp.json")) stamp_ = io::read_text(folder_ / "stamp.json");
        fs::remove(folder_ / "stamp.json");
        before_ = files_in(folder_);
        // A file written this moment could be written again at the same time stamp.
        const auto now = fs::file_time_type::clock::now() - std::chrono::milliseconds(100);
        for (const auto& [file, time] : before_) fresh_ = fresh_ || time > now;
    }
    StampAside(const StampAside&) = delete;
    StampAside& operator=(const StampAside&) = delete;
    ~StampAside()
    {
        if (stamp_.empty() || done_ || fresh_ || files_in(folder_) != before_) return;
        try {
            io::write_text(folder_ / "stamp.json", stamp_);
        } catch (const std::exception&) {  // the failure that brought us here is the one to tell
        }
    }
    void done() { done_ = true; }

private:
    fs::path folder_;
    std::string stamp_;
    std::map<fs::path, fs::file_time_type> before_;
    bool done_ = false, fresh_ = false;
};

Done work(const Step& step, const std::string& key, const fs::path& out)
{
    const fs::path folder = out / step.name;
    StampAside stamp(folder);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw InvalidInput(fmt::format("{}: the folder cannot be made ({})", folder.string(), error.message()));

    check_interrupt();
    say(fmt::format("{}:", step.name));
    const Stopwatch watch;
    Json summary = step.work(folder);
    const double seconds = watch.seconds();
    summary["notices"] = take_notices();
    summary["seconds"] = seconds;
    summary["peak_memory_bytes"] = peak_memory();
    io::write_text(folder / "summary.json", summary.dump(2) + "\n");
    io::write_text(folder / "stamp.json", Json{{"key", key}, {"craze", version}}.dump(2) + "\n");
    stamp.done();
    say(fmt::format("{}: done in {:.1f} s", step.name, seconds));
    return {step.name, key, false, seconds};
}

}  // namespace

std::vector<Done> run_steps(const std::vector<Step>& steps, const fs::path& out, bool resume)
{
    const auto keys = keys_of(steps);
    std::vector<Done> all;
    take_notices();
    for (const Step& step : steps) {
        const std::string& key = keys.at(step.name);
        if (resume && stamped(out, step.name) == key) {
            say(fmt::format("{}: unchanged, skipped", step.name));
            all.push_back({step.name, key, true, 0.0});
            continue;
        }
        all.push_back(work(step, key, out));
    }
    return all;
}

Done run_one(const std::vector<Step>& steps, const std::string& name, const fs::path& out)
{
    const auto step = std::find_if(steps.begin(), steps.end(), [&](const Step& s) { return s.name == name; });
    if (step == steps.end()) throw InvalidInput(fmt::format("{}: this run has no such room", name));
    const auto keys = keys_of(steps);
    take_notices();
    if (step->takes_what_is_there &&
        std::ranges::none_of(steps, [&](const Step& s) { return !stamped(out, s.name).empty(); }))
        throw InvalidInput(
            fmt::format("{}: {} holds the results of no room; run 'craze run' first, or point --out to "
                        "where they are",
                        name, out.string()));
    for (const std::string& before : step->after) {
        const std::string found = stamped(out, before);
        if (found.empty() && step->takes_what_is_there) continue;
        if (found.empty())
            throw InvalidInput(
                fmt::format("{0}: needs the results of {1}, and {2} has none; run 'craze {1}' or 'craze run' "
                            "first, or point --out to where they are",
                            name, before, (out / before).string()));
        if (found != keys.at(before))
            notice(fmt::format("{}: the results of {} in {} were made with other settings or input", name, before,
                               (out / before).string()));
    }
    return work(*step, keys.at(name), out);
}

Json read_summary(const fs::path& out, const std::string& name)
{
    const fs::path file = out / name / "summary.json";
    return fs::exists(file) ? Json::parse(io::read_text(file), nullptr, false) : Json();
}

}  // namespace craze::pipeline
