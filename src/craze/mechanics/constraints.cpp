#include "craze/mechanics/constraints.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace craze::mechanics {

Face find_face(const Lattice& lattice, int axis, bool high, double reach)
{
    const auto& at = axis == 0 ? lattice.x : axis == 1 ? lattice.y : lattice.z;
    Face face{axis, high, {}};
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const auto k = static_cast<std::size_t>(e);
        const double to_wall = high ? lattice.box[axis] - at[k] : at[k];
        if (to_wall <= reach * lattice.r[k]) face.elements.push_back(e);
    }
    if (face.elements.empty())
        throw ComputationFailed(fmt::format(
            "no element touches the {} face along {}: nothing can be held or driven there. Does the matter reach the "
            "wall of the box? Try a larger volume or another axis",
            high ? "high" : "low", "xyz"[axis]));
    return face;
}

void Constraints::impose(std::int32_t e, int c, double to)
{
    const std::int64_t wanted = 6 * static_cast<std::int64_t>(e) + c;
    const auto at = std::lower_bound(dof.begin(), dof.end(), wanted);
    const auto k = at - dof.begin();
    if (at != dof.end() && *at == wanted) {
        value[static_cast<std::size_t>(k)] = to;
        return;
    }
    dof.insert(at, wanted);
    value.insert(value.begin() + k, to);
}

void Constraints::impose_normal(const Face& face, double displacement)
{
    // Both lists ascend: merge them in one go.
    Constraints merged;
    std::size_t k = 0;
    const auto keep_below = [&](std::int64_t limit) {
        for (; k < dof.size() && dof[k] < limit; ++k) merged.dof.push_back(dof[k]), merged.value.push_back(value[k]);
    };
    for (const std::int32_t e : face.elements) {
        const std::int64_t wanted = 6 * static_cast<std::int64_t>(e) + face.axis;
        keep_below(wanted);
        if (k < dof.size() && dof[k] == wanted) ++k;
        merged.dof.push_back(wanted), merged.value.push_back(displacement);
    }
    keep_below(6 * std::int64_t{INT32_MAX});
    *this = std::move(merged);
}

double face_force(const Face& face, std::span<const double> force)
{
    double sum = 0.0;
    for (const std::int32_t e : face.elements)
        sum -= force[static_cast<std::size_t>(6 * static_cast<std::int64_t>(e) + face.axis)];
    return sum;
}

}  // namespace craze::mechanics
