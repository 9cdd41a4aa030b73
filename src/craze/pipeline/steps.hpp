// Rooms as steps of a run: what has been done is remembered by content, what is done is never left half.

#pragma once

#include "craze/core/json_fwd.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace craze::pipeline {

/// One room's work. It writes its results into `<out>/<name>/` and gives its summary.
struct Step {
    std::string name;
    std::string content;             ///< all that decides its result, apart from earlier steps: settings, input files
    std::vector<std::string> after;  ///< the earlier steps whose results it reads
    std::function<Json(const std::filesystem::path& folder)> work;
    bool takes_what_is_there = false;  ///< done by itself it needs any earlier results, not those of `after`
};

/// What became of a step.
struct Done {
    std::string name;
    std::string key;       ///< digest of content, version and the keys of the steps before it
    bool skipped = false;  ///< its results were there already
    double seconds = 0.0;
};

/// Does the steps in order. After each: `<out>/<name>/summary.json` (the step's keys, then "notices", "seconds",
/// "peak_memory_bytes") and, last of all, `stamp.json` with its key. With `resume`, a step whose stamp holds the same
/// key is skipped. A step that fails or is interrupted leaves no stamp, and those before it stay; one that fails before
/// it has written anything leaves its earlier results as they were.
std::vector<Done> run_steps(const std::vector<Step>& steps, const std::filesystem::path& out, bool resume);

/// Does the one step called `name` from what earlier steps left in `out`.
/// @throws InvalidInput  when a step it reads has not been done; a notice when that was done with other settings
Done run_one(const std::vector<Step>& steps, const std::string& name, const std::filesystem::path& out);

/// The summary a step left, null where it left none.
Json read_summary(const std::filesystem::path& out, const std::string& name);

}  // namespace craze::pipeline
