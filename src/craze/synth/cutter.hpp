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
    double rim;      ///< from the rim of the crack, in its plane, about, m
};

/// Holds a reference to the coating.
class Cutter {
public:
    /// @param reach   every point of a segment asked for lies within this of its middle, m
    /// @param margin  cracks nearer than this to a pore are taken for part of it, m
    Cutter(const Coating& coating, double reach, double margin = 0.0);

    bool in_pore(const Vec3& point) const;
    /// In a pore or within the margin of one.
    bool by_pore(const Vec3& point) const;
    /// Appends the crossings of [from, to] with cracks away from pores; `middle` says in which cell to look.
    void cross(const Vec3& middle, const Vec3& from, const Vec3& to, std::vector<Crossing>& found) const;

private:
    using Members = std::vector<std::vector<std::int32_t>>;
    template <class Meets>
    void add(Members& members, std::int32_t defect, const Vec3& centre, double reach, Meets&& meets) const;
    std::size_t cell_of(const Vec3& point) const;

    const Coating& coating_;
    double edge_, margin_;
    std::array<int, 3> count_{};
    Members cracks_, pores_;
};

}  // namespace craze::synth
