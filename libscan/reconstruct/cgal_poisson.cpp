// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cgal_poisson.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <utility>

namespace scan {
namespace {

template <class Point>
Mesh mesh_from_cgal(const CGAL::Surface_mesh<Point>& surface) {
  Mesh mesh;
  std::vector<std::uint32_t> number(surface.num_vertices() + surface.number_of_removed_vertices());
  for (const auto v : surface.vertices()) {
    const Point& x = surface.point(v);
    number[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({x.x(), x.y(), x.z()});
  }
  for (const auto f : surface.faces()) {
    Triangle triangle;
    int corner = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
      triangle[corner++] = number[v];
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

Mesh cgal_poisson(const PointCloud& cloud) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using PointWithNormal = std::pair<Kernel::Point_3, Kernel::Vector_3>;
  CGAL::get_default_random() = CGAL::Random(1);  // else each call starts where the last one ended
  std::vector<PointWithNormal> input;
  input.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d &x = cloud.points[i], &n = cloud.normals[i];
    input.push_back({{x[0], x[1], x[2]}, {n[0], n[1], n[2]}});
  }
  const CGAL::First_of_pair_property_map<PointWithNormal> points;
  const double spacing_m = CGAL::compute_average_spacing<CGAL::Sequential_tag>(
      input, 6, CGAL::parameters::point_map(points));
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  if (!CGAL::poisson_surface_reconstruction_delaunay(
          input.begin(), input.end(), points, CGAL::Second_of_pair_property_map<PointWithNormal>(),
          surface, spacing_m))
    return {};
  return mesh_from_cgal(surface);
}

}  // namespace scan
