// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/rotation_grid.h"

#include <gtest/gtest.h>

#include "tests/align/test_clouds.h"

namespace scan {
namespace {

Eigen::Quaterniond random_rotation(RandomStream& random) {
  const double w = random.normal(), x = random.normal(), y = random.normal(), z = random.normal();
  return Eigen::Quaterniond(w, x, y, z).normalized();
}

double nearest_rad(const std::vector<Eigen::Quaterniond>& grid, const Eigen::Quaterniond& q) {
  double most = 0;
  for (const Eigen::Quaterniond& one : grid) most = std::max(most, std::abs(one.dot(q)));
  return 2 * std::acos(std::min(1.0, most));
}

// Balls of half-angle a fill SO(3) up to (a - sin a) / pi each, so no grid of n rotations comes
// nearer everywhere than (6 pi / n)^(1/3) = 2.66 n^(-1/3) rad. The spiral stays within 1.6 times
// that.
TEST(RotationGrid, LeavesNoRotationFar) {
  for (const std::size_t count : {100, 1000, 2048}) {
    const auto grid = rotation_grid(count);
    ASSERT_EQ(grid.size(), count);
    double worst = 0;
    for (std::uint64_t k = 0; k < 3000; ++k) {
      RandomStream random(1, 0, k);
      worst = std::max(worst, nearest_rad(grid, random_rotation(random)));
    }
    EXPECT_LT(worst, 1.6 * std::cbrt(6 * std::numbers::pi / double(count))) << count;
  }
}

// Of even spread: the mean of the rotation matrices is zero, and |q . r|^2 averages 1/4 for any r.
TEST(RotationGrid, PrefersNoDirection) {
  const auto grid = rotation_grid(2048);
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  Eigen::Matrix4d second = Eigen::Matrix4d::Zero();
  for (const Eigen::Quaterniond& q : grid) {
    EXPECT_NEAR(q.norm(), 1, 1e-12);
    mean += q.toRotationMatrix() / double(grid.size());
    second += q.coeffs() * q.coeffs().transpose() / double(grid.size());
  }
  // Random rotations would have entries of about 1 / sqrt(3 * 2048) = 0.013; even ones have less.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.005);
  EXPECT_LT((second - Eigen::Matrix4d::Identity() / 4).cwiseAbs().maxCoeff(), 0.005);
}

}  // namespace
}  // namespace scan
