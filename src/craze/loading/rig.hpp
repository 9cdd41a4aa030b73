// A specimen clamped into the testing machine: made once, loaded many times.

#pragma once

#include "craze/loading/faces.hpp"
#include "craze/loading/response.hpp"
#include "craze/mechanics/equilibrium.hpp"

#include <array>
#include <functional>
#include <optional>
#include <span>

namespace craze::loading {

struct RigOptions {
    double face_reach = 1.05;       ///< Settings::face_reach
    double interior_margin = 10.0;  ///< Settings::interior_margin
    double residual = 1e-6;         ///< Settings::residual: of loadings of one state, moduli
    double curve_residual = 5e-5;   ///< Settings::curve_residual: of loadings of several
};

/// What is drawn or kept of a state as a loading goes by.
struct Moment {
    const Loading& loading;
    const Point& point;
    std::int64_t index;  ///< of the point on its curve
    const mechanics::State& state;
    const mechanics::Forces& forces;
    std::span<const double> velocity;         ///< shape (n, 6), m/s and rad/s; empty at rest
    bool last;                                ///< no other follows
    std::span<const BrokenBond> broken = {};  ///< up to now
};
using Watcher = std::function<void(const Moment&)>;

class Rig {
public:
    /// @throws InvalidInput, ComputationFailed  when the domain or the beams cannot be loaded
    Rig(const domain::Domain& domain, const mechanics::BeamMaterial& beam, const mechanics::DenseMaterial& dense,
        const RigOptions& options);
    Rig(const Rig&) = delete;  // the solver keeps the lattice's address
    Rig& operator=(const Rig&) = delete;

    const mechanics::Lattice& lattice() const { return lattice_; }
    const Faces& faces() const { return faces_; }
    const StrainGauge& gauge() const { return gauge_; }
    const mechanics::DenseMaterial& dense() const { return dense_; }
    /// Volume of the spheres of the dense packing over the volume of the box.
    double fill() const { return fill_; }

    /// Sides of the driven axes at program strain s: the least one held, the other at s factor times the edge.
    mechanics::Constraints constraints(const Loading& loading, double s) const;
    /// Everything that can be said of one state; work, K and what motion adds are left to the caller.
    Point measure(const Loading& loading, double s, const mechanics::State& state,
                  const mechanics::Forces& forces) const;

    /// States of rest along the path of a loading.
    /// @throws ComputationFailed  with the strain reached and what to try
    Curve rest(const Loading& loading, const Watcher& watch = {});

    /// One state of rest, started from an earlier one where one is at hand.
    mechanics::Equilibrium solve(const Loading& loading, double s, mechanics::State start);

private:
    mechanics::Lattice lattice_;
    mechanics::DenseMaterial dense_;
    RigOptions options_;
    double fill_ = 1.0;
    Faces faces_;
    StrainGauge gauge_;
    mechanics::EquilibriumSolver solver_;
    std::array<std::optional<mechanics::State>, 3>
        small_;  ///< per unit of uniaxial strain: where the next loading starts
};

}  // namespace craze::loading
