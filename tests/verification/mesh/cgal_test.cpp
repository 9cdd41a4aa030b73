// craze's alpha shape against CGAL's, an independent Delaunay triangulation.

#include "craze/core/progress.hpp"
#include "craze/core/vec3.hpp"
#include "craze/mesh/alpha_shape.hpp"
#include "craze/mesh/skeleton.hpp"
#include "support/masks.hpp"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Fixed_alpha_shape_3.h>
#include <CGAL/Fixed_alpha_shape_cell_base_3.h>
#include <CGAL/Fixed_alpha_shape_vertex_base_3.h>
#include <gtest/gtest.h>

#include <array>
#include <map>

namespace craze::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tds = CGAL::Triangulation_data_structure_3<CGAL::Fixed_alpha_shape_vertex_base_3<Kernel>,
                                                 CGAL::Fixed_alpha_shape_cell_base_3<Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, Tds>;
using Shape3 = CGAL::Fixed_alpha_shape_3<Delaunay>;

// What any triangulation of the same flat faces has in common: by plane (reduced normal and offset) and number of
// sides, how many triangles and what area.
using Key = std::array<long, 5>;
struct Face {
    int triangles = 0;
    double area = 0.0;
};
using Faces = std::map<Key, Face>;

long gcd(long a, long b, long c) { return std::gcd(std::gcd(a, b), c); }

void add(Faces& faces, const std::array<Vec3, 3>& t, int sides)
{
    const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
    long k[3] = {std::lround(n.x), std::lround(n.y), std::lround(n.z)};
    const long g = gcd(k[0], k[1], k[2]);
    ASSERT_NE(g, 0) << "a flat triangle";
    const long first = k[0] != 0 ? k[0] : k[1] != 0 ? k[1] : k[2];
    for (long& c : k) c /= first > 0 ? g : -g;
    const long offset =
        std::lround(dot(t[0], {static_cast<double>(k[0]), static_cast<double>(k[1]), static_cast<double>(k[2])}));
    Face& face = faces[{k[0], k[1], k[2], offset, sides}];
    ++face.triangles;
    face.area += 0.5 * norm(n);
}

Faces faces_of(const LatticeSurface& s)
{
    Faces faces;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& p = s.vertices[static_cast<std::size_t>(s.triangles[t][k])];
            corners[k] = {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
        }
        add(faces, corners, s.sides[t]);
    }
    return faces;
}

Faces faces_by_cgal(const Mask& mask, double alpha)
{
    std::vector<Kernel::Point_3> points;
    const Shape s = mask.shape();
    for (std::int64_t z = 0; z < s.nz; ++z)
        for (std::int64_t y = 0; y < s.ny; ++y)
            for (std::int64_t x = 0; x < s.nx; ++x)
                if (mask(x, y, z))
                    points.emplace_back(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    Delaunay delaunay(points.begin(), points.end());
    Shape3 shape(delaunay, alpha * alpha);
    Faces faces;
    for (auto f = shape.finite_facets_begin(); f != shape.finite_facets_end(); ++f) {
        const auto type = shape.classify(*f);
        if (type != Shape3::REGULAR && type != Shape3::SINGULAR) continue;
        std::array<Vec3, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const auto& p = f->first->vertex((f->second + 1 + k) % 4)->point();
            corners[static_cast<std::size_t>(k)] = {p.x(), p.y(), p.z()};
        }
        add(faces, corners, type == Shape3::REGULAR ? 1 : 2);
    }
    return faces;
}

void expect_equal(const Mask& mask, double alpha, const std::string& what)
{
    const Faces ours = faces_of(alpha_shape(mask, alpha)), theirs = faces_by_cgal(mask, alpha);
    ASSERT_EQ(ours.size(), theirs.size()) << what << ", alpha " << alpha;
    for (auto a = ours.begin(), b = theirs.begin(); a != ours.end(); ++a, ++b) {
        ASSERT_EQ(a->first, b->first) << what << ", alpha " << alpha;
        ASSERT_EQ(a->second.triangles, b->second.triangles) << what << ", alpha " << alpha;
        ASSERT_NEAR(a->second.area, b->second.area, 1e-9 * b->second.area) << what << ", alpha " << alpha;
    }
}

class AgainstCgal : public testing::TestWithParam<double> {
protected:
    void SetUp() override { set_verbosity(Verbosity::quiet); }
};

TEST_P(AgainstCgal, RandomVoxelsGiveTheSameFacesPlaneByPlane)
{
    for (const double share : {0.02, 0.1, 0.35, 0.8})
        expect_equal(support::random_mask(Shape{22, 20, 18}, share, 17), GetParam(), "share " + std::to_string(share));
}

TEST_P(AgainstCgal, SkeletonsOfRandomCracksGiveTheSameFacesPlaneByPlane)
{
    // Discs 3 px thick, of random centres and normals.
    Random random(23);
    struct Disc {
        Vec3 centre, normal;
        double radius;
    };
    std::vector<Disc> discs;
    for (int k = 0; k < 12; ++k)
        discs.push_back({{random.uniform(0, 48), random.uniform(0, 40), random.uniform(0, 36)},
                         normalized({random.normal(), random.normal(), random.normal()}),
                         random.uniform(6, 18)});
    const Mask cracks = support::mask_of(Shape{48, 40, 36}, [&](auto x, auto y, auto z) {
        const Vec3 p{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        for (const Disc& d : discs)
            if (std::abs(dot(p - d.centre, d.normal)) < 1.5 && norm(p - d.centre) < d.radius) return true;
        return false;
    });
    expect_equal(skeleton_of_slices(cracks, 2), GetParam(), "cracks");
}

INSTANTIATE_TEST_SUITE_P(Alpha, AgainstCgal, testing::Values(0.75, 0.87, 1.0, 1.5, 2.0, 3.0, 4.0));

}  // namespace
}  // namespace craze::mesh
