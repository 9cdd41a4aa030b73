// What run.json says of a run besides its results: settings, versions, machine.

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/pipeline/pipeline.hpp"
#include "craze/pipeline/steps.hpp"

namespace craze::pipeline {

/// Keys: docs/results.md, "run.json".
Json run_record(const Settings& settings, const RunOptions& options, const std::vector<Done>& done, bool finished);

}  // namespace craze::pipeline
