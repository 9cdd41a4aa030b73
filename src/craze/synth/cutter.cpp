#include "craze/synth/cutter.hpp"

#include <algorithm>
#include <cmath>

namespace craze::synth {

namespace {

/// The sheet between two points of a segment on either side of it: regula falsi, halved at times so it never stalls.
Crossing foot(const Crack& crack, const Vec3& from, const Vec3& along, double s0, double d0, double s1, double d1)
{
    const double length = norm(along);
    Vec3 point{};
    CrackView seen{};
    for (int i = 0; i < 60; ++i) {
        const double s = i % 3 == 2 ? 0.5 * (s0 + s1) : s0 + (s1 - s0) * d0 / (d0 - d1);
        point = from + s * along;
        seen = view(crack, point);
        if (std::abs(seen.distance) < 1e-9 * length) break;
        const bool near_start = (seen.distance < 0.0) == (d0 < 0.0);
        (near_start ? s0 : s1) = s;
        (near_start ? d0 : d1) = seen.distance;
    }
    return {point, seen.opening, std::abs(dot(seen.normal, along)) / length,
            (1.0 - std::sqrt(std::min(1.0, seen.rho2))) * std::min(crack.a, crack.b)};
}

}  // namespace

template <class Meets>
void Cutter::add(Members& members, std::int32_t defect, const Vec3& centre, double reach, Meets&& meets) const
{
    std::array<int, 3> first{}, last{};
    for (std::size_t a = 0; a < 3; ++a) {
        const auto cell = [&](double s) {
            return std::clamp(static_cast<int>(std::floor(s / edge_)), 0, count_[a] - 1);
        };
        first[a] = cell(centre[static_cast<int>(a)] - reach);
        last[a] = cell(centre[static_cast<int>(a)] + reach);
    }
    for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
            for (int i = first[0]; i <= last[0]; ++i) {
                const Vec3 middle = edge_ * Vec3{i + 0.5, j + 0.5, k + 0.5};
                if (meets(middle)) members[cell_of(middle)].push_back(defect);
            }
}

Cutter::Cutter(const Coating& coating, double reach, double margin)
    : coating_(coating), edge_(2.0 * reach), margin_(margin)
{
    std::size_t cells = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        count_[a] = std::max(1, static_cast<int>(std::ceil(coating.size[static_cast<int>(a)] / edge_)));
        cells *= static_cast<std::size_t>(count_[a]);
    }
    cracks_.resize(cells);
    pores_.resize(cells);
    const double around = 0.5 * std::sqrt(3.0) * edge_ + reach;  // from a cell's middle to the end of a segment
    for (std::size_t c = 0; c < coating.cracks.size(); ++c) {
        const Crack& crack = coating.cracks[c];
        const double high = relief(crack);
        add(cracks_, static_cast<std::int32_t>(c), crack.centre, craze::synth::reach(crack) + high + around,
            [&](const Vec3& p) { return std::abs(dot(p - crack.centre, crack.frame.n)) <= high + around; });
    }
    for (std::size_t p = 0; p < coating.pores.size(); ++p) {
        const auto ball = bounding_ball(coating.pores[p]);
        const Vec3 centre{ball[0], ball[1], ball[2]};
        const double near = ball[3] + around + margin;
        add(pores_, static_cast<std::int32_t>(p), centre, near,
            [&](const Vec3& middle) { return norm(middle - centre) <= near; });
    }
}

std::size_t Cutter::cell_of(const Vec3& p) const
{
    const auto cell = [&](double s, int n) { return std::clamp(static_cast<int>(s / edge_), 0, n - 1); };
    return static_cast<std::size_t>(cell(p.x, count_[0]) +
                                    count_[0] * (cell(p.y, count_[1]) + count_[1] * cell(p.z, count_[2])));
}

bool Cutter::in_pore(const Vec3& point) const
{
    const auto& near = pores_[cell_of(point)];
    return std::any_of(near.begin(), near.end(), [&](std::int32_t pore) {
        return contains(coating_.pores[static_cast<std::size_t>(pore)], point);
    });
}

bool Cutter::by_pore(const Vec3& point) const
{
    const auto& near = pores_[cell_of(point)];
    return std::any_of(near.begin(), near.end(), [&](std::int32_t p) {
        const Pore& pore = coating_.pores[static_cast<std::size_t>(p)];
        return contains(pore, point) || (margin_ > 0.0 && facing(pore, point).distance < margin_);
    });
}

void Cutter::cross(const Vec3& middle, const Vec3& from, const Vec3& to, std::vector<Crossing>& found) const
{
    constexpr int parts = 4;  // waves of a sheet are longer than half a bond
    const Vec3 along = to - from;
    for (const std::int32_t c : cracks_[cell_of(middle)]) {
        const Crack& crack = coating_.cracks[static_cast<std::size_t>(c)];
        const double high = relief(crack), w0 = dot(from - crack.centre, crack.frame.n),
                     w1 = dot(to - crack.centre, crack.frame.n);
        if (std::min(w0, w1) > high || std::max(w0, w1) < -high) continue;
        double s0 = 0.0, d0 = view(crack, from).distance;
        for (int p = 1; p <= parts; ++p) {
            const double s1 = static_cast<double>(p) / parts, d1 = view(crack, from + s1 * along).distance;
            if ((d0 < 0.0) != (d1 < 0.0)) {
                const Crossing crossing = foot(crack, from, along, s0, d0, s1, d1);
                if (crossing.opening > 0.0 && crossing.cosine > 0.0 && !by_pore(crossing.point))
                    found.push_back(crossing);
            }
            s0 = s1;
            d0 = d1;
        }
    }
}

}  // namespace craze::synth
