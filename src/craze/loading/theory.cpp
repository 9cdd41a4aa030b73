#include "craze/loading/theory.hpp"

#include "craze/core/errors.hpp"

#include <fmt/core.h>

namespace craze::loading {

Elastic elastic_from(double K, double G)
{
    return {9.0 * K * G / (3.0 * K + G), (3.0 * K - 2.0 * G) / (6.0 * K + 2.0 * G)};
}

double porous_modulus(const Elastic& dense, double p)
{
    const double nu = dense.nu;
    return dense.E * (1.0 - p * 3.0 * (1.0 - nu) * (9.0 + 5.0 * nu) / (2.0 * (7.0 - 5.0 * nu)));
}

Elastic hashin_shtrikman(const Elastic& dense, double p)
{
    const double K = dense.bulk(), G = dense.shear(), f = 1.0 - p;
    const double bulk = K + p / (-1.0 / K + 3.0 * f / (3.0 * K + 4.0 * G));
    const double shear = G + p / (-1.0 / G + 6.0 * f * (K + 2.0 * G) / (5.0 * G * (3.0 * K + 4.0 * G)));
    return elastic_from(bulk, shear);
}

Elastic non_interacting_pennies(const Elastic& dense, double density)
{
    const double nu = dense.nu, e = density;
    const double E = dense.E / (1.0 + 16.0 * (1.0 - nu * nu) * (10.0 - 3.0 * nu) * e / (45.0 * (2.0 - nu)));
    const double K = dense.bulk() / (1.0 + 16.0 * (1.0 - nu * nu) * e / (9.0 * (1.0 - 2.0 * nu)));
    return {E, 0.5 - E / (6.0 * K)};
}

Elastic self_consistent_pennies(const Elastic& dense, double density)
{
    if (!(density >= 0.0 && density < 9.0 / 16.0))
        throw InvalidInput(fmt::format("self-consistent pennies: density must lie in [0, 9/16), got {}", density));
    // Density as a function of the effective ratio falls from 9/16 at nu = 0 to 0 at nu = nu_0.
    const double nu_0 = dense.nu;
    const auto density_at = [&](double nu) {
        return 45.0 / 16.0 * (nu_0 - nu) * (2.0 - nu) / ((1.0 - nu * nu) * (10.0 * nu_0 - nu * (1.0 + 3.0 * nu_0)));
    };
    double low = 0.0, high = nu_0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (density_at(middle) > density ? low : high) = middle;
    }
    const double nu = 0.5 * (low + high);
    return {dense.E * (1.0 - 16.0 / 45.0 * (1.0 - nu * nu) * (10.0 - 3.0 * nu) / (2.0 - nu) * density), nu};
}

double modulus_across_pennies(const Elastic& dense, double density)
{
    return dense.E / (1.0 + 16.0 / 3.0 * (1.0 - dense.nu * dense.nu) * density);
}

}  // namespace craze::loading
