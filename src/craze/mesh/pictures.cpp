#include "craze/mesh/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace craze::mesh {

namespace {

using Rgb = std::array<double, 3>;

constexpr Rgb white{255, 255, 255}, gray{150, 150, 150}, orange{213, 94, 0}, black{0, 0, 0}, blue{0, 90, 160};

Rgb mixed(const Rgb& a, const Rgb& b, double t)
{
    return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

Rgb heat(double t)
{
    t = std::clamp(t, 0.0, 1.0);
    return t < 0.6 ? mixed(white, orange, t / 0.6) : mixed(orange, black, (t - 0.6) / 0.4);
}

// Each pixel is the mean of three by three samples of colour(x, y).
template <class ColourAt>
io::Picture drawn(std::int64_t width, std::int64_t height, ColourAt&& colour)
{
    io::Picture picture(width, height, 3);
    for (std::int64_t y = 0; y < height; ++y)
        for (std::int64_t x = 0; x < width; ++x) {
            Rgb sum{};
            for (const double down : {1.0, 3.0, 5.0})
                for (const double across : {1.0, 3.0, 5.0}) {
                    const Rgb c = colour(static_cast<double>(x) + across / 6.0, static_cast<double>(y) + down / 6.0);
                    for (std::size_t i = 0; i < 3; ++i) sum[i] += c[i] / 9.0;
                }
            for (std::size_t i = 0; i < 3; ++i) picture.at(x, y)[i] = static_cast<std::uint8_t>(std::lround(sum[i]));
        }
    return picture;
}

double angle(double y, double x)
{
    const double a = std::atan2(y, x);
    return a < 0.0 ? a + 2.0 * std::numbers::pi : a;
}

}  // namespace

io::Picture pole_figure_picture(const PoleFigure& poles)
{
    constexpr double radius = 240.0, centre = 256.0;
    const double fullest = std::max(*std::ranges::max_element(poles.share), 1e-300);
    return drawn(580, 512, [&](double x, double y) -> Rgb {
        if (x > 530.0 && x < 556.0 && y > 16.0 && y < 496.0) return heat((496.0 - y) / 480.0);
        const double u = (x - centre) / radius, v = (centre - y) / radius, r2 = u * u + v * v;
        if (r2 > 1.0) return r2 < 1.012 ? gray : white;
        const int ring = std::min(static_cast<int>(r2 * PoleFigure::rings), PoleFigure::rings - 1);
        const int sector = std::min(static_cast<int>(angle(v, u) / (2.0 * std::numbers::pi) * PoleFigure::sectors),
                                    PoleFigure::sectors - 1);
        return heat(poles.share[static_cast<std::size_t>(sector + PoleFigure::sectors * ring)] / fullest);
    });
}

io::Picture rose_picture(const Rose& rose)
{
    constexpr double radius = 150.0, side = 320.0;
    double fullest = 1e-300;
    for (const auto& shares : rose.share) fullest = std::max(fullest, *std::ranges::max_element(shares));
    return drawn(960, 320, [&](double x, double y) -> Rgb {
        const auto which = std::min(static_cast<std::size_t>(x / side), std::size_t{2});
        const double u = (x - (static_cast<double>(which) + 0.5) * side) / radius, v = (0.5 * side - y) / radius;
        const double r2 = u * u + v * v;
        const double turn = angle(v, u) / std::numbers::pi;
        const auto bin = static_cast<std::size_t>((turn - std::floor(turn)) * Rose::bins);
        const double share = rose.share[which][std::min(bin, std::size_t{Rose::bins - 1})];
        if (r2 <= share / fullest) return blue;
        if (std::abs(r2 - 1.0) < 0.012) return gray;
        return r2 < 1.0 && (std::abs(u) < 0.004 || std::abs(v) < 0.004) ? gray : white;
    });
}

}  // namespace craze::mesh
