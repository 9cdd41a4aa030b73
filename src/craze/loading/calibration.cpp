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
// Near Table 2, packings of the paper's cardinality: r~ that gives nu = 0.29, and d nu / d r~.
constexpr double usual_ratio = 0.3665, usual_slope = -0.37;
constexpr double loose = 1e-4, tight = 1e-6;  // residuals: nu to some 1e-4 and to 1e-6

double mean(const Vec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// Tension along some axes of the dense packing; each axis starts from where its last trial ended.
class Tensions {
public:
    Tensions(const domain::Domain& dense, const mechanics::DenseMaterial& target, const CalibrationOptions& options)
        : dense_(dense), target_(target), options_(options)
    {
    }

    Calibration::Trial run(const mechanics::BeamMaterial& beam, double residual)
    {
        RigOptions options = options_.rig;
        options.residual = residual;
        Rig rig(dense_, beam, target_, options);
        Calibration::Trial trial;
        trial.r_tilde = beam.r_tilde;
        for (int axis = 0; axis < 3; ++axis) {
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
    const double guess = options.first_guess.value_or(usual_ratio + (target.nu_D - 0.29) / usual_slope);
    mechanics::BeamMaterial beam{mechanics::BeamMaterial{}.E_B, options.nu_B,
                                 std::clamp(guess, 2.0 * least_ratio, 0.9 * most_ratio)};
    Tensions tensions(dense, target, options);
    const double last_residual = std::min(options.rig.residual, tight);
    Progress progress("calibration", 6);

    // nu falls as r~ rises: low < sought < high. Trials are loose until the next one is likely to be the last.
    double low = least_ratio, high = most_ratio, slope = usual_slope;
    bool last = false;
    for (int trial = 0; trial < 40; ++trial) {
        c.path.push_back(tensions.run(beam, last ? last_residual : loose));
        progress.advance(3);
        const auto& now = c.path.back();
        const double excess = mean(now.nu) - target.nu_D, r = beam.r_tilde;
        if (last && std::abs(excess) <= 0.9 * options.tolerance * target.nu_D) {
            beam.E_B *= target.E_D / mean(now.E);
            c.beam = beam;
            conclude(c, target.E_D / mean(now.E));
            return c;
        }
        if ((excess > 0.0 && r == most_ratio) || (excess < 0.0 && r == least_ratio))
            throw ComputationFailed(
                fmt::format("calibration: no beam radius ratio in [{}, {}] gives nu_D = {} (r~ = {:.4g} gives {:.4g}); "
                            "a packing of other "
                            "cardinality, or another nu_D, might",
                            least_ratio, most_ratio, target.nu_D, r, mean(now.nu)));
        bool measured = false;
        if (trial > 0)
            if (const auto& before = c.path[c.path.size() - 2]; std::abs(r - before.r_tilde) > 1e-3) {
                const double secant = (mean(now.nu) - mean(before.nu)) / (r - before.r_tilde);
                if (secant < 0.1 * usual_slope) slope = secant, measured = true;
            }
        // A loose trial this near to the target does not tell on which side of it it is.
        if (last || std::abs(excess) > 3.0 * loose) (excess > 0.0 ? low : high) = r;
        double next = std::clamp(r - excess / slope, least_ratio, most_ratio);
        const bool known = (next == low && low > least_ratio) || (next == high && high < most_ratio);
        if (next < low || next > high || known) next = 0.5 * (low + high);
        last = last || std::abs(excess) <= (measured ? 0.05 : 0.02) * target.nu_D || trial > 6;
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
    c.path.push_back(Tensions(dense, target, options).run(beam, std::min(options.rig.residual, tight)));
    conclude(c, 1.0);
    return c;
}

}  // namespace craze::loading
