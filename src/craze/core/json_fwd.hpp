// For headers that name Json without its weight.

#pragma once

#include <nlohmann/json_fwd.hpp>

namespace craze {
using Json = nlohmann::ordered_json;
}
