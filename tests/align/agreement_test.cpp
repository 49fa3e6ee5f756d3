// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/agreement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/random.h"

namespace scan {
namespace {

// A wavy sheet of 1 m x 1 m, sampled anew for each seed, with noise along z.
PointCloud sheet(std::uint64_t seed, double noise_m) {
  PointCloud cloud;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    RandomStream random(seed, 0, i);
    const double x = random.uniform(), y = random.uniform();
    const double z = 0.1 * std::sin(6 * x) * std::cos(5 * y) + noise_m * random.normal();
    const Eigen::Vector3d slope(-0.6 * std::cos(6 * x) * std::cos(5 * y),
                                0.5 * std::sin(6 * x) * std::sin(5 * y), 1);
    cloud.points.emplace_back(x, y, z);
    cloud.normals.push_back(slope.normalized());
  }
  return cloud;
}

double agreeing_when_lifted(double lift_m, double noise_m) {
  const PreparedCloud a = prepare(sheet(1, noise_m)), b = prepare(sheet(2, noise_m));
  const auto posed = [&](const PreparedCloud& cloud, double z_m) {
    return PosedScan{&cloud,
                     Pose(Eigen::Translation3d(cloud.origin + z_m * Eigen::Vector3d::UnitZ())),
                     tolerated_residual_m(cloud, noise_m)};
  };
  const PosedScan other = posed(b, lift_m);
  return agreement(posed(a, 0), {&other, 1}, 0.1).agreeing;
}

// Two samples of one surface with equal noise differ by sqrt(2) sigma; three sigma of one are 2.1
// of the difference, which hold 96.6 %; the sampling of 1024 points adds 0.6 % (one sigma).
TEST(Agreement, HoldsForTwoScansOfOneSurface) {
  EXPECT_GT(agreeing_when_lifted(0, 0.002), 0.94);
  EXPECT_GT(agreeing_when_lifted(0, 0), 0.94);
}

// Five sigma off, next to no point is within three sigma: P(|5 + sqrt(2) z| < 3) = 7.9 % at the
// most.
TEST(Agreement, IsLostByAMotionBeyondTheNoise) {
  EXPECT_LT(agreeing_when_lifted(0.015, 0.002), 0.1);
}

TEST(Agreement, IsNoneWithoutCommonSurface) {
  EXPECT_EQ(agreeing_when_lifted(5, 0.002), 0);
}

}  // namespace
}  // namespace scan
