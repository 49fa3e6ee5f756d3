// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// CGAL's Hausdorff distance of bounded error.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>

#include "tests/benchmarks/metrics_peers.h"

namespace scan {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

Surface surface_of(const Mesh& mesh) {
  Surface surface;
  for (const Eigen::Vector3d& v : mesh.vertices)
    surface.add_vertex(Kernel::Point_3(v.x(), v.y(), v.z()));
  for (const Triangle& t : mesh.triangles)
    surface.add_face(Surface::Vertex_index(t[0]), Surface::Vertex_index(t[1]),
                     Surface::Vertex_index(t[2]));
  return surface;
}

}  // namespace

double cgal_hausdorff_m(const MetricsCase& of, double bound_m) {
  return CGAL::Polygon_mesh_processing::bounded_error_symmetric_Hausdorff_distance<
      CGAL::Sequential_tag>(surface_of(of.measured), surface_of(of.truth), bound_m);
}

}  // namespace scan
