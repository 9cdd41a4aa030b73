#include "craze/reproduce/candidate.hpp"

namespace craze::reproduce {

synth::Settings recipe()
{
    synth::Settings s;
    s.pores[1].scatter = 100.0;
    s.cracks[0] = {.name = "intra-splat cracks",
                   .shape = synth::CrackShape::wavy,
                   .radius = {1.6e-6, 0.35, 0.3e-6, 5e-6},
                   .elongation = 1.3,
                   .normals = {0.35, 0.65, 0.0},
                   .scatter = 0.25,
                   .aperture = {90e-9, 0.5, 1e-9, 500e-9},
                   .density = 0.286,
                   .porosity = 0.0275};
    s.cracks[1] = {.name = "inter-splat cracks",
                   .shape = synth::CrackShape::bent,
                   .radius = {1.6e-6, 0.35, 0.3e-6, 5e-6},
                   .elongation = 1.3,
                   .bend = 0.2,
                   .normals = {0.0, 0.0, 1.0},
                   .scatter = 0.25,
                   .aperture = {90e-9, 0.5, 1e-9, 500e-9},
                   .density = 0.042,
                   .porosity = 0.0040};
    return s;
}

}  // namespace craze::reproduce
