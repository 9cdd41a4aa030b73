#include "craze/loading/calibration.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/progress.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace craze::loading {
namespace {

constexpr double least_ratio = 0.05, most_ratio = 1.0;
constexpr double usual_slope = -0.37;  // d nu / d r~ near Table 2

double mean(const Vec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// Tension along some axes of the dense packing; each axis starts from where its last trial ended.
class Tensions {
public:
    Tensions(const domain::Domain& dense, const mechanics::DenseMaterial& target, const CalibrationOptions& options)
        : dense_(dense), target_(target), options_(options)
    {
        options_.rig.residual = std::min(options_.rig.residual, 1e-7);
    }

    Calibration::Trial run(const mechanics::BeamMaterial& beam, int first_axis)
    {
        Rig rig(dense_, beam, target_, options_.rig);
        Calibration::Trial trial;
        trial.r_tilde = beam.r_tilde;
        for (int axis = first_axis; axis < 3; ++axis) {
            Loading loading;
            loading.axis = axis;
            loading.drive[static_cast<std::size_t>(axis)] = {false, 1.0};
            auto& start = start_[static_cast<std::size_t>(axis)];
            if (!start) {
                Vec3 strain{-target_.nu_D * options_.strain, -target_.nu_D * options_.strain,
                            -target_.nu_D * options_.strain};
                strain[axis] = options_.strain;
                start = mechanics::affine_state(rig.lattice(), strain);
            }
            auto rest = rig.solve(loading, options_.strain, std::move(*start));
            const Point p = rig.measure(loading, options_.strain, rest.state, rest.forces);
            trial.E[axis] = p.stress[axis] / p.strain[axis];
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            trial.nu[axis] = -0.5 * (p.interior_strain[a] + p.interior_strain[b]) / p.interior_strain[axis];
            start = std::move(rest.state);
        }
        return trial;
    }

private:
    const domain::Domain& dense_;
    mechanics::DenseMaterial target_;
    CalibrationOptions options_;
    std::array<std::optional<mechanics::State>, 3> start_;
};

void conclude(Calibration& c, double scale)
{
    const auto& last = c.path.back();
    c.E = scale * mean(last.E);
    c.nu = mean(last.nu);
    c.anisotropy = (std::max({last.E.x, last.E.y, last.E.z}) - std::min({last.E.x, last.E.y, last.E.z})) / mean(last.E);
    c.error = std::max(std::abs(c.E / c.target.E_D - 1.0), std::abs(c.nu / c.target.nu_D - 1.0));
}

}  // namespace

Calibration calibrate(const domain::Domain& dense, const mechanics::DenseMaterial& target,
                      const CalibrationOptions& options)
{
    Calibration c;
    c.target = target;
    c.done = true;
    mechanics::BeamMaterial beam{mechanics::BeamMaterial{}.E_B, options.nu_B, options.first_guess};
    Tensions tensions(dense, target, options);
    Progress progress("calibration", 7);

    // nu falls as r~ rises: low < sought < high, known from trials along all axes. In between, far from the target, one
    // axis shows the way: its slope, and how far it was from the mean.
    double low = least_ratio, high = most_ratio, slope = usual_slope, offset = 0.0;
    bool all_axes = true;
    for (int trial = 0; trial < 40; ++trial) {
        c.path.push_back(tensions.run(beam, all_axes ? 0 : 2));
        progress.advance(all_axes ? 3 : 1);
        const auto& now = c.path.back();
        if (all_axes) offset = mean(now.nu) - now.nu.z;
        const double excess = now.nu.z + offset - target.nu_D;
        if (all_axes && std::abs(excess) <= 0.9 * options.tolerance * target.nu_D) {
            beam.E_B *= target.E_D / mean(now.E);
            c.beam = beam;
            conclude(c, target.E_D / mean(now.E));
            return c;
        }
        const double r = beam.r_tilde;
        if ((excess > 0.0 && r == most_ratio) || (excess < 0.0 && r == least_ratio))
            throw ComputationFailed(
                fmt::format("calibration: no beam radius ratio in [{}, {}] gives nu_D = {} (r~ = {:.4g} gives {:.4g}); "
                            "a packing of other "
                            "cardinality, or another nu_D, might",
                            least_ratio, most_ratio, target.nu_D, r, now.nu.z + offset));
        if (all_axes) (excess > 0.0 ? low : high) = r;
        if (trial > 0)
            if (const auto& last = c.path[c.path.size() - 2]; std::abs(r - last.r_tilde) > 1e-5) {
                const double measured = (now.nu.z - last.nu.z) / (r - last.r_tilde);
                if (measured < 0.1 * usual_slope) slope = measured;
            }
        double next = std::clamp(r - excess / slope, least_ratio, most_ratio);
        const bool known = (next == low && low > least_ratio) || (next == high && high < most_ratio);
        if (next < low || next > high || known) next = 0.5 * (low + high);
        all_axes = std::abs(excess) <= 0.005 * target.nu_D || next == least_ratio || next == most_ratio || trial > 6;
        beam.r_tilde = next;
    }
    throw ComputationFailed(
        "calibration: 40 trials did not settle on a beam radius ratio; loosen loading.beam.tolerance");
}

Calibration measure_given(const domain::Domain& dense, const mechanics::DenseMaterial& target,
                          const mechanics::BeamMaterial& beam, const CalibrationOptions& options)
{
    Calibration c;
    c.target = target;
    c.beam = beam;
    c.path.push_back(Tensions(dense, target, options).run(beam, 0));
    conclude(c, 1.0);
    return c;
}

}  // namespace craze::loading
