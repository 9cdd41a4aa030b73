#include "craze/mechanics/motion_step.hpp"

#include "craze/mechanics/lanes.hpp"
#include "craze/mechanics/laws.hpp"

#include <algorithm>

namespace craze::mechanics {

namespace {

/// q turned by the small rotation vector 2 h, as a Cayley map; kept at unit length without a root.
template <class Real>
CRAZE_INLINE Turn<Real> turned_by(const Turn<Real>& q, const Triple<Real>& h)
{
    Turn<Real> next{q.v + q.w * h + cross(h, q.v), q.w - dot(h, q.v)};
    // |next|^2 = |q|^2 (1 + h^2), near one: two Newton steps of the inverse root.
    const Real square = dot(next.v, next.v) + next.w * next.w;
    Real inverse = 1.5 - 0.5 * square;
    inverse = inverse * (1.5 - 0.5 * square * inverse * inverse);
    return {inverse * next.v, inverse * next.w};
}

struct Kick {
    Lanes from_velocity, from_force;
};

CRAZE_INLINE Six kicked(const Six& v, const Six& f, const Kick& move, const Kick& turn, const Triple<Lanes>& affine)
{
    return {move.from_velocity * v.a + move.from_force * f.a + affine.x,
            move.from_velocity * v.b + move.from_force * f.b + affine.y,
            move.from_velocity * v.c + move.from_force * f.c + affine.z,
            turn.from_velocity * v.d + turn.from_force * f.d,
            turn.from_velocity * v.e + turn.from_force * f.e,
            turn.from_velocity * v.f + turn.from_force * f.f};
}

CRAZE_INLINE Lanes size_of(Lanes a) { return a < 0.0 ? -a : a; }
/// -beta |f| against the direction of v, and the power that this takes at velocity `mid`.
CRAZE_INLINE Lanes against(const Lanes& f, const Lanes& v, double beta)
{
    const Lanes drag = beta * size_of(f);
    return v > 0.0 ? -drag : (v < 0.0 ? drag : Lanes{});
}

CRAZE_INLINE void store_rows(double* p, const Six& s)
{
    const Rows r = rows_of(s);
    for (int k = 0; k < lanes; ++k) store(p + 6 * k, r.head[k]), store(p + 6 * k + 4, r.tail[k]);
}

}  // namespace

CRAZE_MULTIVERSION StepSums step_rows(const StepConstants& c, const Rows6& rows, std::int64_t begin, std::int64_t end,
                                      const double* force, double* velocity, const double* pose, double* pose_next)
{
    const double after = 1.0 / (1.0 + 0.5 * c.damping * c.dt), keep = (1.0 - 0.5 * c.damping * c.dt) * after;
    const double affine = c.damping * c.dt * after;
    Lanes damping{}, largest{}, all{};
    for (std::int64_t e = begin; e < end; e += lanes) {
        double* v_row = velocity + 6 * e;
        const double *f_row = force + 8 * e, *p_row = pose + 8 * e;
        const Six v = gather_six(v_row, v_row + 6, v_row + 12, v_row + 18);
        Six f = gather_six(f_row, f_row + 8, f_row + 16, f_row + 24);
        const Triple<Lanes> v_affine{c.rate.x * load(rows.x.data() + e), c.rate.y * load(rows.y.data() + e),
                                     c.rate.z * load(rows.z.data() + e)};
        const Kick move{spread(keep), (c.dt * after) * load(rows.inv_mass.data() + e)};
        const Kick turn{spread(keep), (c.dt * after) * load(rows.inv_moment.data() + e)};
        Six drag{};
        if (c.local_damping > 0.0) {
            drag = {against(f.a, v.a - v_affine.x, c.local_damping),
                    against(f.b, v.b - v_affine.y, c.local_damping),
                    against(f.c, v.c - v_affine.z, c.local_damping),
                    against(f.d, v.d, c.local_damping),
                    against(f.e, v.e, c.local_damping),
                    against(f.f, v.f, c.local_damping)};
            f.a += drag.a, f.b += drag.b, f.c += drag.c, f.d += drag.d, f.e += drag.e, f.f += drag.f;
        }
        const Six next = kicked(v, f, move, turn, spread(affine) * v_affine);
        store_rows(v_row, next);

        const Triple<Lanes> moved{next.a, next.b, next.c}, off = moved - v_affine;
        const Lanes speed = dot(off, off);
        largest = speed > largest ? speed : largest;
        all += speed;
        if (c.local_damping > 0.0)
            damping -= (0.5 * c.dt) * (drag.a * (next.a + v.a) + drag.b * (next.b + v.b) + drag.c * (next.c + v.c) +
                                       drag.d * (next.d + v.d) + drag.e * (next.e + v.e) + drag.f * (next.f + v.f));
        if (c.damping > 0.0) {
            const Triple<Lanes> mid = spread(0.5) * (moved + Triple<Lanes>{v.a, v.b, v.c});
            const Triple<Lanes> spin = spread(0.5) * (Triple<Lanes>{next.d + v.d, next.e + v.e, next.f + v.f});
            damping += (c.damping * c.dt) * (load(rows.mass.data() + e) * dot(mid - v_affine, mid) +
                                             load(rows.moment.data() + e) * dot(spin, spin));
        }

        Seven p = gather_seven(p_row, p_row + 8, p_row + 16, p_row + 24);
        p.a += c.dt * next.a, p.b += c.dt * next.b, p.c += c.dt * next.c;
        if (c.geometry == Geometry::corotational) {
            const double half = 0.5 * c.dt;
            const auto q = turned_by<Lanes>({{p.e, p.f, p.g}, p.h}, {half * next.d, half * next.e, half * next.f});
            p.e = q.v.x, p.f = q.v.y, p.g = q.v.z, p.h = q.w;
        } else {
            p.e += c.dt * next.d, p.f += c.dt * next.e, p.g += c.dt * next.f;
        }
        store_seven(pose_next + 8 * e, p);
    }
    StepSums sums;
    for (int k = 0; k < lanes; ++k) {
        sums.damping += damping[k], sums.all_speeds += all[k];
        sums.speed_2 = std::max(sums.speed_2, largest[k]);
    }
    return sums;
}

void move_row(const StepConstants& c, const double* velocity, const double* pose, double* pose_next)
{
    for (int a = 0; a < 3; ++a) pose_next[a] = pose[a] + c.dt * velocity[a];
    if (c.geometry == Geometry::small_displacement) {
        for (int a = 3; a < 6; ++a) pose_next[a + 1] = pose[a + 1] + c.dt * velocity[a];
        return;
    }
    const double half = 0.5 * c.dt;
    const auto q = turned_by<double>({{pose[4], pose[5], pose[6]}, pose[7]},
                                     {half * velocity[3], half * velocity[4], half * velocity[5]});
    pose_next[4] = q.v.x, pose_next[5] = q.v.y, pose_next[6] = q.v.z, pose_next[7] = q.w;
}

}  // namespace craze::mechanics
