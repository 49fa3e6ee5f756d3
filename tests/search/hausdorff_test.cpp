// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The farthest point of meshes where it is known in closed form, and against samples and CGAL.
#include "libscan/search/hausdorff.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "tests/core/meshes.h"

#ifdef LIBSCAN_WITH_CGAL
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#endif

namespace scan {
namespace {

Mesh moved(const Mesh& mesh, const Eigen::Vector3d& by) {
  return transformed(make_pose(Eigen::Matrix3d::Identity(), by), mesh);
}

// The unit square, `cells` a side, at a height that depends on the place.
template <class Height>
Mesh grid(std::uint32_t cells, Height height) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = double(i) / cells, y = double(j) / cells;
      mesh.vertices.push_back({x, y, height(x, y)});
    }
  for (std::uint32_t j = 0; j < cells; ++j)
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = i + (cells + 1) * j, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

double flat(double, double) {
  return 0;
}

// A square shifted along its normal: both bounds are the shift, since each is one triangle's.
TEST(Hausdorff, OfAShiftedSquareIsTheShift) {
  const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const DistanceBounds bounds = hausdorff_distance(square, moved(square, {0, 0, 0.01}));
  EXPECT_NEAR(bounds.low_m, 0.01, 1e-14);
  EXPECT_NEAR(bounds.high_m, 0.01, 1e-14);
}

// The cube's corner (1, 1), at the distance r = sqrt(1/2) and at 45 degrees from the middle, is
// carried to 45 degrees + t and stands r sin(45 degrees + t) - 1/2 outside.
TEST(Hausdorff, OfATurnedBoxIsThatOfItsCorner) {
  const double t = 0.1;
  const Eigen::Translation3d middle(0.5, 0.5, 0.5);
  const Pose turn(middle * Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()) * middle.inverse());
  const double expected = std::sqrt(0.5) * std::sin(std::numbers::pi / 4 + t) - 0.5;
  const DistanceBounds bounds =
      hausdorff_distance(transformed(turn, cube(1)), cube(1), {.widest_share = 1e-3});
  EXPECT_NEAR(bounds.low_m, expected, 1e-12 * expected);
  EXPECT_GE(bounds.high_m, bounds.low_m);
  EXPECT_LE(bounds.high_m, 1.001 * expected);
}

// The farthest point is inside a triangle, where no vertex is: a square over a pit with the depth 1
// at its middle and walls of 45 degrees, so the nearest wall is 1 / sqrt(2) from above the pit.
TEST(Hausdorff, FindsAPointWithinATriangle) {
  const Mesh lid{{{-2, -1, 0}, {2, -1, 0}, {0, 3, 0}}, {{0, 1, 2}}};
  Mesh pit{
      {{-1, -9, 0},
       {-1, 9, 0},
       {0, -9, -1},
       {0, 9, -1},
       {1, -9, 0},
       {1, 9, 0},
       {-9, -9, 0},
       {-9, 9, 0},
       {9, -9, 0},
       {9, 9, 0}},
      {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}, {6, 0, 1}, {6, 1, 7}, {4, 8, 5}, {5, 8, 9}}};
  const DistanceBounds bounds = farthest_distance(lid, pit);
  EXPECT_LE(bounds.low_m, std::sqrt(0.5) * (1 + 1e-14));
  EXPECT_GE(bounds.high_m, std::sqrt(0.5) * (1 - 1e-14));
  EXPECT_LE(bounds.high_m, 1.01 * bounds.low_m);
}

// Of a triangle with three crumbs at its corners the middle is farthest, the circle's radius away.
TEST(Hausdorff, FindsTheMiddleOfATriangle) {
  const Mesh face{{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}, {{0, 1, 2}}};
  Mesh crumbs;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& at = face.vertices[k];
    for (const Eigen::Vector3d& by : {Eigen::Vector3d(0, 0, 0), {1e-9, 0, 0}, {0, 1e-9, 0}})
      crumbs.vertices.push_back(at + by);
    crumbs.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const double radius = 1 / std::numbers::sqrt3;
  const DistanceBounds bounds = farthest_distance(face, crumbs);
  EXPECT_LE(bounds.low_m, radius * (1 + 1e-8));
  EXPECT_GE(bounds.high_m, radius * (1 - 1e-8));
  EXPECT_LE(bounds.high_m, 1.01 * bounds.low_m);
}

// The bounds hold what samples find, and a budget too small widens them and does not break them.
TEST(Hausdorff, HoldsTheFarthestSample) {
  const Mesh a = shaken(torus(3, 1, 30, 20), 0.05), b = torus(3, 1, 60, 40);
  const MeshSearch search(b);
  double farthest_m = 0;
  for (const SurfaceSample& sample : sample_surface(a, 50'000, 1))
    farthest_m = std::max(farthest_m, search.closest(sample.point).distance_m);
  const DistanceBounds bounds = farthest_distance(a, b);
  EXPECT_LE(bounds.high_m, 1.01 * bounds.low_m * (1 + 1e-12));
  EXPECT_LE(farthest_m, bounds.high_m);
  EXPECT_GT(bounds.low_m, 0.8 * farthest_m);
  const DistanceBounds hasty = farthest_distance(a, b, {.most_queries = 1});
  EXPECT_LE(hasty.low_m, bounds.low_m);
  EXPECT_GE(hasty.high_m, bounds.high_m);
}

// With a limit only what it asks is done, and what it answers is proven. Pieces that lie across a
// seam of the other mesh see one of its triangles from as far to the side as they are wide.
TEST(Hausdorff, WithinALimitIsExactBetweenParallelSquares) {
  const Mesh coarse = grid(1, flat);
  const Mesh fine = grid(9, [](double, double) { return 0.1; });
  const double limit_m = 0.1 + 4e-7;
  const DistanceBounds within =
      hausdorff_distance(coarse, fine, {.limit_m = limit_m, .most_queries = 10'000'000});
  EXPECT_NEAR(within.high_m, 0.1, 4e-7);
  EXPECT_LE(within.high_m, limit_m);
  EXPECT_NEAR(within.low_m, 0.1, 1e-15);
  EXPECT_TRUE(std::isinf(hausdorff_distance(coarse, fine, {.limit_m = 0.1 - 1e-12}).high_m));
}

// No vertex of the flat square is farther than the sides of the pyramid; its middle is 0.5 below.
TEST(Hausdorff, WithinALimitSeesWhatNoVertexShows) {
  const Mesh sheet = grid(1, flat);
  const Mesh bump = grid(2, [](double x, double y) { return x == 0.5 && y == 0.5 ? 0.5 : 0; });
  EXPECT_GT(farthest_distance(sheet, bump, {.limit_m = 0.2}).high_m, 0.2);
  EXPECT_GT(farthest_distance(bump, sheet, {.limit_m = 0.499}).high_m, 0.499);
  EXPECT_LE(farthest_distance(bump, sheet, {.limit_m = 0.501}).high_m, 0.501);
}

// Never below what samples show, and proven where the limit leaves it a hundredth.
TEST(Hausdorff, WithinALimitHoldsForSamplesOfRoughSurfaces) {
  RandomStream random(1, 0, 0);
  const auto rough = [&](double, double) { return 0.05 * random.uniform(); };
  const Mesh a = grid(6, rough), b = grid(5, rough);
  const MeshSearch search(b);
  double largest_m = 0;
  for (const SurfaceSample& s : sample_surface(a, 200'000, 1))
    largest_m = std::max(largest_m, search.closest(s.point).distance_m);
  EXPECT_GT(farthest_distance(a, b, {.limit_m = largest_m}).high_m, largest_m);
  const DistanceBounds within = farthest_distance(a, b, {.limit_m = 1.01 * largest_m});
  EXPECT_LE(within.high_m, 1.01 * largest_m);
  EXPECT_GE(within.high_m, largest_m);
  EXPECT_LE(within.low_m, within.high_m);
}

TEST(Hausdorff, RefusesNothing) {
  EXPECT_THROW(hausdorff_distance({}, cube(1)), Error);
  EXPECT_THROW(hausdorff_distance(cube(1), {}), Error);
}

#ifdef LIBSCAN_WITH_CGAL
using Surface = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;

Surface surface_of(const Mesh& mesh) {
  Surface surface;
  for (const Eigen::Vector3d& v : mesh.vertices) surface.add_vertex({v.x(), v.y(), v.z()});
  for (const Triangle& t : mesh.triangles)
    surface.add_face(Surface::Vertex_index(t[0]), Surface::Vertex_index(t[1]),
                     Surface::Vertex_index(t[2]));
  return surface;
}

// CGAL's value is within its bound of the true one, ours within the interval.
TEST(Hausdorff, AgreesWithCgal) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  const Mesh a = shaken(torus(3, 1, 30, 20), 0.05), b = torus(3, 1, 30, 20);
  const DistanceBounds bounds = hausdorff_distance(a, b);
  constexpr double bound_m = 1e-4;
  const double cgal_m = pmp::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
      surface_of(a), surface_of(b), bound_m);
  EXPECT_GE(cgal_m, bounds.low_m - bound_m);
  EXPECT_LE(cgal_m, bounds.high_m + bound_m);
}
#else
TEST(Hausdorff, AgreesWithCgal) {
  GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
}
#endif

}  // namespace
}  // namespace scan
