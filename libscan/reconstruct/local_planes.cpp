// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/local_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/search/batch.h"
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

// Neighbours and planes of the points that are `chosen`, in this order.
void fit_planes(std::span<const Eigen::Vector3d> points, std::span<const std::uint32_t> chosen,
                LocalPlanes& all) {
  if (chosen.empty()) return;
  const KdTree tree(points);
  parallel_chunks(chosen.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> found;
    for (const std::uint32_t i : chosen.subspan(begin, end - begin)) {
      tree.k_nearest(points[i], all.neighbours + 1, found);
      const std::span<std::uint32_t> around(all.around.data() + i * all.neighbours, all.neighbours);
      std::size_t count = 0;
      for (const Neighbour& n : found)
        if (n.index != i && count < around.size()) around[count++] = n.index;
      all.planes[i] = fit(points, points[i], around);
    }
  });
}

LocalPlanes unfitted(std::size_t points, std::size_t neighbours) {
  LocalPlanes all;
  all.neighbours = std::min(neighbours, points == 0 ? 0 : points - 1);
  all.around.resize(points * all.neighbours);
  all.planes.resize(points);
  return all;
}

}  // namespace

LocalPlanes local_planes(std::span<const Eigen::Vector3d> points, std::size_t neighbours) {
  LocalPlanes all = unfitted(points.size(), neighbours);
  fit_planes(points, curve_order(points), all);
  return all;
}

LocalPlanes remaining_planes(const LocalPlanes& all, std::span<const Eigen::Vector3d> points,
                             std::span<const std::uint32_t> kept) {
  constexpr std::uint32_t gone = 0xffffffffu;
  LocalPlanes left = unfitted(kept.size(), all.neighbours);
  if (left.neighbours < all.neighbours) return local_planes(points, all.neighbours);
  std::vector<std::uint32_t> index_of(all.planes.size(), gone), bereft;
  for (std::uint32_t i = 0; i < kept.size(); ++i) index_of[kept[i]] = i;
  for (std::uint32_t i = 0; i < kept.size(); ++i) {
    const auto around = std::span(all.around).subspan(kept[i] * all.neighbours, all.neighbours);
    const auto to = left.around.begin() + static_cast<std::ptrdiff_t>(i * all.neighbours);
    std::transform(around.begin(), around.end(), to, [&](std::uint32_t n) { return index_of[n]; });
    left.planes[i] = all.planes[kept[i]];
    if (std::find(to, to + static_cast<std::ptrdiff_t>(all.neighbours), gone) !=
        to + static_cast<std::ptrdiff_t>(all.neighbours))
      bereft.push_back(i);
  }
  fit_planes(points, bereft, left);
  return left;
}

}  // namespace scan
