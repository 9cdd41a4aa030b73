// The second generator: splats are sprayed one on another, and defects arise where they do not fit.
//
// A splat is a pancake with a ragged rim. Its melt cannot enter valleys sharper than `filling`: what stays open below
// it is an irregular pore. Where it touches, a share of the interface stays unbonded: an inter-splat crack. On cooling
// it breaks into islands: the walls between them are intra-splat cracks. Gas leaves globular pores.

#pragma once

#include "craze/core/schema.hpp"
#include "craze/synth/coating.hpp"
#include "craze/synth/length.hpp"

#include <cstdint>

namespace craze::synth {

struct Splats {
    Length thickness{1.3e-6, 0.3, 0.5e-6, 4e-6};  ///< in the middle of a splat
    Length radius{6e-6, 0.3, 2e-6, 15e-6};
    double raggedness = 0.15;                     ///< of the rim, over the radius
    double filling = 0.3e-6;                      ///< radius of the sharpest valley that melt fills, m
    double bubbles = 0.025;                       ///< porosity of globular pores
    Length bubble{0.4e-6, 0.3, 0.25e-6, 0.9e-6};  ///< radius; bubbles thicker than their splat shrink to fit
    double unbonded = 0.12;                       ///< share of the interfaces that is an inter-splat crack
    double patch = 2.5e-6;                        ///< size of an unbonded patch, m
    double island = 2.5e-6;                       ///< distance of the intra-splat cracks, m
    double cracked = 0.5;                         ///< share of the walls between islands that is cracked
    Length aperture{62e-9, 0.45, 6e-9, 380e-9};   ///< greatest opening of both kinds of cracks
};

void describe(Schema& schema, Splats& splats);
/// @throws InvalidInput  naming the key
void check(const Splats& splats);

/// Sprays until the box is full. Populations: pores 0 bubbles, 1 between splats; cracks 0 intra-splat, 1 inter-splat.
Coating spray(const Splats& splats, const Vec3& size, std::uint64_t seed);

}  // namespace craze::synth
