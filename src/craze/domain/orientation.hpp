// On which side? Answers without rounding error, so that no bond slips through a seam between two triangles.

#pragma once

#include "craze/core/vec3.hpp"

namespace craze::domain {

/// Sign of det(b - a, c - a, d - a): 1, 0 or -1, exactly. 1 when a, b, c turn counter-clockwise seen from d.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign of the turn a -> b -> c in the plane of axes u and v: 1 counter-clockwise, 0 in line, -1 clockwise, exactly.
int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v);

/// Does the closed segment p-q share a point with the closed triangle a-b-c? Exact for any finite coordinates whose
/// products do not under- or overflow. Touching counts: an end of the segment on the triangle, an edge or a vertex met,
/// a segment in the triangle's plane that meets it. A triangle without area has no inside and meets nothing.
bool meets(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace craze::domain
