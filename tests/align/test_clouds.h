// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Clouds with a known pose for the tests of alignment.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "libscan/core/point_cloud.h"
#include "libscan/core/random.h"
#include "libscan/core/units.h"
#include "libscan/search/kd_tree.h"

namespace scan::test {

using Eigen::Vector3d;

inline Vector3d random_direction(RandomStream& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

inline Pose random_pose(RandomStream& random, double angle_rad, double shift_m) {
  const Vector3d axis = random_direction(random), shift = shift_m * random_direction(random);
  return make_pose(Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix(), shift);
}

// Normals by a plane fit over 16 neighbours, turned towards `towards`.
inline void estimate_normals(PointCloud& cloud, const std::function<Vector3d(const Vector3d&)>& towards) {
  const KdTree tree(cloud.points);
  cloud.normals.clear();
  std::vector<Neighbour> found;
  for (const Vector3d& x : cloud.points) {
    tree.k_nearest(x, 16, found);
    Vector3d mean = Vector3d::Zero();
    for (const Neighbour& n : found) mean += cloud.points[n.index] / double(found.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Neighbour& n : found)
      covariance += (cloud.points[n.index] - mean) * (cloud.points[n.index] - mean).transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Vector3d normal = solver.eigenvectors().col(0);
    cloud.normals.push_back(normal.dot(towards(x)) < 0 ? Vector3d(-normal) : normal);
  }
}

// A height field with bumps of several sizes, extent 2 x 2 m, and its exact normals: every motion is
// fixed by it.
inline PointCloud bumpy_surface(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1;
    const double z = 0.3 * std::sin(2.1 * x + 0.4) * std::cos(1.7 * y) + 0.2 * x * y +
                     0.05 * std::sin(5 * x) * std::sin(6 * y + 1);
    const double dx = 0.63 * std::cos(2.1 * x + 0.4) * std::cos(1.7 * y) + 0.2 * y +
                      0.25 * std::cos(5 * x) * std::sin(6 * y + 1);
    const double dy = -0.51 * std::sin(2.1 * x + 0.4) * std::sin(1.7 * y) + 0.2 * x +
                      0.3 * std::sin(5 * x) * std::cos(6 * y + 1);
    cloud.points.emplace_back(x, y, z);
    cloud.normals.push_back(Vector3d(-dx, -dy, 1).normalized());
  }
  return cloud;
}

// A cloud shared out at random into two that have no point in common.
inline std::pair<PointCloud, PointCloud> split(const PointCloud& cloud, std::uint64_t seed) {
  RandomStream random(seed, 1, 0);
  std::vector<std::uint32_t> a, b;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) (random.uniform() < 0.5 ? a : b).push_back(i);
  return {subset(cloud, a), subset(cloud, b)};
}

inline void add_noise(PointCloud& cloud, double sigma_m, std::uint64_t seed) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    RandomStream random(seed, 2, i);
    cloud.points[i] += sigma_m * Vector3d(random.normal(), random.normal(), random.normal());
  }
}

}  // namespace scan::test
