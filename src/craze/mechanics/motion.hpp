// How a lattice moves: explicit velocity Verlet with rotations, contact and cracking.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/mechanics/constraints.hpp"
#include "craze/mechanics/lattice.hpp"
#include "craze/mechanics/state.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace craze::mechanics {

enum class Geometry {
    small_displacement,  ///< the frames of rest; agrees with Equilibrium. Not for fragments that turn
    corotational,        ///< rotations of any size; unbonded elements are found as they meet
};
enum class Mass {
    real,     ///< of a sphere of the elements' density, m = rho 4/3 pi r^3, I = 2/5 m r^2
    uniform,  ///< the mean of the real masses for all, I = 2/5 m R_DE^2: a longer step, the same waves
    scaled,  ///< in proportion to the element's own stiffness, the total mass kept: the longest step, quasi-static only
};

struct MotionOptions {
    Geometry geometry = Geometry::corotational;
    Mass mass = Mass::uniform;
    double step_fraction = 0.85;  ///< of the critical step 2 / omega_max, above 0; stable below 1
    double damping = 0.0;         ///< alpha, 1/s: force -alpha m (v - v_affine) on each free degree of freedom
    /// beta, [0, 1): force -beta |F| sign(v - v_affine) on each free degree of freedom, F what is out of balance there
    /// (Cundall). Damps every mode alike, holds back no steady motion.
    double local_damping = 0.0;
    double strength = std::numeric_limits<double>::infinity();  ///< sigma_failure, Pa: beams break at or above [Eq. 24]
    /// Share of the bending stress in sigma_N, [0, 1]. 1: Eq. 24 as printed. Less: the moment-contribution factor of
    /// bonded-particle models (Potyondy, 45th US Rock Mech. Symp., ARMA 11-501, 2011), which raises UCS/UTS.
    double bending_share = 1.0;
    bool free_contacts = true;  ///< let unbonded elements touch [Eq. 5]
};

/// J, since the start. work = elastic + kinetic + damping + fracture - what there was at the start.
struct Energies {
    double elastic = 0.0;   ///< in beams and closed contacts
    double kinetic = 0.0;   ///< of translation and rotation: m v- v+ / 2, velocities half a step ago and ahead
    double damping = 0.0;   ///< taken by damping
    double fracture = 0.0;  ///< released by beams that broke
    double work = 0.0;      ///< done by what is imposed
};

struct BrokenBond {
    std::int32_t bond = 0;
    std::int64_t step = 0;  ///< after which it broke
};

/// Unbonded elements that were pressed together by the matter about them when it parted: they touch below the distance
/// they had then.
struct PressedPair {
    std::int32_t i = 0, j = 0;
    double limit = 0.0;  ///< contact distance, m
};

/// All that is needed to go on to the same bits.
struct MotionState {
    std::int64_t step = 0;
    double time = 0.0;             ///< s
    std::vector<double> pose;      ///< shape (n, 8): displacement x, y, z (m), 0, quaternion x, y, z, w; in small
                                   ///< displacements a rotation vector x, y, z (rad), 0 takes the quaternion's place
    std::vector<double> velocity;  ///< half a step ago, shape (n, 6), m/s and rad/s
    std::vector<domain::BondKind> kind;                              ///< shape (m,)
    std::vector<BrokenBond> broken;                                  ///< in the order they broke (by step, then bond)
    std::vector<PressedPair> pressed;                                ///< sorted by (i, j)
    double damping_energy = 0.0, fracture_energy = 0.0, work = 0.0;  ///< J
};

/// One lattice in motion. Same bits on any number of threads.
class Motion {
public:
    /// From a state without velocity.
    /// @throws InvalidInput  when an option makes no sense or the state does not belong to the lattice
    Motion(const Lattice& lattice, const MotionOptions& options, const State& start);
    /// Goes on from where another motion stopped; options and lattice must be the same.
    Motion(const Lattice& lattice, const MotionOptions& options, MotionState stopped);
    ~Motion();
    Motion(Motion&&) noexcept;
    Motion& operator=(Motion&&) noexcept;

    /// Imposes velocities (m/s, rad/s) on degrees of freedom from now on; those not named are free.
    void drive(const Constraints& velocities);
    /// Reference of the damping: v_affine,k = rate_k (x_k - centre of the box), 1/s.
    void set_affine_rate(const Vec3& rate);
    void set_damping(double alpha);
    /// Velocities now, shape (n, 6), m/s and rad/s.
    void set_velocity(std::span<const double> velocity);
    void set_strength(double sigma_failure);

    /// @throws ComputationFailed  when something moves faster than a bond length per step
    void advance(std::int64_t steps);

    double step_length() const;  ///< dt, s
    double time() const;         ///< s
    std::int64_t steps() const;
    /// Of the lattice on each element now, shape (n, 6), N and N m.
    std::span<const double> force() const;
    Energies energies() const;
    /// Displacements, rotations and kinds now.
    State state() const;
    /// Velocities now, shape (n, 6), m/s and rad/s.
    std::vector<double> velocity() const;
    const std::vector<BrokenBond>& broken() const;
    MotionState stopped() const;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

/// 2 / omega_max of the lattice with all its bonds intact, s, by Lanczos iterations.
double critical_step(const Lattice& lattice, Mass mass);

}  // namespace craze::mechanics
