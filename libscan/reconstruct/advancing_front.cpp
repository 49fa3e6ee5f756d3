// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/advancing_front.h"

#include <iterator>

#include "libscan/reconstruct/front_triangulation.h"

namespace scan {

Mesh advancing_front(std::span<const Eigen::Vector3d> points) {
  std::vector<std::pair<FrontKernel::Point_3, std::size_t>> input;
  for (const auto& x : points) input.push_back({{x[0], x[1], x[2]}, input.size()});
  FrontTriangulation triangulation(input.begin(), input.end());
  CGAL::Advancing_front_surface_reconstruction<FrontTriangulation> front(triangulation);
  front.run();
  std::vector<std::array<std::size_t, 3>> faces;
  CGAL::write_triple_indices(std::back_inserter(faces), front);
  Mesh mesh;
  mesh.vertices.assign(points.begin(), points.end());
  for (const auto& face : faces)
    mesh.triangles.push_back({static_cast<std::uint32_t>(face[0]),
                              static_cast<std::uint32_t>(face[1]),
                              static_cast<std::uint32_t>(face[2])});
  return mesh;
}

}  // namespace scan
