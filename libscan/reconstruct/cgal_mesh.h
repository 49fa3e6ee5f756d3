// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// CGAL's halfedge mesh as a plain one; for the units of libscan::cgal.
#pragma once

#include <CGAL/Surface_mesh.h>

#include "libscan/core/mesh.h"

namespace scan {

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

}  // namespace scan
