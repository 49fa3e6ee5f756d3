// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/local_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/search/kd_tree.h"

namespace scan {
namespace {

LocalPlane fit(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& x,
               std::span<const std::uint32_t> around) {
  LocalPlane plane;
  if (around.size() < 2) return plane;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : around) mean += points[i] - x;
  mean /= static_cast<double>(around.size());
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : around) {
    const Eigen::Vector3d d = points[i] - x - mean;
    moments += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments /
                                                              static_cast<double>(around.size()));
  const Eigen::Vector3d spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  plane.thickness_m = spread[0];
  plane.width_m = spread[1];
  plane.reach_m = (points[around.back()] - x).norm();
  // A line's neighbours fix no plane; eigenvalues are right to 1e-16 of the largest.
  if (spread[1] > 1e-6 * spread[2]) {
    plane.normal = solver.eigenvectors().col(0);
    plane.offset_m = std::abs(plane.normal.dot(mean));
  }
  return plane;
}

}  // namespace

LocalPlanes local_planes(std::span<const Eigen::Vector3d> points, std::size_t neighbours) {
  LocalPlanes all;
  all.neighbours = std::min(neighbours, points.empty() ? 0 : points.size() - 1);
  all.around.resize(points.size() * all.neighbours);
  all.planes.resize(points.size());
  const KdTree tree(points);
  parallel_chunks(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.k_nearest(points[i], all.neighbours + 1, found);
      const std::span<std::uint32_t> around(all.around.data() + i * all.neighbours, all.neighbours);
      std::size_t count = 0;
      for (const Neighbour& n : found)
        if (n.index != i && count < around.size()) around[count++] = n.index;
      all.planes[i] = fit(points, points[i], around);
    }
  });
  return all;
}

}  // namespace scan
