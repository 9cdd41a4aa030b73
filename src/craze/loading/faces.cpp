#include "craze/loading/faces.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/parallel.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace craze::loading {
namespace {

constexpr std::array<const char*, 6> side_names{"x = 0", "x = most", "y = 0", "y = most", "z = 0", "z = most"};

std::int32_t root_of(std::vector<std::int32_t>& parent, std::int32_t e)
{
    auto at = [&](std::int32_t k) -> std::int32_t& { return parent[static_cast<std::size_t>(k)]; };
    while (at(e) != e) {
        at(e) = at(at(e));
        e = at(e);
    }
    return e;
}

double coordinate(const mechanics::Lattice& lattice, int axis, std::size_t e)
{
    return axis == 0 ? lattice.x[e] : axis == 1 ? lattice.y[e] : lattice.z[e];
}

}  // namespace

Faces find_faces(const mechanics::Lattice& lattice, double reach)
{
    Faces faces;
    const auto bearing = load_bearing(lattice);
    for (int axis = 0; axis < 3; ++axis)
        for (const bool most : {false, true}) {
            const auto s = static_cast<std::size_t>(2 * axis + (most ? 1 : 0));
            faces.sides[s] = mechanics::find_face(lattice, axis, most, reach);
            const auto& elements = faces.sides[s].elements;
            if (std::none_of(elements.begin(), elements.end(),
                             [&](std::int32_t e) { return bearing[static_cast<std::size_t>(e)] != 0; }))
                throw ComputationFailed(
                    fmt::format("side {}: only loose elements reach this wall of the {:.3g} x {:.3g} x {:.3g} m box, "
                                "so nothing can "
                                "be held or driven there; check that the box fits the elements, or raise "
                                "loading.face_reach (now {})",
                                side_names[s], lattice.box.x, lattice.box.y, lattice.box.z, reach));
        }
    return faces;
}

std::vector<std::uint8_t> load_bearing(const mechanics::Lattice& lattice)
{
    const auto n = static_cast<std::size_t>(lattice.elements());
    std::vector<std::int32_t> parent(n), size(n, 0);
    std::iota(parent.begin(), parent.end(), 0);
    for (std::size_t b = 0; b < lattice.i.size(); ++b) {
        if (lattice.kind[b] != domain::BondKind::beam) continue;
        const auto p = root_of(parent, lattice.i[b]), q = root_of(parent, lattice.j[b]);
        parent[static_cast<std::size_t>(std::max(p, q))] = std::min(p, q);
    }
    std::int32_t largest = 0;
    for (std::size_t e = 0; e < n; ++e)
        largest = std::max(largest, ++size[static_cast<std::size_t>(root_of(parent, static_cast<std::int32_t>(e)))]);
    std::vector<std::uint8_t> bearing(n, 0);
    if (largest < 2) return bearing;
    for (std::size_t e = 0; e < n; ++e) {
        const auto mine = size[static_cast<std::size_t>(root_of(parent, static_cast<std::int32_t>(e)))];
        bearing[e] = mine >= 2 && 100 * static_cast<std::int64_t>(mine) >= largest;
    }
    return bearing;
}

StrainGauge::StrainGauge(const mechanics::Lattice& lattice, const Faces& faces, double margin) : edges_(lattice.box)
{
    const auto bearing = load_bearing(lattice);
    for (std::size_t s = 0; s < 6; ++s)
        for (const auto e : faces.sides[s].elements)
            if (bearing[static_cast<std::size_t>(e)]) sides_[s].push_back(e);
    for (int axis = 0; axis < 3; ++axis) {
        const auto mean = [&](const std::vector<std::int32_t>& side) {
            double sum = 0.0;
            for (const auto e : side) sum += coordinate(lattice, axis, static_cast<std::size_t>(e));
            return sum / static_cast<double>(side.size());
        };
        const auto least = static_cast<std::size_t>(2 * axis);
        face_distance_[axis] = mean(sides_[least + 1]) - mean(sides_[least]);
    }

    margin = std::min(margin, 0.25 * std::min({edges_.x, edges_.y, edges_.z}));
    for (std::int32_t e = 0; e < lattice.elements(); ++e) {
        const Vec3 c = lattice.centre(e);
        bool inside = bearing[static_cast<std::size_t>(e)] != 0;
        for (int axis = 0; axis < 3; ++axis) inside = inside && c[axis] > margin && edges_[axis] - c[axis] > margin;
        if (inside) interior_.push_back(e);
    }
    for (int axis = 0; axis < 3; ++axis) {
        auto& weight = weight_[static_cast<std::size_t>(axis)];
        weight.resize(interior_.size());
        double mean = 0.0, square = 0.0;
        for (const auto e : interior_) mean += coordinate(lattice, axis, static_cast<std::size_t>(e));
        mean /= std::max(1.0, static_cast<double>(interior_.size()));
        for (std::size_t k = 0; k < interior_.size(); ++k) {
            weight[k] = coordinate(lattice, axis, static_cast<std::size_t>(interior_[k])) - mean;
            square += weight[k] * weight[k];
        }
        for (auto& w : weight) w /= square > 0.0 ? square : 1.0;
    }
}

Deformation StrainGauge::measure(const mechanics::State& state) const
{
    const auto& u = state.u;
    Deformation d;
    for (int axis = 0; axis < 3; ++axis) {
        const auto mean = [&](const std::vector<std::int32_t>& side) {
            double sum = 0.0;
            for (const auto e : side) sum += u[6 * static_cast<std::size_t>(e) + static_cast<std::size_t>(axis)];
            return sum / static_cast<double>(side.size());
        };
        const auto least = static_cast<std::size_t>(2 * axis);
        const double apart = mean(sides_[least + 1]) - mean(sides_[least]);
        d.box[axis] = apart / edges_[axis];
        d.face[axis] = apart / face_distance_[axis];
        const auto& weight = weight_[static_cast<std::size_t>(axis)];
        d.interior[axis] = parallel_sum(static_cast<std::int64_t>(interior_.size()), [&](std::int64_t k) {
            const auto e = static_cast<std::size_t>(interior_[static_cast<std::size_t>(k)]);
            return weight[static_cast<std::size_t>(k)] * u[6 * e + static_cast<std::size_t>(axis)];
        });
    }
    return d;
}

}  // namespace craze::loading
