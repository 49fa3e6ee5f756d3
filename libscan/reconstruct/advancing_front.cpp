// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/advancing_front.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>

#include <iterator>

namespace scan {

Mesh advancing_front(std::span<const Eigen::Vector3d> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::get_default_random() = CGAL::Random(1);  // else each call starts where the last one ended
  std::vector<Kernel::Point_3> input;
  for (const auto& x : points) input.emplace_back(x[0], x[1], x[2]);
  std::vector<std::array<std::size_t, 3>> faces;
  CGAL::advancing_front_surface_reconstruction(input.begin(), input.end(),
                                               std::back_inserter(faces));
  Mesh mesh;
  mesh.vertices.assign(points.begin(), points.end());
  for (const auto& face : faces)
    mesh.triangles.push_back({static_cast<std::uint32_t>(face[0]),
                              static_cast<std::uint32_t>(face[1]),
                              static_cast<std::uint32_t>(face[2])});
  return mesh;
}

}  // namespace scan
