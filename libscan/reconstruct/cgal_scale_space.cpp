// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cgal_scale_space.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Scale_space_reconstruction_3/Advancing_front_mesher.h>
#include <CGAL/Scale_space_reconstruction_3/Jet_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>

namespace scan {

Mesh cgal_scale_space(std::span<const Eigen::Vector3d> points, int smoothings) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::get_default_random() = CGAL::Random(1);  // else each call starts where the last one ended
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const auto& x : points) input.emplace_back(x[0], x[1], x[2]);
  CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruction(input.begin(), input.end());
  reconstruction.increase_scale(
      smoothings, CGAL::Scale_space_reconstruction_3::Jet_smoother<Kernel, CGAL::Sequential_tag>());
  reconstruction.reconstruct_surface(
      CGAL::Scale_space_reconstruction_3::Advancing_front_mesher<Kernel>());
  Mesh mesh;
  mesh.vertices.assign(points.begin(), points.end());
  for (auto f = reconstruction.facets_begin(); f != reconstruction.facets_end(); ++f)
    mesh.triangles.push_back({static_cast<std::uint32_t>((*f)[0]),
                              static_cast<std::uint32_t>((*f)[1]),
                              static_cast<std::uint32_t>((*f)[2])});
  return mesh;
}

}  // namespace scan
