// Which elements and bonds stand for the matter? The door of the room [3.1 - 3.4].

#pragma once

#include "craze/core/json_fwd.hpp"
#include "craze/core/schema.hpp"
#include "craze/domain/discretisation.hpp"
#include "craze/domain/files.hpp"
#include "craze/domain/packing.hpp"
#include "craze/domain/pairs.hpp"
#include "craze/domain/thickness.hpp"
#include "craze/mesh/crack_surface.hpp"
#include "craze/microstructure/microstructure.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace craze::domain {

/// How the paper's "dispersion of 25 %" is read [3.1.1].
enum class DispersionMeans {
    /// Radii within 12.5 % of the mean: the default. Packed to the paper's 92 000 elements the spheres then just touch
    /// (overlaps 0.3 %), touching pairs alone give the paper's cardinality, and Table 2 gives Table 1's modulus.
    total_width,
    /// Radii within 25 % of the mean. The same number of elements is then squeezed: overlaps 1 %, seven contacts each.
    each_side,
};

enum class CutBy { surface, voxels };

/// Section [domain].
struct Settings {
    std::optional<double> mean_radius;  ///< R_DE, m; none: R_C [Eq. 11]
    double dispersion = 0.25;
    DispersionMeans dispersion_means = DispersionMeans::total_width;
    double density = 0.0;  ///< elements per R_DE^3; 0: the paper's
    double cardinality = 6.2;
    double near_gap = 0.3;  ///< R_DE
    bool periodic = false;
    std::int64_t seed = 1;

    CutBy cut_by = CutBy::surface;
    CountedVoid counted = CountedVoid::crack;
    double r_tilde = 0.345;  ///< R_B / R_DE of the cylinders in which cracks are measured [Eq. 3]

    std::vector<std::int64_t> voxel_sizes{2, 4};  ///< multiples of the voxel at which thicknesses are studied [Fig. 16]

    /// A packing made elsewhere, instead of one made here (files.hpp).
    struct Import {
        std::string elements;  ///< file; empty: pack
        std::string bonds;     ///< file, for formats with two; empty: bonds are made
        std::string near;      ///< file; empty: near pairs are found
        std::string format = "auto";
        double unit = 1.0;        ///< m: one of the file's lengths
        std::vector<double> box;  ///< three edges, m; empty: as the file says, else around the elements
        bool alone = false;       ///< loaded as it is, without images
    } import_from;
    std::vector<std::string> write;  ///< formats to write the cracked, porous domain in
};

void describe(Schema& schema, Settings& settings);
/// @throws InvalidInput  naming the key; also when a file to import is not there
void check(const Settings& settings);

/// What makes two dense domains the same material whatever their box.
/// @param mean_radius  R_DE, m
Recipe recipe(const Settings& settings, double mean_radius);

/// A dense, bonded domain of the settings' recipe in a box of edges `box` (m).
Domain pack(const Vec3& box, double mean_radius, const Settings& settings);

/// The domain that `settings.import_from` names, without images: its contact beams are its cut bonds. A domain.vtkhdf
/// that `save` wrote brings its pores and cracks.
/// @throws InvalidInput  as read_domain does
Discretisation import_domain(const Settings& settings);
/// The same for a domain at hand: no element in a pore, contact beams cut with T1 = T2 = T.
Discretisation as_discretisation(Domain domain);

/// The dense domain in the box of the stack, packed or imported, and which of its elements and bonds the defects take.
/// @param R_C  closing radius of the microstructure, px: R_DE = R_C unless the settings say otherwise [Eq. 11]
Discretisation discretise(const microstructure::Microstructure& micro, const mesh::CrackSurface& surface, double R_C,
                          const Settings& settings);
/// The same for a domain at hand. Contact beams that it brings stay cut, by their own T unless a crack cuts them here.
Discretisation discretise(Domain domain, const microstructure::Microstructure& micro, const mesh::CrackSurface& surface,
                          const Settings& settings);

/// Writes domain.vtkhdf (dense, with what the defects take) and the formats asked for into `folder`.
/// @param density  rho_D of the dense ceramic, kg/m3, for the formats that ask for one
void save(const Discretisation& discretisation, const Settings& settings, const std::filesystem::path& folder,
          double density = 6060.0);
/// @throws InvalidInput  when domain.vtkhdf is missing or damaged
Discretisation load_discretisation(const std::filesystem::path& folder);

/// What summary.json says; keys in docs/results.md.
Json summary(const Discretisation& discretisation);

}  // namespace craze::domain
