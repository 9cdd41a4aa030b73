// Signed numbers as indices of standard containers.

#pragma once

#include <concepts>
#include <cstddef>

namespace craze {

/// k as the index of a container. @pre k >= 0
template <std::integral Integer>
constexpr std::size_t at(Integer k)
{
    return static_cast<std::size_t>(k);
}

}  // namespace craze
