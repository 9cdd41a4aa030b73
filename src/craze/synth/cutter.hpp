// Which defects does a short segment meet? Found through cells, each with the few defects that reach into it.

#pragma once

#include "craze/synth/coating.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace craze::synth {

/// A segment meets a crack's mid-surface.
struct Crossing {
    Vec3 point;      ///< m
    double opening;  ///< of the crack there, m, > 0
    double cosine;   ///< between segment and normal, (0, 1]
};

/// Holds a reference to the coating.
class Cutter {
public:
    /// @param reach  every point of a segment asked for lies within this of its middle, m
    Cutter(const Coating& coating, double reach);

    bool in_pore(const Vec3& point) const;
    /// Appends the crossings of [from, to] with cracks outside pores; `middle` says in which cell to look.
    void cross(const Vec3& middle, const Vec3& from, const Vec3& to, std::vector<Crossing>& found) const;

private:
    using Members = std::vector<std::vector<std::int32_t>>;
    template <class Meets>
    void add(Members& members, std::int32_t defect, const Vec3& centre, double reach, Meets&& meets) const;
    std::size_t cell_of(const Vec3& point) const;

    const Coating& coating_;
    double edge_;
    std::array<int, 3> count_{};
    Members cracks_, pores_;
};

}  // namespace craze::synth
