// Which elements the pores take [3.3].

#pragma once

#include "craze/core/mask.hpp"
#include "craze/domain/domain.hpp"

#include <cstdint>
#include <vector>

namespace craze::domain {

/// 1 for each element whose centre lies in a voxel of `pore`; elements outside the stack are in none. Shape
/// (elements,).
/// @param voxel_size  h, m
std::vector<std::uint8_t> carve(const Elements& elements, const Mask& pore, double voxel_size);

}  // namespace craze::domain
