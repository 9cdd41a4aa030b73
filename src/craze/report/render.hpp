// Pictures of spheres and sheets for print: orthographic, depth-buffered, without a graphics card.

#pragma once

#include "craze/core/vec3.hpp"
#include "craze/io/picture.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace craze::report {

struct Colour {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Colour&, const Colour&) = default;
};
/// "#rrggbb".
Colour colour_of(const std::string& text);
/// Dark blue over green to yellow for t from 0 to 1 (the viridis map of Smith and van der Walt, CC0, at nine knots).
Colour viridis(double t);

/// Things of space, any one length unit.
struct Scene {
    struct Sphere {
        Vec3 centre;
        double radius = 0.0;
        Colour colour;
    };
    struct Stick {
        Vec3 from, to;
        double radius = 0.0;
        Colour colour;
    };
    std::vector<Vec3> vertices;
    std::vector<std::array<std::int32_t, 3>> triangles;
    Colour sheet{213, 94, 0};  ///< of the triangles, lit from both sides
    std::vector<Sphere> spheres;
    std::vector<Stick> sticks;
    Vec3 box;  ///< its twelve edges are drawn, axes named at the corner (0, 0, 0)
};

struct View {
    std::int64_t width = 1400, height = 1050;  ///< px
    double azimuth = 35.0;                     ///< degrees from x towards y, of the direction the viewer stands in
    double elevation = 22.0;                   ///< degrees above the xy plane; z is up
};

/// The same bits on any number of threads.
io::Picture render(const Scene& scene, const View& view = {});

}  // namespace craze::report
