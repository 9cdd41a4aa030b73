// The JSON of summaries: keys keep the order they are written in. Heavy: include it in sources, not in headers.

#pragma once

#include <nlohmann/json.hpp>

namespace craze {
using Json = nlohmann::ordered_json;
}
