#include "craze/report/render.hpp"

#include "craze/core/multiversion.hpp"
#include "craze/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace craze::report {

namespace {

constexpr std::int64_t fine = 2;        // samples per pixel along each axis
constexpr std::int64_t band_rows = 32;  // fine rows that one task draws
constexpr float far_away = std::numeric_limits<float>::max();

/// A point on the paper: x to the right, y down (fine pixels), depth away from the viewer (same scale).
struct Spot {
    float x = 0.0F, y = 0.0F, depth = 0.0F;
};

struct Camera {
    Vec3 right, down, away, centre;
    double scale = 1.0, half_width = 0.0, half_height = 0.0;

    Spot operator()(const Vec3& p) const
    {
        const Vec3 d = p - centre;
        return {static_cast<float>(dot(d, right) * scale + half_width),
                static_cast<float>(dot(d, down) * scale + half_height), static_cast<float>(dot(d, away) * scale)};
    }
    Vec3 turned(const Vec3& n) const { return {dot(n, right), dot(n, down), dot(n, away)}; }
};

struct Canvas {
    std::int64_t width = 0, height = 0;
    std::vector<float> depth;
    std::vector<Colour> colour;

    void put(std::int64_t x, std::int64_t y, float d, Colour c)
    {
        const auto at = static_cast<std::size_t>(x + width * y);
        if (d < depth[at]) depth[at] = d, colour[at] = c;
    }
};

Camera camera_of(const Scene& scene, const View& view)
{
    Camera camera;
    const double a = view.azimuth * std::numbers::pi / 180.0, e = view.elevation * std::numbers::pi / 180.0;
    camera.away = {-std::cos(a) * std::cos(e), -std::sin(a) * std::cos(e), -std::sin(e)};
    camera.right = {-std::sin(a), std::cos(a), 0.0};
    camera.down = cross(camera.away, camera.right);
    camera.centre = scene.box * 0.5;
    double wide = 0.0, high = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 d{(corner & 1 ? 0.5 : -0.5) * scene.box.x, (corner & 2 ? 0.5 : -0.5) * scene.box.y,
                     (corner & 4 ? 0.5 : -0.5) * scene.box.z};
        wide = std::max(wide, std::abs(dot(d, camera.right)));
        high = std::max(high, std::abs(dot(d, camera.down)));
    }
    camera.half_width = 0.5 * static_cast<double>(view.width * fine);
    camera.half_height = 0.5 * static_cast<double>(view.height * fine);
    const double margin = 0.92;
    camera.scale =
        margin * std::min(camera.half_width / std::max(wide, 1e-300), camera.half_height / std::max(high, 1e-300));
    return camera;
}

/// Light from over the viewer's left shoulder; n in the camera's frame, pointing to the viewer.
float brightness(const Vec3& n)
{
    constexpr double lx = -0.40, ly = -0.52, lz = -0.755;
    const double lambert = std::max(0.0, n.x * lx + n.y * ly + n.z * lz);
    return static_cast<float>(0.34 + 0.68 * lambert);
}

Colour lit(Colour c, float light)
{
    const auto one = [light](std::uint8_t v) {
        return static_cast<std::uint8_t>(std::min(255.0F, static_cast<float>(v) * light + 0.5F));
    };
    return {one(c.r), one(c.g), one(c.b)};
}

void draw_triangle(Canvas& canvas, const std::array<Spot, 3>& p, Colour colour, std::int64_t first, std::int64_t last)
{
    const float area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (!(std::abs(area) > 1e-9F)) return;
    const auto clip = [](float v, std::int64_t least, std::int64_t most) {
        return std::clamp(static_cast<std::int64_t>(std::floor(v)), least, most);
    };
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (std::int64_t y = clip(top, first, last); y < clip(bottom + 1.0F, first, last); ++y)
        for (std::int64_t x = clip(left, 0, canvas.width); x < clip(right + 1.0F, 0, canvas.width); ++x) {
            const float u = static_cast<float>(x) + 0.5F, v = static_cast<float>(y) + 0.5F;
            const float w1 = ((u - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (v - p[0].y)) / area;
            const float w2 = ((p[1].x - p[0].x) * (v - p[0].y) - (u - p[0].x) * (p[1].y - p[0].y)) / area;
            if (w1 < 0.0F || w2 < 0.0F || w1 + w2 > 1.0F) continue;
            canvas.put(x, y, p[0].depth + w1 * (p[1].depth - p[0].depth) + w2 * (p[2].depth - p[0].depth), colour);
        }
}

void draw_ball(Canvas& canvas, const Spot& c, float r, Colour colour, std::int64_t first, std::int64_t last)
{
    const auto from = [](float v, std::int64_t least, std::int64_t most) {
        return std::clamp(static_cast<std::int64_t>(std::floor(v)), least, most);
    };
    for (std::int64_t y = from(c.y - r, first, last); y < from(c.y + r + 1.0F, first, last); ++y)
        for (std::int64_t x = from(c.x - r, 0, canvas.width); x < from(c.x + r + 1.0F, 0, canvas.width); ++x) {
            const float u = (static_cast<float>(x) + 0.5F - c.x) / r, v = (static_cast<float>(y) + 0.5F - c.y) / r;
            const float rest = 1.0F - u * u - v * v;
            if (rest < 0.0F) continue;
            const float w = std::sqrt(rest);
            canvas.put(x, y, c.depth - r * w, lit(colour, brightness({u, v, -w})));
        }
}

/// A cylinder seen from the side; good for sticks, whose ends nobody sees.
void draw_stick(Canvas& canvas, const Spot& a, const Spot& b, float r, Colour colour, std::int64_t first,
                std::int64_t last)
{
    const float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    const auto from = [](float v, std::int64_t least, std::int64_t most) {
        return std::clamp(static_cast<std::int64_t>(std::floor(v)), least, most);
    };
    const float length = std::sqrt(std::max(length2, 1e-12F));
    for (std::int64_t y = from(std::min(a.y, b.y) - r, first, last);
         y < from(std::max(a.y, b.y) + r + 1.0F, first, last); ++y)
        for (std::int64_t x = from(std::min(a.x, b.x) - r, 0, canvas.width);
             x < from(std::max(a.x, b.x) + r + 1.0F, 0, canvas.width); ++x) {
            const float px = static_cast<float>(x) + 0.5F - a.x, py = static_cast<float>(y) + 0.5F - a.y;
            const float t = length2 > 1e-6F ? std::clamp((px * dx + py * dy) / length2, 0.0F, 1.0F) : 0.0F;
            const float ox = px - t * dx, oy = py - t * dy, off2 = (ox * ox + oy * oy) / (r * r);
            if (off2 > 1.0F) continue;
            const float side = (px * -dy + py * dx) / (length * r), w = std::sqrt(1.0F - off2);
            const Vec3 n{-dy / length * side, dx / length * side, -w};
            canvas.put(x, y, a.depth + t * (b.depth - a.depth) - r * w, lit(colour, brightness(n)));
        }
}

/// Indices of the things that touch each band of rows, in their own order.
struct Bands {
    std::vector<std::int64_t> start;
    std::vector<std::int32_t> thing;

    template <class Reach>
    Bands(std::int64_t things, std::int64_t rows, Reach reach)
    {
        const std::int64_t bands = (rows + band_rows - 1) / band_rows;
        start.assign(static_cast<std::size_t>(bands + 1), 0);
        const auto each = [&](std::int64_t k, auto&& visit) {
            const auto [top, bottom] = reach(k);
            if (!(bottom >= 0.0F) || !(top < static_cast<float>(rows))) return;
            const auto first = static_cast<std::int64_t>(std::max(top, 0.0F)) / band_rows;
            const auto last = std::min(static_cast<std::int64_t>(bottom) / band_rows, bands - 1);
            for (auto b = first; b <= last; ++b) visit(static_cast<std::size_t>(b));
        };
        for (std::int64_t k = 0; k < things; ++k) each(k, [&](std::size_t b) { ++start[b + 1]; });
        for (std::size_t b = 0; b + 1 < start.size(); ++b) start[b + 1] += start[b];
        thing.resize(static_cast<std::size_t>(start.back()));
        auto next = start;
        for (std::int64_t k = 0; k < things; ++k)
            each(k, [&](std::size_t b) { thing[static_cast<std::size_t>(next[b]++)] = static_cast<std::int32_t>(k); });
    }
    template <class Draw>
    void visit(std::int64_t band, Draw&& draw) const
    {
        for (auto k = start[static_cast<std::size_t>(band)]; k < start[static_cast<std::size_t>(band) + 1]; ++k)
            draw(static_cast<std::size_t>(thing[static_cast<std::size_t>(k)]));
    }
};

/// The box's edges and the names of its axes, as thin sticks.
std::vector<Scene::Stick> frame_of(const Scene& scene, double thickness)
{
    std::vector<Scene::Stick> sticks;
    const Vec3 b = scene.box;
    const Colour ink{90, 96, 104};
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 from;
            from[(axis + 1) % 3] = corner & 1 ? b[(axis + 1) % 3] : 0.0;
            from[(axis + 2) % 3] = corner & 2 ? b[(axis + 2) % 3] : 0.0;
            Vec3 to = from;
            to[axis] = b[axis];
            sticks.push_back({from, to, thickness, ink});
        }
    return sticks;
}

/// Strokes of x, y and z in a unit square, y down.
using Stroke = std::array<float, 4>;
const std::vector<Stroke>& letter(int axis)
{
    static const std::array<std::vector<Stroke>, 3> strokes{
        std::vector<Stroke>{{0.1F, 0.1F, 0.9F, 0.9F}, {0.1F, 0.9F, 0.9F, 0.1F}},
        std::vector<Stroke>{{0.1F, 0.0F, 0.5F, 0.6F}, {0.9F, 0.0F, 0.2F, 1.05F}},
        std::vector<Stroke>{{0.1F, 0.1F, 0.9F, 0.1F}, {0.9F, 0.1F, 0.1F, 0.9F}, {0.1F, 0.9F, 0.9F, 0.9F}}};
    return strokes[static_cast<std::size_t>(axis)];
}

void name_axes(Canvas& canvas, const Scene& scene, const Camera& camera)
{
    const float size = 0.020F * static_cast<float>(canvas.height);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 end = scene.box * 0.5;
        // The edge nearest the viewer's lower left that runs along this axis.
        float best = -far_away;
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 middle;
            middle[axis] = 0.5 * scene.box[axis];
            middle[(axis + 1) % 3] = corner & 1 ? scene.box[(axis + 1) % 3] : 0.0;
            middle[(axis + 2) % 3] = corner & 2 ? scene.box[(axis + 2) % 3] : 0.0;
            const Spot s = camera(middle);
            const float merit = axis == 2 ? -s.x : s.y;
            if (merit > best) best = merit, end = middle;
        }
        const Spot at = camera(end), middle = camera(scene.box * 0.5);
        const float ox = at.x - middle.x, oy = at.y - middle.y, reach = std::max(1.0F, std::hypot(ox, oy));
        const float x0 = at.x + ox / reach * 1.9F * size - 0.5F * size,
                    y0 = at.y + oy / reach * 1.9F * size - 0.5F * size;
        for (const auto& s : letter(axis))
            draw_stick(canvas, {x0 + s[0] * size, y0 + s[1] * size, -1e6F}, {x0 + s[2] * size, y0 + s[3] * size, -1e6F},
                       0.09F * size, {90, 96, 104}, 0, canvas.height);
    }
}

/// Mean over windows of 2 reach + 1 along rows (stride 1) or columns (stride width), three times: nearly Gaussian.
CRAZE_MULTIVERSION void blur_line(const float* from, float* to, std::int64_t n, std::int64_t stride, std::int64_t reach)
{
    double sum = 0.0;
    const auto at = [&](std::int64_t k) { return from[std::clamp<std::int64_t>(k, 0, n - 1) * stride]; };
    for (std::int64_t k = -reach; k <= reach; ++k) sum += at(k);
    const double share = 1.0 / static_cast<double>(2 * reach + 1);
    for (std::int64_t k = 0; k < n; ++k) {
        to[k * stride] = static_cast<float>(sum * share);
        sum += at(k + reach + 1) - at(k - reach);
    }
}

std::vector<float> blurred(std::vector<float> image, std::int64_t width, std::int64_t height, std::int64_t reach)
{
    std::vector<float> twin(image.size());
    for (int pass = 0; pass < 3; ++pass) {
        parallel_ranges(height, [&](std::int64_t begin, std::int64_t end) {
            for (auto y = begin; y < end; ++y)
                blur_line(&image[static_cast<std::size_t>(y * width)], &twin[static_cast<std::size_t>(y * width)],
                          width, 1, reach);
        });
        parallel_ranges(width, [&](std::int64_t begin, std::int64_t end) {
            for (auto x = begin; x < end; ++x)
                blur_line(&twin[static_cast<std::size_t>(x)], &image[static_cast<std::size_t>(x)], height, width,
                          reach);
        });
    }
    return image;
}

/// What lies behind its surroundings is darker (Luft, Colditz, Deussen 2006), then samples are averaged.
io::Picture developed(const Canvas& canvas, const View& view, float box_depth)
{
    std::vector<float> depth = canvas.depth;
    for (auto& d : depth) d = std::clamp(d, -box_depth, box_depth);
    const auto soft = blurred(depth, canvas.width, canvas.height, std::max<std::int64_t>(2, canvas.width / 90));
    io::Picture picture(view.width, view.height, 3, 255);
    parallel_ranges(view.height, [&](std::int64_t begin, std::int64_t end) {
        for (auto y = begin; y < end; ++y)
            for (std::int64_t x = 0; x < view.width; ++x) {
                float r = 0.0F, g = 0.0F, b = 0.0F;
                for (std::int64_t k = 0; k < fine * fine; ++k) {
                    const auto at =
                        static_cast<std::size_t>(x * fine + k % fine + canvas.width * (y * fine + k / fine));
                    float shade = 1.0F;
                    if (canvas.depth[at] < far_away) {
                        const float sunk = (depth[at] - soft[at]) / box_depth;
                        shade = std::clamp(1.0F - 2.6F * std::max(0.0F, sunk), 0.35F, 1.0F);
                    }
                    r += shade * static_cast<float>(canvas.colour[at].r),
                        g += shade * static_cast<float>(canvas.colour[at].g),
                        b += shade * static_cast<float>(canvas.colour[at].b);
                }
                constexpr float share = 1.0F / static_cast<float>(fine * fine);
                auto* pixel = picture.at(x, y);
                pixel[0] = static_cast<std::uint8_t>(r * share + 0.5F);
                pixel[1] = static_cast<std::uint8_t>(g * share + 0.5F);
                pixel[2] = static_cast<std::uint8_t>(b * share + 0.5F);
            }
    });
    return picture;
}

}  // namespace

Colour colour_of(const std::string& text)
{
    const auto value = std::stoul(text.substr(1), nullptr, 16);
    return {static_cast<std::uint8_t>(value >> 16U & 255U), static_cast<std::uint8_t>(value >> 8U & 255U),
            static_cast<std::uint8_t>(value & 255U)};
}

Colour viridis(double t)
{
    static constexpr std::array<Colour, 9> knots{Colour{68, 1, 84},    Colour{71, 45, 123},  Colour{59, 82, 139},
                                                 Colour{44, 114, 142}, Colour{33, 145, 140}, Colour{40, 174, 128},
                                                 Colour{94, 201, 98},  Colour{173, 220, 48}, Colour{253, 231, 37}};
    const double at = std::clamp(t, 0.0, 1.0) * 8.0;
    const auto k = std::min<std::size_t>(7, static_cast<std::size_t>(at));
    const double w = at - static_cast<double>(k);
    const auto mix = [w](std::uint8_t a, std::uint8_t b) {
        return static_cast<std::uint8_t>((1.0 - w) * a + w * b + 0.5);
    };
    return {mix(knots[k].r, knots[k + 1].r), mix(knots[k].g, knots[k + 1].g), mix(knots[k].b, knots[k + 1].b)};
}

io::Picture render(const Scene& scene, const View& view)
{
    const Camera camera = camera_of(scene, view);
    Canvas canvas{view.width * fine, view.height * fine, {}, {}};
    canvas.depth.assign(static_cast<std::size_t>(canvas.width * canvas.height), far_away);
    canvas.colour.assign(canvas.depth.size(), Colour{255, 255, 255});

    const auto count = [](const auto& v) { return static_cast<std::int64_t>(v.size()); };
    std::vector<Spot> spots(scene.vertices.size());
    parallel_ranges(count(spots), [&](std::int64_t begin, std::int64_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
            spots[k] = camera(scene.vertices[k]);
    });
    auto sticks = frame_of(scene, 0.0011 * static_cast<double>(canvas.width) / camera.scale);
    sticks.insert(sticks.end(), scene.sticks.begin(), scene.sticks.end());

    const auto corners = [&](std::int64_t t) {
        const auto& c = scene.triangles[static_cast<std::size_t>(t)];
        return std::array<Spot, 3>{spots[static_cast<std::size_t>(c[0])], spots[static_cast<std::size_t>(c[1])],
                                   spots[static_cast<std::size_t>(c[2])]};
    };
    const auto scale = static_cast<float>(camera.scale);
    const Bands of_triangles(count(scene.triangles), canvas.height, [&](std::int64_t t) {
        const auto p = corners(t);
        return std::minmax({p[0].y, p[1].y, p[2].y});
    });
    const Bands of_spheres(count(scene.spheres), canvas.height, [&](std::int64_t k) {
        const auto& s = scene.spheres[static_cast<std::size_t>(k)];
        const float y = camera(s.centre).y, r = static_cast<float>(s.radius) * scale;
        return std::pair(y - r, y + r);
    });
    const Bands of_sticks(count(sticks), canvas.height, [&](std::int64_t k) {
        const auto& s = sticks[static_cast<std::size_t>(k)];
        const float a = camera(s.from).y, b = camera(s.to).y, r = static_cast<float>(s.radius) * scale;
        return std::pair(std::min(a, b) - r, std::max(a, b) + r);
    });
    parallel_tasks((canvas.height + band_rows - 1) / band_rows, [&](std::int64_t band) {
        const std::int64_t first = band * band_rows, last = std::min(canvas.height, first + band_rows);
        of_triangles.visit(band, [&](std::size_t t) {
            const auto& c = scene.triangles[t];
            const auto vertex = [&](std::size_t k) { return scene.vertices[static_cast<std::size_t>(c[k])]; };
            Vec3 n = camera.turned(cross(vertex(1) - vertex(0), vertex(2) - vertex(0)));
            const double length = norm(n);
            if (!(length > 0.0)) return;
            n *= (n.z > 0.0 ? -1.0 : 1.0) / length;
            draw_triangle(canvas, corners(static_cast<std::int64_t>(t)), lit(scene.sheet, brightness(n)), first, last);
        });
        of_spheres.visit(band, [&](std::size_t k) {
            const auto& s = scene.spheres[k];
            draw_ball(canvas, camera(s.centre), static_cast<float>(s.radius) * scale, s.colour, first, last);
        });
        of_sticks.visit(band, [&](std::size_t k) {
            const auto& s = sticks[k];
            draw_stick(canvas, camera(s.from), camera(s.to), static_cast<float>(s.radius) * scale, s.colour, first,
                       last);
        });
    });
    name_axes(canvas, scene, camera);
    return developed(canvas, view, static_cast<float>(0.5 * norm(scene.box) * camera.scale));
}

}  // namespace craze::report
