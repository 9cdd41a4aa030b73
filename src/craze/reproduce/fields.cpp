#include "craze/io/vtu_file.hpp"
#include "craze/report/colour_bar.hpp"
#include "craze/report/render.hpp"
#include "craze/reproduce/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace craze::reproduce {

namespace fs = std::filesystem;

namespace {

/// The state whose file begins so, empty where there is none.
fs::path state(const fs::path& folder, const std::string& begins)
{
    if (!fs::is_directory(folder)) return {};
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().filename().string().starts_with(begins) && entry.path().extension() == ".vtu")
            return entry.path();
    return {};
}

/// Elements where they have gone, coloured by their displacement along the load; 1 % of the values lies beyond each
/// end.
Field drawn(const fs::path& file, int axis, Field field)
{
    const auto seen = io::read_vtu_points(file);
    const std::size_t n = seen.radius.size();
    std::vector<double> along(n);
    report::Scene scene;
    for (std::size_t e = 0; e < n; ++e) {
        along[e] = static_cast<double>(seen.displacement[3 * e + static_cast<std::size_t>(axis)]);
        for (std::size_t a = 0; a < 3; ++a)
            scene.box[static_cast<int>(a)] =
                std::max(scene.box[static_cast<int>(a)], seen.points[3 * e + a] + static_cast<double>(seen.radius[e]));
    }
    std::vector<double> sorted = along;
    std::sort(sorted.begin(), sorted.end());
    const double least = sorted[n / 100], most = sorted[n - 1 - n / 100], span = std::max(most - least, 1e-15);
    for (std::size_t e = 0; e < n; ++e) {
        Vec3 at;
        for (std::size_t a = 0; a < 3; ++a)
            at[static_cast<int>(a)] = seen.points[3 * e + a] + static_cast<double>(seen.displacement[3 * e + a]);
        scene.spheres.push_back({at, static_cast<double>(seen.radius[e]),
                                 report::viridis(std::clamp((along[e] - least) / span, 0.0, 1.0))});
    }
    field.picture = report::with_colour_bar(report::render(scene, {1000, 750}),
                                            {1e9 * least, 1e9 * (least + span), fmt::format("u_{} [nm]", "xyz"[axis])});
    field.caption += fmt::format(" Colour: displacement along {}.", "xyz"[axis]);
    return field;
}

}  // namespace

std::vector<Field> fields(const fs::path& folder)
{
    std::vector<Field> out;
    const auto add = [&](const fs::path& file, int axis, Field field) {
        if (!file.empty()) out.push_back(drawn(file, axis, std::move(field)));
    };
    add(state(folder / "elastic" / "states", "both_uniaxial_y_compression"), 1,
        {"fig19_compression_y", "Pores and cracks compressed along y to -0.59 %.", "Fig. 19", {}});
    const fs::path broken = folder / "fracture_30_GPa" / "states";
    add(state(broken, "both_fracture_x_tension"), 0,
        {"fig24_tension", "Bonds of 30 GPa pulled along x, at the end of the loading.", "Fig. 24", {}});
    add(state(broken, "both_fracture_x_compression"), 0,
        {"fig24_compression", "Bonds of 30 GPa compressed along x, at the end of the loading.", "Fig. 24", {}});
    return out;
}

}  // namespace craze::reproduce
