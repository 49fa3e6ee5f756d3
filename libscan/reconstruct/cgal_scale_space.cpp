// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/cgal_scale_space.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Scale_space_reconstruction_3/Jet_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>

#include "libscan/reconstruct/advancing_front.h"

namespace scan {

Mesh cgal_scale_space(std::span<const Eigen::Vector3d> points, int smoothings) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const auto& x : points) input.emplace_back(x[0], x[1], x[2]);
  CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruction(input.begin(), input.end());
  reconstruction.increase_scale(
      smoothings, CGAL::Scale_space_reconstruction_3::Jet_smoother<Kernel, CGAL::Sequential_tag>());
  std::vector<Eigen::Vector3d> smoothed;
  smoothed.reserve(points.size());
  for (auto x = reconstruction.points_begin(); x != reconstruction.points_end(); ++x)
    smoothed.emplace_back(x->x(), x->y(), x->z());
  Mesh mesh = advancing_front(smoothed);
  mesh.vertices.assign(points.begin(), points.end());
  return mesh;
}

}  // namespace scan
