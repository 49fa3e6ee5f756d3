// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Point-to-mesh distances, which every surface error rests on, against CGAL's tree.
#include <gtest/gtest.h>

#ifdef LIBSCAN_WITH_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "libscan/core/random.h"
#include "libscan/search/closest_point.h"
#include "tests/core/meshes.h"

namespace scan {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

// A torus whose vertices are shaken, so that no symmetry helps either side.
Mesh shaken_torus() {
  Mesh mesh = torus(3, 1, 60, 40);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    RandomStream random(1, 0, i);
    for (int k = 0; k < 3; ++k) mesh.vertices[i](k) += 0.1 * random.normal();
  }
  return mesh;
}

// Both compute in double with coordinates of size 10: some tens of roundings of 2e-15.
TEST(MeshSearch, AgreesWithCgal) {
  const Mesh mesh = shaken_torus();
  Triangles triangles;
  const auto point = [&](std::uint32_t v) {
    const Eigen::Vector3d& x = mesh.vertices[v];
    return Kernel::Point_3(x.x(), x.y(), x.z());
  };
  for (const Triangle& t : mesh.triangles)
    triangles.emplace_back(point(t[0]), point(t[1]), point(t[2]));
  const Tree tree(triangles.begin(), triangles.end());
  const MeshSearch search(mesh);
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    RandomStream random(2, 0, i);
    const double reach = i % 2 == 0 ? 5 : 3.5;
    const Eigen::Vector3d x(reach * random.normal(), reach * random.normal(), random.normal());
    const double expected = std::sqrt(tree.squared_distance({x.x(), x.y(), x.z()}));
    const ClosestPoint found = search.closest(x);
    ASSERT_NEAR(found.distance_m, expected, 1e-13);
    ASSERT_NEAR((found.point - x).norm(), found.distance_m, 1e-14);
  }
}

}  // namespace
}  // namespace scan
#else
TEST(MeshSearch, AgreesWithCgal) {
  GTEST_SKIP() << "built with LIBSCAN_WITH_CGAL=OFF";
}
#endif
