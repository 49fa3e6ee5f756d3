// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_poses.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/align/test_clouds.h"

namespace scan {
namespace {

constexpr double noise_m = 1e-3;

// A floor of 2 m x 2 m and two low walls across it, one along each axis, 1000 points to the square
// metre; each point is off along its surface's normal.
PointCloud floor_with_walls(std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  PointCloud cloud;
  const auto add = [&](const Eigen::Vector3d& x, const Eigen::Vector3d& normal) {
    cloud.points.push_back(x + noise_m * random.normal() * normal);
    cloud.normals.push_back(normal);
  };
  for (int i = 0; i < 4000; ++i)
    add({2 * random.uniform() - 1, 2 * random.uniform() - 1, 0}, Eigen::Vector3d::UnitZ());
  for (int i = 0; i < 400; ++i) {
    const double along_m = 2 * random.uniform() - 1, height_m = 0.2 * random.uniform();
    if (i % 2 == 0)
      add({0.3, along_m, height_m}, Eigen::Vector3d::UnitX());
    else
      add({along_m, -0.4, height_m}, Eigen::Vector3d::UnitY());
  }
  return cloud;
}

// The second scan starts slid along the floor, the first being the anchor.
struct Slid {
  PreparedScans scans;
  std::vector<Pose> should, starts;
};

Slid slid(std::uint64_t seed, double way_m) {
  Slid made;
  for (const std::uint64_t scan : {0u, 1u}) {
    made.scans.clouds.push_back(prepare(floor_with_walls(2 * seed + scan)));
    made.scans.tolerance_m.push_back(3 * noise_m);
    made.should.push_back(Pose(Eigen::Translation3d(made.scans.clouds.back().origin)));
  }
  made.starts = made.should;
  made.starts[1] = Eigen::Translation3d(way_m, -way_m, 0) * made.starts[1];
  return made;
}

// The walls, a tenth of the points, hold the slides; 25 sigmas off they lie eight scales of the
// first loss beyond the floor's residuals. A start of known error is pulled home and knows its own
// error: e^T C^-1 e of six coordinates is below 22.46 in 99.9 % of cases. Without, nothing holds
// the slides and it stays.
TEST(RefineJointly, WallsPullAsFarAsTheStartsAreOff) {
  const double way_m = 25 * noise_m;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Slid s = slid(seed, way_m);
    const auto from = [&](double off_m) {
      return refine_jointly(s.scans, s.starts, s.starts, {true, true}, 0, off_m, {}, {});
    };
    const JointPoses found = from(way_m);
    ASSERT_TRUE(found.scans[1].covariance);
    const Eigen::Translation3d centre(found.world_from_local[1].translation());
    const Vector6 off =
        log(Pose(centre.inverse() * found.world_from_local[1] * s.should[1].inverse() * centre));
    EXPECT_LT(off.dot(found.scans[1].covariance->inverse() * off), 22.46);
    const Eigen::Vector3d left =
        from(0).world_from_local[1].translation() - s.should[1].translation();
    EXPECT_GT(left.head<2>().norm(), 0.5 * way_m);
  }
}

}  // namespace
}  // namespace scan
