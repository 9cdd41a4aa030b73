// From displacements between pairs of slices to a position for each.

#include "craze/core/errors.hpp"
#include "craze/images/alignment.hpp"
#include "craze/io/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace craze::images {

namespace {

// Solves the normal equations of sum w (t_b - t_a - d)^2 with t_0 = 0: banded, symmetric, positive definite.
std::vector<double> solve(std::int64_t n, std::span<const PairShift> pairs, std::span<const double> weights,
                          double Shift::*component, std::int64_t band)
{
    std::vector<double> matrix(static_cast<std::size_t>(n * (band + 1))), t(static_cast<std::size_t>(n));
    const auto at = [&](std::int64_t i, std::int64_t j) -> double& {  // j <= i
        return matrix[static_cast<std::size_t>(i * (band + 1) + (i - j))];
    };
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const auto& [a, b, by, likeness] = pairs[p];
        const double w = weights[p], d = by.*component;
        at(a, a) += w, at(b, b) += w, at(b, a) -= w;
        t[static_cast<std::size_t>(a)] -= w * d, t[static_cast<std::size_t>(b)] += w * d;
    }
    at(0, 0) += 1.0;
    for (std::int64_t i = 0; i < n; ++i) at(i, i) += 1e-12;
    for (std::int64_t i = 0; i < n; ++i)  // L L^T
        for (std::int64_t j = std::max<std::int64_t>(0, i - band); j <= i; ++j) {
            double sum = at(i, j);
            for (std::int64_t k = std::max<std::int64_t>(0, i - band); k < j; ++k) sum -= at(i, k) * at(j, k);
            at(i, j) = i == j ? std::sqrt(sum) : sum / at(j, j);
        }
    for (std::int64_t i = 0; i < n; ++i) {
        double& v = t[static_cast<std::size_t>(i)];
        for (std::int64_t k = std::max<std::int64_t>(0, i - band); k < i; ++k)
            v -= at(i, k) * t[static_cast<std::size_t>(k)];
        v /= at(i, i);
    }
    for (std::int64_t i = n - 1; i >= 0; --i) {
        double& v = t[static_cast<std::size_t>(i)];
        for (std::int64_t k = i + 1; k <= std::min(n - 1, i + band); ++k)
            v -= at(k, i) * t[static_cast<std::size_t>(k)];
        v /= at(i, i);
    }
    return t;
}

double slope(const std::vector<Shift>& at, double Shift::*component)
{
    const auto n = static_cast<double>(at.size());
    if (at.size() < 2) return 0.0;
    double sum_t = 0.0, sum_it = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i)
        sum_t += at[i].*component, sum_it += static_cast<double>(i) * at[i].*component;
    return 12.0 * (sum_it - (n - 1.0) / 2.0 * sum_t) / (n * (n * n - 1.0));
}

// How likely steps of a walk with variance q (in units of the jitter's) under white jitter would have given x: the
// logarithm of the likelihood, by Kalman's filter, at the jitter that suits x best.
double log_likelihood(const std::vector<double>& x, double q)
{
    double at = x[0], variance = 1.0, squares = 0.0, logs = 0.0;
    for (std::size_t i = 1; i < x.size(); ++i) {
        const double expected = variance + q, F = expected + 1.0, v = x[i] - at;
        squares += v * v / F, logs += std::log(F);
        at += expected / F * v, variance = expected / F;
    }
    const auto n = static_cast<double>(x.size() - 1);
    return -0.5 * (n * std::log(std::max(squares / n, 1e-12)) + logs);
}

// What of one coordinate of the positions is not the specimen's own: jumps, and jitter about a walk.
//
// Cracks that lean move from slice to slice just as a drifting stage would, but successive slices move alike; slices
// that are misplaced each for itself make steps that turn back. The share of each is the likeliest one, and the walk
// then the least of sum (x - p)^2 + rho sum (x' - x)^2 with rho the variance of the jitter over that of the walk's
// steps.
std::vector<double> misplacement(const std::vector<double>& p, double slope)
{
    const std::size_t n = p.size();
    std::vector<double> level(n), out(n, 0.0), size(n - 1);
    for (std::size_t i = 0; i < n; ++i) level[i] = p[i] - slope * static_cast<double>(i);
    for (std::size_t i = 0; i + 1 < n; ++i) size[i] = std::abs(level[i + 1] - level[i]);
    auto sorted = size;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(n / 2 - 1), sorted.end());
    const double jump = std::max(5.0, 9.0 * sorted[n / 2 - 1]);
    for (std::size_t i = 1; i < n; ++i) out[i] = out[i - 1] + (size[i - 1] > jump ? level[i] - level[i - 1] : 0.0);
    for (std::size_t i = 0; i < n; ++i) level[i] -= out[i];

    double q = 1e3, best = log_likelihood(level, q);
    for (int k = 11; k >= -24; --k) {
        const double candidate = std::pow(10.0, k / 4.0), likelihood = log_likelihood(level, candidate);
        if (likelihood > best) best = likelihood, q = candidate;
    }
    const double rho = 1.0 / q;
    std::vector<double> x = level, diagonal(n);
    for (std::size_t i = 0; i < n; ++i) diagonal[i] = 1.0 + rho * (i == 0 || i + 1 == n ? 1.0 : 2.0);
    for (std::size_t i = 1; i < n; ++i) {
        const double f = rho / diagonal[i - 1];
        diagonal[i] -= f * rho, x[i] += f * x[i - 1];
    }
    x[n - 1] /= diagonal[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) x[i] = (x[i] + rho * x[i + 1]) / diagonal[i];
    for (std::size_t i = 0; i < n; ++i) out[i] += level[i] - x[i];
    return out;
}

}  // namespace

Positions solve_positions(std::int64_t slices, std::span<const PairShift> pairs)
{
    Positions result;
    result.at.resize(static_cast<std::size_t>(slices));
    if (slices < 2 || pairs.empty()) return result;
    result.pairs = std::ssize(pairs);
    std::int64_t band = 1;
    for (const PairShift& pair : pairs) band = std::max(band, pair.b - pair.a);
    std::vector<double> weights(pairs.size(), 1.0), residual(pairs.size());
    std::vector<double> likeness;
    for (const PairShift& pair : pairs) likeness.push_back(pair.likeness);
    std::nth_element(likeness.begin(), likeness.begin() + static_cast<std::ptrdiff_t>(likeness.size() / 2),
                     likeness.end());
    const double alike = 0.8 * likeness[likeness.size() / 2];
    const auto known = [&](std::size_t p) { return pairs[p].likeness >= alike ? 1.0 : 0.0; };
    double scale = 0.0;
    const auto refit = [&] {
        const auto x = solve(slices, pairs, weights, &Shift::x, band),
                   y = solve(slices, pairs, weights, &Shift::y, band);
        for (std::size_t i = 0; i < result.at.size(); ++i) result.at[i] = {x[i] - x[0], y[i] - y[0]};
        for (std::size_t p = 0; p < pairs.size(); ++p) {
            const Shift &a = result.at[static_cast<std::size_t>(pairs[p].a)],
                        &b = result.at[static_cast<std::size_t>(pairs[p].b)];
            residual[p] = std::hypot(b.x - a.x - pairs[p].by.x, b.y - a.y - pairs[p].by.y);
        }
        auto sorted = residual;
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
        scale = std::max(0.05, 1.5 * sorted[sorted.size() / 2]);
    };
    // First the sum of distances, which outliers cannot drag far, then Tukey's weights, which let them go.
    for (int round = 0; round < 12; ++round) {
        refit();
        for (std::size_t p = 0; p < pairs.size(); ++p)
            weights[p] = std::max(1e-6, known(p) / std::max(residual[p], 0.2 * scale));
    }
    const auto tukey = [&](double r) {
        const double u = r / (4.7 * scale);
        return u < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
    };
    for (int round = 0; round < 6; ++round) {
        for (std::size_t p = 0; p < pairs.size(); ++p) weights[p] = std::max(1e-6, known(p) * tukey(residual[p]));
        refit();
    }
    std::vector<double> trust(result.at.size());
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const double w = known(p) * tukey(residual[p]);
        trust[static_cast<std::size_t>(pairs[p].a)] += w, trust[static_cast<std::size_t>(pairs[p].b)] += w;
        if (w == 0.0) ++result.bad_pairs;
    }
    for (std::int64_t i = 0; i < slices; ++i) {
        if (trust[static_cast<std::size_t>(i)] > 0.1) continue;
        std::int64_t low = i - 1, high = i + 1;
        while (high < slices && trust[static_cast<std::size_t>(high)] <= 0.1) ++high;
        const Shift a = result.at[static_cast<std::size_t>(low >= 0 ? low : std::min(high, slices - 1))];
        const Shift b = result.at[static_cast<std::size_t>(high < slices ? high : std::max<std::int64_t>(low, 0))];
        const double f = low >= 0 && high < slices ? 1.0 / static_cast<double>(high - low) : 0.0;
        result.at[static_cast<std::size_t>(i)] = {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y)};
    }
    result.drift = {slope(result.at, &Shift::x), slope(result.at, &Shift::y)};
    return result;
}

std::vector<Shift> corrections(const Positions& positions, const Alignment& settings)
{
    std::vector<Shift> shifts = positions.at;
    if (shifts.size() < 4 || !positions.known()) return std::vector<Shift>(shifts.size());
    if (!settings.remove_drift)
        for (double Shift::*component : {&Shift::x, &Shift::y}) {
            std::vector<double> along(shifts.size());
            for (std::size_t i = 0; i < shifts.size(); ++i) along[i] = shifts[i].*component;
            along = misplacement(along, positions.drift.*component);
            for (std::size_t i = 0; i < shifts.size(); ++i) shifts[i].*component = along[i];
        }
    Shift mean;
    for (const Shift& s : shifts)
        mean.x += s.x / static_cast<double>(shifts.size()), mean.y += s.y / static_cast<double>(shifts.size());
    for (Shift& s : shifts) {
        s = {s.x - mean.x, s.y - mean.y};
        if (std::hypot(s.x, s.y) < settings.least_shift) s = {};
    }
    return shifts;
}

CommonCrop common_crop(std::span<const Shift> shifts, std::int64_t nx, std::int64_t ny)
{
    Shift low, high;
    for (const Shift& s : shifts) {
        low = {std::min(low.x, s.x), std::min(low.y, s.y)};
        high = {std::max(high.x, s.x), std::max(high.y, s.y)};
    }
    const CommonCrop crop{
        static_cast<std::int64_t>(std::ceil(-low.x)), nx - static_cast<std::int64_t>(std::ceil(high.x)),
        static_cast<std::int64_t>(std::ceil(-low.y)), ny - static_cast<std::int64_t>(std::ceil(high.y))};
    if (crop.x1 - crop.x0 < 1 || crop.y1 - crop.y0 < 1)
        throw InvalidInput(
            fmt::format("images.alignment: corrections from {:.1f}, {:.1f} to {:.1f}, {:.1f} px leave nothing "
                        "that all slices of {} x {} share; lower max_shift or set remove_drift = false",
                        low.x, low.y, high.x, high.y, nx, ny));
    return crop;
}

void save_transforms(const std::filesystem::path& file, std::span<const Shift> shifts)
{
    std::string text = "slice,shift_x_px,shift_y_px\n";
    for (std::size_t i = 0; i < shifts.size(); ++i) text += fmt::format("{},{},{}\n", i, shifts[i].x, shifts[i].y);
    io::write_text(file, text);
}

std::vector<Shift> load_transforms(const std::filesystem::path& file, std::int64_t slices)
{
    std::istringstream in(io::read_text(file));
    std::string line;
    std::getline(in, line);
    std::vector<Shift> shifts;
    for (std::int64_t number = 2; std::getline(in, line); ++number) {
        std::istringstream fields(line);
        std::int64_t slice = -1;
        Shift shift;
        char comma = 0, comma2 = 0;
        if (!(fields >> slice >> comma >> shift.x >> comma2 >> shift.y) || comma != ',' || comma2 != ',' ||
            slice != static_cast<std::int64_t>(shifts.size()) || !std::isfinite(shift.x + shift.y))
            throw InvalidInput(fmt::format("{}:{}: needed \"{},shift_x,shift_y\", got \"{}\"", file.string(), number,
                                           shifts.size(), line));
        shifts.push_back(shift);
    }
    if (static_cast<std::int64_t>(shifts.size()) != slices)
        throw InvalidInput(fmt::format("{}: needed {} slices, got {}", file.string(), slices, shifts.size()));
    return shifts;
}

}  // namespace craze::images
