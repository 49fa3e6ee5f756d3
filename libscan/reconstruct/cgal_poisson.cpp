// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cgal_poisson.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/facets_in_complex_2_to_triangle_mesh.h>
#include <CGAL/Implicit_surface_3.h>
#include <CGAL/Poisson_reconstruction_function.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_default_criteria_3.h>
#include <CGAL/Surface_mesh_default_triangulation_3.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/make_surface_mesh.h>
#include <CGAL/property_map.h>

#include <cmath>
#include <utility>

#include "libscan/reconstruct/numbered.h"

namespace scan {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Function = CGAL::Poisson_reconstruction_function<Kernel>;
using MeshKernel = CGAL::Robust_circumcenter_traits_3<Kernel>;
// As CGAL's own, but numbered: by addresses no two surfaces are the same.
using Elements = CGAL::Triangulation_data_structure_3<
    Numbered<CGAL::Surface_mesh_vertex_base_3<MeshKernel>>,
    Numbered<CGAL::Delaunay_triangulation_cell_base_with_circumcenter_3<
        MeshKernel, CGAL::Surface_mesh_cell_base_3<MeshKernel>>>>;
using Triangulation = CGAL::Delaunay_triangulation_3<MeshKernel, Elements>;

// CGAL's default settings, by the points' spacing; a place on the surface is found to a thousandth
// of what its facets may be off.
constexpr double least_angle_deg = 20;
constexpr double largest_facet_spacings = 30;
constexpr double farthest_facet_spacings = 0.375;
constexpr double bounds_sizes = 5;  // the sphere that holds the surface, by the points' own

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

// The zero level set of the function.
Mesh level_set(Function& function, double spacing_m) {
  const double bounds_m = bounds_sizes * std::sqrt(function.bounding_sphere().squared_radius());
  const double farthest_m = farthest_facet_spacings * spacing_m;
  const CGAL::Implicit_surface_3<Kernel, Function> surface(
      function, Kernel::Sphere_3(function.get_inner_point(), bounds_m * bounds_m),
      farthest_m / 1000 / bounds_m);
  Triangulation triangulation;
  CGAL::Surface_mesh_complex_2_in_triangulation_3<Triangulation> facets(triangulation);
  CGAL::make_surface_mesh(facets, surface,
                          CGAL::Surface_mesh_default_criteria_3<Triangulation>(
                              least_angle_deg, largest_facet_spacings * spacing_m, farthest_m),
                          CGAL::Manifold_with_boundary_tag());
  if (triangulation.number_of_vertices() == 0) return {};
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
  CGAL::facets_in_complex_2_to_triangle_mesh(facets, mesh);
  return mesh_from_cgal(mesh);
}

}  // namespace

Mesh cgal_poisson(const PointCloud& cloud) {
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
  Function function(input.begin(), input.end(), points,
                    CGAL::Second_of_pair_property_map<PointWithNormal>());
  return function.compute_implicit_function() ? level_set(function, spacing_m) : Mesh();
}

}  // namespace scan
