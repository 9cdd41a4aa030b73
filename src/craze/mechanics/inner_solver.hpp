// The linear systems of equilibrium: preconditioned conjugate gradients in single precision, or in double.

#pragma once

#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/multilevel.hpp"
#include "craze/mechanics/single_stiffness.hpp"
#include "craze/mechanics/stiffness.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace craze::mechanics {

/// Solves K d = r a few digits at a time: whoever calls keeps what is out of balance in double precision, hands it in
/// again, and the search goes on where it was, as if it had never lost a digit.
class InnerSolver {
public:
    explicit InnerSolver(const Lattice& lattice);
    void set_beams(const Stiffness& stiffness);
    void set_springs(const Springs& springs);
    /// @param imposed  degrees of freedom that do not move, ascending
    void set_up_preconditioner(const Stiffness& stiffness, std::span<const std::int64_t> imposed);

    /// After springs have changed.
    void update_preconditioner(const Stiffness& stiffness) { preconditioner_.update(lattice_, stiffness); }

    struct Result {
        std::int64_t iterations = 0;
        double norm = 0.0;  ///< of what the search believes to be left of r, N (moments over R)
    };
    /// Adds to d (zero before) until the norm of what is left of r is below target, N.
    /// @param r      shape (n, 6), N and N m, zero where imposed
    /// @param go_on  r is what was left after the last call: keep searching in the direction found then
    Result solve(std::span<const double> r, double target, std::int64_t most, bool go_on, std::span<double> d);

    /// The same, every number but the preconditioner's in double precision: slower, for systems so soft in places that
    /// single precision stalls.
    Result solve_in_double(const Stiffness& stiffness, std::span<const double> r, double target, std::int64_t most,
                           std::span<double> d);

private:
    double unit_of(std::span<const double> r) const;
    void take(std::int64_t block, std::span<const double> r, double unit);
    void give(std::int64_t block, std::span<const float> rows, double unit, std::span<double> d) const;
    void precondition(std::span<const double> r, std::span<double> z);
    void prepare(double rz, float step);

    const Lattice& lattice_;
    double EA_;
    SingleStiffness stiffness_;
    Multilevel preconditioner_;
    std::vector<std::int64_t> imposed_;
    std::vector<std::int64_t> imposed_first_;  ///< per block
    std::vector<float> d_, r_, z_, p_, q_;     ///< rows of eight; q is empty between iterations
    std::vector<double> part_, norm_;          ///< sums of each block
    double rz_ = 0.0, unit_ = 1.0;             ///< r . z of the last direction; force that 1 stands for, N
};

}  // namespace craze::mechanics
