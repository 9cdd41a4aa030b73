// Young's modulus of a specimen, mean over the three axes.

#pragma once

#include "craze/loading/rig.hpp"

namespace craze::support {

inline double mean_modulus(const domain::Domain& specimen, double residual = 1e-5)
{
    loading::Rig rig(specimen, {}, {}, {.residual = residual});
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
        loading::Loading l;
        l.axis = static_cast<int>(a);
        l.drive[a] = {false, 1.0};
        l.path = {1e-4};
        const loading::Point p = rig.rest(l).points.back();
        sum += p.stress[l.axis] / p.strain[l.axis] / 3.0;
    }
    return sum;
}

}  // namespace craze::support
