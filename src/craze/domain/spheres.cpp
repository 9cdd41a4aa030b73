#include "craze/domain/spheres.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"
#include "craze/domain/cells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace craze::domain {

namespace {

constexpr std::int64_t lanes = 8;    // spheres worked on together: a slice
constexpr std::int64_t block = 128;  // slices that share a list and a partial sum
constexpr double half_box = 0x1p29;  // steps from the middle of a walled box to its walls
constexpr float farthest_step = 0.25F;

using Ints [[gnu::vector_size(32), gnu::may_alias]] = std::int32_t;
using Words [[gnu::vector_size(32), gnu::may_alias]] = std::uint32_t;
using Floats [[gnu::vector_size(32), gnu::may_alias]] = float;
using Record [[gnu::vector_size(16), gnu::may_alias]] = std::uint32_t;

std::size_t at(std::int64_t k) { return static_cast<std::size_t>(k); }

template <class V>
CRAZE_INLINE V load(const void* p)
{
    V v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
template <class V>
CRAZE_INLINE void store(void* p, V v)
{
    std::memcpy(p, &v, sizeof v);
}
CRAZE_INLINE Floats spread(float a) { return Floats{a, a, a, a, a, a, a, a}; }
CRAZE_INLINE Floats to_floats(Words difference)
{
    return __builtin_convertvector(std::bit_cast<Ints>(difference), Floats);
}
CRAZE_INLINE Floats root(Floats v)
{
    return Floats{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3]),
                  std::sqrt(v[4]), std::sqrt(v[5]), std::sqrt(v[6]), std::sqrt(v[7])};
}
CRAZE_INLINE Floats at_least_zero(Floats v) { return v > 0.0F ? v : spread(0.0F); }
CRAZE_INLINE Floats greater(Floats a, Floats b) { return a > b ? a : b; }

/// Eight spheres, coordinate by coordinate.
struct Eight {
    Words x, y, z;
    Floats r;
};

/// Rows of four become columns and columns rows, in each half of the registers.
CRAZE_INLINE void transpose(Words& a, Words& b, Words& c, Words& d)
{
    const Words ab_0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
                ab_1 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
                cd_0 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
                cd_1 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    a = __builtin_shufflevector(ab_0, cd_0, 0, 1, 8, 9, 4, 5, 12, 13);
    b = __builtin_shufflevector(ab_0, cd_0, 2, 3, 10, 11, 6, 7, 14, 15);
    c = __builtin_shufflevector(ab_1, cd_1, 0, 1, 8, 9, 4, 5, 12, 13);
    d = __builtin_shufflevector(ab_1, cd_1, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// @param record  address of the sphere of lane k
template <class RecordOf>
CRAZE_INLINE Eight gather(RecordOf&& record)
{
    const auto two = [&](int low, int high) {
        return __builtin_shufflevector(load<Record>(record(low)), load<Record>(record(high)), 0, 1, 2, 3, 4, 5, 6, 7);
    };
    Words a = two(0, 4), b = two(1, 5), c = two(2, 6), d = two(3, 7);
    transpose(a, b, c, d);
    return {a, b, c, std::bit_cast<Floats>(d)};
}

struct Axes {
    Floats x, y, z;
};

/// What a kernel knows of the box.
struct Frame {
    float unit[3];  // R_DE per step
    bool periodic;
    float stiffening;
};
Frame frame_of(const Vec3& unit, bool periodic, float stiffening)
{
    return {{static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)}, periodic, stiffening};
}

struct Partial {
    double power, force2, speed2, overlap, most, contacts;
};

CRAZE_INLINE double sum(Floats v)
{
    double s = 0.0;
    for (int l = 0; l < lanes; ++l) s += static_cast<double>(v[l]);
    return s;
}

/// Forces on the spheres of slices [first, last), a block, and its sums.
CRAZE_MULTIVERSION Partial push_block(const void* spheres, float* velocity, float* force, const std::int32_t* list,
                                      const std::uint32_t* begin, std::int64_t first, std::int64_t last,
                                      const Frame& frame)
{
    const char* const base = static_cast<const char*>(spheres);
    const Floats ux = spread(frame.unit[0]), uy = spread(frame.unit[1]), uz = spread(frame.unit[2]);
    const Floats one = spread(1.0F), zero = spread(0.0F), stiffening = spread(frame.stiffening);
    Floats power = zero, force2 = zero, speed2 = zero, overlaps = zero, most = zero;
    Ints contacts{};
    for (std::int64_t s = first; s < last; ++s) {
        const char* const own = base + s * lanes * 16;
        const Eight a = gather([&](int l) { return own + l * 16; });
        Axes f{zero, zero, zero};
        const std::int32_t* const end = list + begin[s - first + 1];
        for (const std::int32_t* near = list + begin[s - first]; near < end; near += lanes) {
            const Eight o = gather([&](int l) { return base + static_cast<std::int64_t>(near[l]) * 16; });
            const Floats dx = to_floats(a.x - o.x) * ux, dy = to_floats(a.y - o.y) * uy, dz = to_floats(a.z - o.z) * uz;
            const Floats reach = a.r + o.r, d = root(dx * dx + dy * dy + dz * dz + 1e-20F);
            const Floats overlap = at_least_zero(reach - d);
            const Floats inverse = one / (d * reach), relative = overlap * d * inverse;
            const Floats excess = relative * 50.0F, capped = excess < 1.0F ? excess : one;
            const Floats push = overlap * reach * inverse * (one + stiffening * capped * capped);
            f.x += push * dx, f.y += push * dy, f.z += push * dz;
            overlaps += overlap;
            most = greater(most, relative);
            contacts -= overlap > 0.0F;
        }
        if (!frame.periodic) {
            const auto wall = [&](Words c, Floats unit) {
                const std::uint32_t half = static_cast<std::uint32_t>(half_box);
                return at_least_zero(a.r - to_floats(c + half) * unit) -
                       at_least_zero(a.r - to_floats(half - c) * unit);
            };
            f.x += wall(a.x, ux), f.y += wall(a.y, uy), f.z += wall(a.z, uz);
        }
        float* const v_of = velocity + s * 3 * lanes;
        float* const f_of = force + s * 3 * lanes;
        const Floats f2 = f.x * f.x + f.y * f.y + f.z * f.z;
        const auto moving = [&](int axis) {
            const Floats v = load<Floats>(v_of + axis * lanes);
            const Floats kept = f2 > 0.0F ? v : zero;
            store(v_of + axis * lanes, kept);
            return kept;
        };
        const Axes v{moving(0), moving(1), moving(2)};
        store(f_of, f.x), store(f_of + lanes, f.y), store(f_of + 2 * lanes, f.z);
        power += f.x * v.x + f.y * v.y + f.z * v.z;
        force2 += f2;
        speed2 += v.x * v.x + v.y * v.y + v.z * v.z;
    }
    Partial p{sum(power), sum(force2), sum(speed2), sum(overlaps), 0.0, 0.0};
    for (int l = 0; l < lanes; ++l) {
        p.most = std::max(p.most, static_cast<double>(most[l]));
        p.contacts += contacts[l];
    }
    return p;
}

/// Moves the spheres of slices [first, last); the greatest squared distance from `listed`.
CRAZE_MULTIVERSION double advance_block(void* spheres, float* velocity, const float* force, const std::int32_t* listed,
                                        std::int64_t first, std::int64_t last, float keep, float steer, float dt,
                                        const Frame& frame)
{
    char* const base = static_cast<char*>(spheres);
    Floats most = spread(0.0F);
    for (std::int64_t s = first; s < last; ++s) {
        char* const own = base + s * lanes * 16;
        float* const v_of = velocity + s * 3 * lanes;
        const float* const f_of = force + s * 3 * lanes;
        Eight a = gather([&](int l) { return own + l * 16; });
        Floats far2 = spread(0.0F);
        const auto move = [&](Words& c, int axis) {
            const Floats v = load<Floats>(v_of + axis * lanes) * keep + load<Floats>(f_of + axis * lanes) * steer;
            store(v_of + axis * lanes, v);
            Floats step = v * dt;
            step = step > farthest_step ? spread(farthest_step) : step;
            step = step < -farthest_step ? spread(-farthest_step) : step;
            const Floats steps = step * (1.0F / frame.unit[axis]);
            const Floats half = steps < 0.0F ? spread(-0.5F) : spread(0.5F);
            c += std::bit_cast<Words>(__builtin_convertvector(steps + half, Ints));
            const Floats moved = to_floats(c - load<Words>(listed + s * 3 * lanes + axis * lanes)) * frame.unit[axis];
            far2 += moved * moved;
        };
        move(a.x, 0), move(a.y, 1), move(a.z, 2);
        most = greater(most, far2);
        Words rows[4] = {a.x, a.y, a.z, std::bit_cast<Words>(a.r)};
        transpose(rows[0], rows[1], rows[2], rows[3]);
        for (int k = 0; k < 4; ++k) {
            store(own + k * 16, __builtin_shufflevector(rows[k], rows[k], 0, 1, 2, 3));
            store(own + (k + 4) * 16, __builtin_shufflevector(rows[k], rows[k], 4, 5, 6, 7));
        }
    }
    double result = 0.0;
    for (int l = 0; l < lanes; ++l) result = std::max(result, static_cast<double>(most[l]));
    return result;
}

/// Spheres in the order of their cells, coordinate by coordinate; then a slice of spheres that touch nothing.
struct Sorted {
    std::vector<std::int32_t> member;
    std::vector<std::uint32_t> x, y, z;
    std::vector<float> r;

    explicit Sorted(std::int64_t size)
        : member(at(size + lanes)), x(member.size()), y(member.size()), z(member.size()), r(member.size(), -1e9F)
    {
    }
};

/// Stretches of sorted spheres: the rows of cells around one cell.
struct Surroundings {
    std::array<std::int32_t, 3> cell{-1, -1, -1};
    std::vector<std::pair<std::size_t, std::size_t>> rows;
    std::size_t members = 0;
};

/// Which of those around are within `skin` of touching a sphere: their numbers into `found`, itself among them; up to
/// eight places behind the last are written.
CRAZE_MULTIVERSION std::size_t search(const Sorted& sorted, const Surroundings& around, const void* sphere, float skin,
                                      const Frame& frame, std::int32_t* found)
{
    const Eight own = gather([&](int) { return sphere; });
    const Floats ux = spread(frame.unit[0]), uy = spread(frame.unit[1]), uz = spread(frame.unit[2]);
    const Floats own_reach = own.r + skin;
    const std::uint32_t *const x = sorted.x.data(), *const y = sorted.y.data(), *const z = sorted.z.data();
    const float* const r = sorted.r.data();
    const std::int32_t* const member = sorted.member.data();
    alignas(32) std::int32_t keep[lanes];
    std::size_t count = 0;
    for (const auto& [first, last] : around.rows)
        for (std::size_t m = first; m < last; m += lanes) {
            const Floats dx = to_floats(own.x - load<Words>(x + m)) * ux,
                         dy = to_floats(own.y - load<Words>(y + m)) * uy,
                         dz = to_floats(own.z - load<Words>(z + m)) * uz;
            const Floats reach = at_least_zero(own_reach + load<Floats>(r + m));
            const auto left = static_cast<std::int32_t>(last - m);
            const Ints near = (dx * dx + dy * dy + dz * dz < reach * reach) & (Ints{0, 1, 2, 3, 4, 5, 6, 7} < left);
            store(keep, near);
            // Written always, kept if near: no branch to foresee.
            for (std::size_t l = 0; l < lanes; ++l) {
                found[count] = member[m + l];
                count -= static_cast<std::size_t>(static_cast<std::int64_t>(keep[l]));
            }
        }
    return count;
}

/// Runs of cells that hold the neighbours along one axis: one, or two where the box wraps around.
struct Runs {
    std::array<std::int32_t, 2> first{}, last{};  // last is one past
    std::size_t count = 0;
};

Runs runs_around(std::int32_t c, std::int32_t n, bool periodic)
{
    Runs runs;
    const auto add = [&](std::int32_t first, std::int32_t last) {
        runs.first[runs.count] = first;
        runs.last[runs.count++] = last;
    };
    if (!periodic || n <= 3) {
        add(periodic ? 0 : std::max(0, c - 1), periodic ? n : std::min(n, c + 2));
    } else if (c == 0 || c == n - 1) {
        add(c == 0 ? 0 : n - 2, c == 0 ? 2 : n);
        add(c == 0 ? n - 1 : 0, c == 0 ? n : 1);
    } else {
        add(c - 1, c + 2);
    }
    return runs;
}

}  // namespace

Spheres::Spheres(const Vec3& box, bool periodic, std::span<const Vec3> centres, std::span<const double> radii,
                 double stiffening)
    : box_(box),
      periodic_(periodic),
      stiffening_(static_cast<float>(stiffening)),
      size_(std::ssize(centres)),
      slices_((size_ + lanes - 1) / lanes)
{
    for (int axis = 0; axis < 3; ++axis) unit_[axis] = box[axis] * (periodic ? 0x1p-32 : 0x1p-30);
    // Of negative radius: touches nothing.
    at_.assign(at((slices_ + 1) * lanes), Sphere{0, 0, 0, -1e9F});
    for (std::size_t k = 0; k < centres.size(); ++k) {
        std::array<std::int32_t, 3> q{};
        for (int axis = 0; axis < 3; ++axis) {
            const double steps = centres[k][axis] / unit_[axis];
            q[static_cast<std::size_t>(axis)] =
                periodic ? static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(steps)))
                         : static_cast<std::int32_t>(std::lround(steps - half_box));
        }
        at_[k] = {q[0], q[1], q[2], static_cast<float>(radii[k])};
        r_most_ = std::max(r_most_, radii[k]);
    }
    velocity_.assign(at(slices_ * 3 * lanes), 0.0F);
    force_ = velocity_;
    listed_at_.assign(velocity_.size(), 0);
    const std::int64_t blocks = (slices_ + block - 1) / block;
    near_.resize(at(blocks));
    begin_.resize(at(slices_ + blocks));
}

Vec3 Spheres::centre(std::int64_t k) const
{
    const Sphere& s = at_[at(k)];
    const auto place = [&](std::int32_t c, int axis) {
        return periodic_ ? static_cast<std::uint32_t>(c) * unit_[axis] : (c + half_box) * unit_[axis];
    };
    return {place(s.x, 0), place(s.y, 1), place(s.z, 2)};
}

void Spheres::list_neighbours(double skin)
{
    std::vector<double> x(at(size_)), y(at(size_)), z(at(size_));
    parallel_ranges(size_, [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t k = first; k < last; ++k) {
            const Vec3 c = centre(k);
            x[at(k)] = c.x, y[at(k)] = c.y, z[at(k)] = c.z;
        }
    });
    const Cells cells(box_, 2.0 * r_most_ + skin, x, y, z);
    const auto n = cells.count();
    const std::int32_t* const members = cells.members().data();
    Sorted sorted(size_);
    parallel_ranges(size_, [&](std::int64_t first, std::int64_t last) {
        for (auto m = at(first); m < at(last); ++m) {
            const Sphere& s = at_[at(members[m])];
            sorted.member[m] = members[m];
            sorted.x[m] = static_cast<std::uint32_t>(s.x);
            sorted.y[m] = static_cast<std::uint32_t>(s.y);
            sorted.z[m] = static_cast<std::uint32_t>(s.z);
            sorted.r[m] = s.r;
        }
    });
    const Frame frame = frame_of(unit_, periodic_, stiffening_);
    const auto nobody = static_cast<std::int32_t>(slices_ * lanes);

    parallel_tasks(std::ssize(near_), [&](std::int64_t b) {
        auto& list = near_[at(b)];
        list.clear();
        Surroundings around;
        const auto look_around = [&](const std::array<std::int32_t, 3>& cell) {
            around.cell = cell;
            around.rows.clear();
            around.members = 0;
            const Runs xs = runs_around(cell[0], n[0], periodic_), ys = runs_around(cell[1], n[1], periodic_),
                       zs = runs_around(cell[2], n[2], periodic_);
            const auto each = [](const Runs& runs, auto&& visit) {
                for (std::size_t run = 0; run < runs.count; ++run)
                    for (std::int32_t c = runs.first[run]; c < runs.last[run]; ++c) visit(c);
            };
            each(zs, [&](std::int32_t cz) {
                each(ys, [&](std::int32_t cy) {
                    for (std::size_t run = 0; run < xs.count; ++run) {
                        const auto row = cells.row(xs.first[run], xs.last[run], cy, cz);
                        const auto start = static_cast<std::size_t>(row.data() - members);
                        around.rows.emplace_back(start, start + row.size());
                        around.members += row.size();
                    }
                });
            });
        };
        std::array<std::vector<std::int32_t>, lanes> found;
        std::array<std::size_t, lanes> counts{};
        const std::int64_t first = b * block, last = std::min(slices_, first + block);
        for (std::int64_t s = first; s < last; ++s) {
            begin_[at(s + b)] = static_cast<std::uint32_t>(list.size());
            std::size_t widest = 0;
            for (std::int64_t l = 0; l < lanes; ++l) {
                const std::int64_t i = s * lanes + l;
                counts[at(l)] = 0;
                if (i >= size_) continue;
                const Sphere& own = at_[at(i)];
                std::int32_t* const listed = listed_at_.data() + s * 3 * lanes + l;
                listed[0] = own.x, listed[lanes] = own.y, listed[2 * lanes] = own.z;
                const std::array cell{cells.along(0, x[at(i)]), cells.along(1, y[at(i)]), cells.along(2, z[at(i)])};
                if (cell != around.cell) look_around(cell);
                auto& mine = found[at(l)];
                if (mine.size() < around.members + lanes) mine.resize(around.members + lanes);
                std::size_t count = search(sorted, around, &own, static_cast<float>(skin), frame, mine.data());
                // Itself is among them.
                const auto self = std::find(mine.begin(), mine.end(), static_cast<std::int32_t>(i));
                *self = mine[--count];
                counts[at(l)] = count;
                widest = std::max(widest, count);
            }
            const std::size_t start = list.size();
            list.resize(start + widest * lanes, nobody);
            for (std::size_t l = 0; l < lanes; ++l)
                for (std::size_t k = 0; k < counts[l]; ++k) list[start + k * lanes + l] = found[l][k];
        }
        begin_[at(last + b)] = static_cast<std::uint32_t>(list.size());
    });
}

Spheres::Sums Spheres::push()
{
    std::vector<Partial> partial(near_.size());
    const Frame frame = frame_of(unit_, periodic_, stiffening_);
    parallel_ranges(std::ssize(near_), [&](std::int64_t b_begin, std::int64_t b_end) {
        for (std::int64_t b = b_begin; b < b_end; ++b)
            partial[at(b)] =
                push_block(at_.data(), velocity_.data(), force_.data(), near_[at(b)].data(),
                           begin_.data() + b * (block + 1), b * block, std::min(slices_, (b + 1) * block), frame);
    });
    Sums total;
    for (const Partial& s : partial) {
        total.power += s.power;
        total.force2 += s.force2;
        total.speed2 += s.speed2;
        total.overlap += s.overlap;
        total.contacts += static_cast<std::int64_t>(s.contacts);
        total.most = std::max(total.most, s.most);
    }
    return total;
}

double Spheres::advance(double keep, double steer, double dt)
{
    std::vector<double> far2(near_.size());
    const Frame frame = frame_of(unit_, periodic_, stiffening_);
    parallel_ranges(std::ssize(near_), [&](std::int64_t b_begin, std::int64_t b_end) {
        for (std::int64_t b = b_begin; b < b_end; ++b)
            far2[at(b)] = advance_block(at_.data(), velocity_.data(), force_.data(), listed_at_.data(), b * block,
                                        std::min(slices_, (b + 1) * block), static_cast<float>(keep),
                                        static_cast<float>(steer), static_cast<float>(dt), frame);
    });
    return std::sqrt(*std::ranges::max_element(far2));
}

}  // namespace craze::domain
