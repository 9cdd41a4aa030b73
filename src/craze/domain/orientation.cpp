#include "craze/domain/orientation.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace craze::domain {

namespace {

/// An exact sum of doubles that do not overlap in their bits, from small to large: its last term has its sign
/// (Dekker 1971, Knuth, Priest 1991, Shewchuk 1997).
template <std::size_t capacity>
struct Exact {
    std::array<double, capacity> term{};
    std::size_t terms = 0;

    void add(double value)
    {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < terms; ++k) {
            const double sum = value + term[k], part = sum - value;
            const double error = (value - (sum - part)) + (term[k] - part);
            if (error != 0.0) term[kept++] = error;
            value = sum;
        }
        if (value != 0.0) term[kept++] = value;
        terms = kept;
    }
    void add_product(double a, double b)
    {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
    int sign() const { return terms == 0 ? 0 : term[terms - 1] > 0.0 ? 1 : -1; }
};

/// a b - c d, exactly.
Exact<4> minor(double a, double b, double c, double d)
{
    Exact<4> m;
    m.add_product(a, b);
    m.add_product(-c, d);
    return m;
}

// Determinants of coordinates, not of differences: differences would round.
int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const std::array<const Vec3*, 4> p{&a, &b, &c, &d};
    const auto xy = [&](std::size_t i, std::size_t j) { return minor(p[i]->x, p[j]->y, p[j]->x, p[i]->y); };
    const std::array<Exact<4>, 6> m{xy(0, 1), xy(0, 2), xy(0, 3), xy(1, 2), xy(1, 3), xy(2, 3)};
    // Rows (x, y, z, 1), expanded along the columns 1 and z: det = sum of +- z_k (three minors without row k).
    Exact<96> det;
    const auto expand = [&](double z, int s01, std::size_t m01, int s12, std::size_t m12, int s02, std::size_t m02) {
        for (const auto& [sign, which] : {std::pair{s01, m01}, std::pair{s12, m12}, std::pair{s02, m02}})
            for (std::size_t k = 0; k < m[which].terms; ++k) det.add_product(sign * z, m[which].term[k]);
    };
    expand(p[0]->z, -1, 3, -1, 5, 1, 4);
    expand(p[1]->z, 1, 1, 1, 5, -1, 2);
    expand(p[2]->z, -1, 0, -1, 4, 1, 2);
    expand(p[3]->z, 1, 0, 1, 3, -1, 1);
    return det.sign();
}

int exact_turn(double ax, double ay, double bx, double by, double cx, double cy)
{
    Exact<12> det;
    for (const auto& [x, y, s] : {std::array{ax, by, 1.0}, std::array{bx, cy, 1.0}, std::array{cx, ay, 1.0},
                                  std::array{bx, ay, -1.0}, std::array{cx, by, -1.0}, std::array{ax, cy, -1.0}})
        det.add_product(s * x, y);
    return det.sign();
}

constexpr double epsilon = 0x1p-53;

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double xy = u.x * v.y, yx = u.y * v.x, yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z;
    const double det = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
    // Rounding of the terms is below 8 of this (Shewchuk's bound is 7 eps plus a little).
    const double size = (std::abs(yz) + std::abs(zy)) * std::abs(w.x) + (std::abs(zx) + std::abs(xz)) * std::abs(w.y) +
                        (std::abs(xy) + std::abs(yx)) * std::abs(w.z);
    const double bound = 10.0 * epsilon * size;
    if (det > bound) return 1;
    if (det < -bound) return -1;
    return exact_orientation(a, b, c, d);
}

int turn(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v)
{
    const double left = (b[u] - a[u]) * (c[v] - a[v]), right = (b[v] - a[v]) * (c[u] - a[u]);
    const double bound = 6.0 * epsilon * (std::abs(left) + std::abs(right));
    if (left - right > bound) return 1;
    if (left - right < -bound) return -1;
    return exact_turn(a[u], a[v], b[u], b[v], c[u], c[v]);
}

namespace {

/// All five points lie in one plane: seen along the axis from which the triangle has an area.
bool meets_in_plane(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    for (const int u : {0, 1, 2}) {
        const int v = (u + 1) % 3;
        const int sense = turn(a, b, c, u, v);
        if (sense == 0) continue;
        const auto inside = [&](const Vec3& point) {
            return turn(a, b, point, u, v) * sense >= 0 && turn(b, c, point, u, v) * sense >= 0 &&
                   turn(c, a, point, u, v) * sense >= 0;
        };
        if (inside(p) || inside(q)) return true;
        // No end inside: the segment meets the triangle only if it properly crosses an edge or passes a vertex.
        const auto crosses = [&](const Vec3& e, const Vec3& f) {
            return turn(p, q, e, u, v) * turn(p, q, f, u, v) <= 0 && turn(e, f, p, u, v) * turn(e, f, q, u, v) <= 0;
        };
        const auto in_line = [&](const Vec3& e, const Vec3& f) {
            return turn(p, q, e, u, v) == 0 && turn(p, q, f, u, v) == 0;
        };
        // In line with an edge and outside at both ends: then another edge is met at a vertex, or nothing is.
        return (!in_line(a, b) && crosses(a, b)) || (!in_line(b, c) && crosses(b, c)) ||
               (!in_line(c, a) && crosses(c, a));
    }
    return false;
}

}  // namespace

bool meets(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const int side_p = orientation(a, b, c, p), side_q = orientation(a, b, c, q);
    if (side_p * side_q > 0) return false;
    if (side_p == 0 && side_q == 0) return meets_in_plane(p, q, a, b, c);
    // The line p-q passes the three edges on the same side, or through them.
    const int ab = orientation(p, q, a, b), bc = orientation(p, q, b, c);
    if (ab * bc < 0) return false;
    const int ca = orientation(p, q, c, a);
    return ab * ca >= 0 && bc * ca >= 0;
}

}  // namespace craze::domain
