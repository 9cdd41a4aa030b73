#include "craze/mechanics/inertia.hpp"

#include "craze/core/errors.hpp"
#include "craze/core/random.hpp"
#include "craze/mechanics/vectors.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>

namespace craze::mechanics {

namespace {

/// In proportion to an element's own stiffness in its stiffest direction: all elements alone would swing alike.
Inertia scaled_inertia(const Lattice& lattice, double total)
{
    const auto n = lattice.r.size();
    const Stiffness stiffness(lattice, std::vector<domain::BondKind>(lattice.i.size(), domain::BondKind::beam));
    std::vector<double> blocks(36 * n, 0.0);
    stiffness.diagonal(blocks);
    std::vector<double> stiffest(n);
    double sum = 0.0, bonded = 0.0;
    for (std::size_t e = 0; e < n; ++e) {
        Eigen::Matrix3d own;
        for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c)
                own(static_cast<int>(r), static_cast<int>(c)) = blocks[36 * e + 6 * r + c];
        stiffest[e] = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(own, Eigen::EigenvaluesOnly).eigenvalues()[2];
        sum += stiffest[e], bonded += stiffest[e] > 0.0;
    }
    const double mean = sum / bonded;  // elements without bonds weigh as much as the mean
    Inertia out;
    for (const double own : stiffest) {
        out.mass.push_back(total / static_cast<double>(n) * (own > 0.0 ? own / mean : 1.0));
        out.moment.push_back(0.4 * out.mass.back() * lattice.mean_radius * lattice.mean_radius);
    }
    return out;
}

}  // namespace

Inertia inertia(const Lattice& lattice, Mass mass)
{
    Inertia out;
    double total = 0.0;
    for (const double r : lattice.r) {
        out.mass.push_back(lattice.density * 4.0 / 3.0 * std::numbers::pi * r * r * r);
        out.moment.push_back(0.4 * out.mass.back() * r * r);
        total += out.mass.back();
    }
    if (mass == Mass::uniform) {
        const double mean = total / static_cast<double>(lattice.r.size());
        out.mass.assign(lattice.r.size(), mean);
        out.moment.assign(lattice.r.size(), 0.4 * mean * lattice.mean_radius * lattice.mean_radius);
    }
    return mass == Mass::scaled ? scaled_inertia(lattice, total) : out;
}

double largest_eigenvalue(const Stiffness& stiffness, const Inertia& inertia)
{
    constexpr int most = 300;
    const auto n = inertia.mass.size();
    std::vector<double> root(6 * n), v(6 * n), before(6 * n, 0.0), w(6 * n), scaled(6 * n);
    Random random(1);
    for (std::size_t k = 0; k < 6 * n; ++k) {
        root[k] = 1.0 / std::sqrt(k % 6 < 3 ? inertia.mass[k / 6] : inertia.moment[k / 6]);
        v[k] = random.uniform(-1.0, 1.0);
    }
    const double length = std::sqrt(dot(v, v));
    for (double& value : v) value /= length;

    std::vector<double> diagonal, beside;
    for (int step = 1; step <= most; ++step) {
        for (std::size_t k = 0; k < 6 * n; ++k) scaled[k] = root[k] * v[k];
        stiffness.apply(scaled, w);
        for (std::size_t k = 0; k < 6 * n; ++k) w[k] *= root[k];
        const double a = dot(v, w);
        const double b = beside.empty() ? 0.0 : beside.back();
        for (std::size_t k = 0; k < 6 * n; ++k) w[k] -= a * v[k] + b * before[k];
        const double next = std::sqrt(dot(w, w));
        diagonal.push_back(a);
        const auto size = static_cast<Eigen::Index>(diagonal.size());
        if (step % 5 == 0 || next < 1e-12 * a || step >= static_cast<int>(6 * n)) {
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
            ritz.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), size),
                                        Eigen::Map<Eigen::VectorXd>(beside.data(), size - 1));
            const double value = ritz.eigenvalues()[size - 1],
                         error = next * std::abs(ritz.eigenvectors()(size - 1, size - 1));
            if (error <= 1e-3 * value || step >= static_cast<int>(6 * n)) return value + error;
        }
        beside.push_back(next);
        before = v;
        for (std::size_t k = 0; k < 6 * n; ++k) v[k] = w[k] / next;
    }
    throw ComputationFailed(
        fmt::format("the largest frequency of the lattice was not found in {} Lanczos iterations: are "
                    "bond lengths and radii of one order of magnitude?",
                    most));
}

double critical_step(const Lattice& lattice, Mass mass)
{
    const Stiffness stiffness(lattice, std::vector<domain::BondKind>(lattice.i.size(), domain::BondKind::beam));
    return 2.0 / std::sqrt(largest_eigenvalue(stiffness, inertia(lattice, mass)));
}

}  // namespace craze::mechanics
