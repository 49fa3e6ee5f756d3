// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// The farthest point of meshes where it is known in closed form, and against samples and CGAL.
#include "libscan/verify/hausdorff.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "libscan/search/closest_point.h"
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

Mesh shaken(Mesh mesh, double sigma_m) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    RandomStream random(1, 0, i);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    mesh.vertices[i] += sigma_m * Eigen::Vector3d(x, y, z);
  }
  return mesh;
}

// A square shifted along its normal: both bounds are the shift, since each is one triangle's.
TEST(Hausdorff, OfAShiftedSquareIsTheShift) {
  const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const Interval bounds = hausdorff_m(square, moved(square, {0, 0, 0.01}));
  EXPECT_NEAR(bounds.low, 0.01, 1e-14);
  EXPECT_NEAR(bounds.high, 0.01, 1e-14);
}

// The cube's corner (1, 1), at the distance r = sqrt(1/2) and at 45 degrees from the middle, is
// carried to 45 degrees + t and stands r sin(45 degrees + t) - 1/2 outside.
TEST(Hausdorff, OfATurnedBoxIsThatOfItsCorner) {
  const double t = 0.1;
  const Eigen::Translation3d middle(0.5, 0.5, 0.5);
  const Pose turn(middle * Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()) * middle.inverse());
  const double expected = std::sqrt(0.5) * std::sin(std::numbers::pi / 4 + t) - 0.5;
  const Interval bounds = hausdorff_m(transformed(turn, cube(1)), cube(1), {.widest_share = 1e-3});
  EXPECT_NEAR(bounds.low, expected, 1e-12 * expected);
  EXPECT_GE(bounds.high, bounds.low);
  EXPECT_LE(bounds.high, 1.001 * expected);
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
  const Interval bounds = farthest_distance_m(lid, pit);
  EXPECT_LE(bounds.low, std::sqrt(0.5) * (1 + 1e-14));
  EXPECT_GE(bounds.high, std::sqrt(0.5) * (1 - 1e-14));
  EXPECT_LE(bounds.high, 1.01 * bounds.low);
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
  const Interval bounds = farthest_distance_m(face, crumbs);
  EXPECT_LE(bounds.low, radius * (1 + 1e-8));
  EXPECT_GE(bounds.high, radius * (1 - 1e-8));
  EXPECT_LE(bounds.high, 1.01 * bounds.low);
}

// The bounds hold what samples find, and a budget too small widens them and does not break them.
TEST(Hausdorff, HoldsTheFarthestSample) {
  const Mesh a = shaken(torus(3, 1, 30, 20), 0.05), b = torus(3, 1, 60, 40);
  const MeshSearch search(b);
  double farthest_m = 0;
  for (const SurfaceSample& sample : sample_surface(a, 50'000, 1))
    farthest_m = std::max(farthest_m, search.closest(sample.point).distance_m);
  const Interval bounds = farthest_distance_m(a, b);
  EXPECT_LE(bounds.high, 1.01 * bounds.low * (1 + 1e-12));
  EXPECT_LE(farthest_m, bounds.high);
  EXPECT_GT(bounds.low, 0.8 * farthest_m);
  const Interval hasty = farthest_distance_m(a, b, {.most_queries = 1});
  EXPECT_LE(hasty.low, bounds.low);
  EXPECT_GE(hasty.high, bounds.high);
}

TEST(Hausdorff, RefusesNothing) {
  EXPECT_THROW(hausdorff_m({}, cube(1)), Error);
  EXPECT_THROW(hausdorff_m(cube(1), {}), Error);
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
  const Interval bounds = hausdorff_m(a, b);
  constexpr double bound_m = 1e-4;
  const double cgal_m = pmp::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
      surface_of(a), surface_of(b), bound_m);
  EXPECT_GE(cgal_m, bounds.low - bound_m);
  EXPECT_LE(cgal_m, bounds.high + bound_m);
}
#else
TEST(Hausdorff, AgreesWithCgal) {
  GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
}
#endif

}  // namespace
}  // namespace scan
