// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "libscan/align/icp.h"
#include "tests/align/icp_methods.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

// A box of 2 x 1.5 x 1 m, with noise of 5 mm.
PointCloud box(std::uint64_t seed) {
  const Eigen::Vector3d half(1, 0.75, 0.5);
  PointCloud cloud;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(seed, 0, i);
    Eigen::Vector3d x;
    for (double& u : x) u = 2 * random.uniform() - 1;
    // Faces by their areas, 1.5, 2 and 3 of 6.5.
    const double face = 6.5 * random.uniform();
    const Eigen::Index axis = face < 1.5 ? 0 : face < 3.5 ? 1 : 2;
    x[axis] = x[axis] < 0 ? -1 : 1;
    cloud.points.push_back(half.cwiseProduct(x));
    for (double& u : cloud.points.back()) u += 0.005 * random.normal();
  }
  return cloud;
}

std::pair<PreparedCloud, PreparedCloud> two_scans(std::uint64_t seed) {
  return prepare_pair(box(2 * seed), box(2 * seed + 1));
}

Pose shift_m(RandomStream& random, double distance_m) {
  return make_pose(Eigen::Matrix3d::Identity(), distance_m * test::random_direction(random));
}

bool is_home(const IcpResult& result) {
  return result.target_from_source.isApprox(Pose::Identity(), 0.01);
}

// Shifted by more than half of its size, most of a body's points lie over nothing, and those that
// know the way pass no gate: closed gates bring home two to eight of twenty. With a chance of 0.4
// for each, 13 or more would come home twice in a hundred times; with one of 0.9, fewer than 13
// twice in ten thousand.
TEST(Approach, BringsHomeWhatTheGatesKeepAway) {
  for (const IcpMethod method :
       {IcpMethod::point_to_plane, IcpMethod::symmetric, IcpMethod::plane_to_plane}) {
    RandomStream random(1, 0, 0);
    int home = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto [source, target] = two_scans(seed);
      const IcpResult result = icp(source, target, shift_m(random, 1.5), {.method = method});
      if (!is_home(result)) continue;
      ++home;
      // The gates are closed again: from home it is the same pairs that count.
      const IcpResult again = icp(source, target, result.target_from_source, {.method = method});
      EXPECT_NEAR(double(again.pairs), double(result.pairs), 0.01 * double(again.pairs));
    }
    EXPECT_GE(home, 13) << name_of(method);
  }
}

// A floor and a wall of 2 x 1 m that three ribs stiffen, with noise of 5 mm.
PointCloud stiffened_angle(std::uint64_t seed) {
  PointCloud cloud;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    RandomStream random(seed, 0, i);
    const double part = 6 * random.uniform(), u = random.uniform(), v = random.uniform();
    const double along = 2 * u - 1;
    if (part < 4)
      cloud.points.push_back(part < 2 ? Eigen::Vector3d(along, v, 0)
                                      : Eigen::Vector3d(along, 0, v));
    else
      cloud.points.emplace_back(part < 4.7 ? -0.6 : part < 5.4 ? 0.1 : 0.5, 0.8 * u, 0.8 * v);
    for (double& x : cloud.points.back()) x += 0.005 * random.normal();
  }
  return cloud;
}

// Slid along floor and wall the scans lie on each other as smoothly as at home; the ribs
// contradict. With a chance of 0.1 for each (left alone, none comes home) 7 or more would come home
// twice in a thousand times; with one of a half, fewer than 7 in six of a hundred.
TEST(Approach, LeavesARestThatPointsContradict) {
  RandomStream random(3, 0, 0);
  int home = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto [source, target] =
        prepare_pair(stiffened_angle(2 * seed), stiffened_angle(2 * seed + 1));
    const double off_m = (random.uniform() < 0.5 ? -1 : 1) * (0.2 + 0.2 * random.uniform());
    const Pose guess = make_pose(Eigen::Matrix3d::Identity(), {off_m, 0, 0});
    home += is_home(icp(source, target, guess));
  }
  EXPECT_GE(home, 7);
}

// What lies on the target as its own points do is left where it is: the iterations are those of
// one descent, and of that alone the history tells.
TEST(Approach, LeavesASmoothRestAlone) {
  RandomStream random(2, 0, 0);
  int home = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto [source, target] = test::split(test::bumpy_surface(4000, seed), seed);
    test::add_noise(source, 0.005, 2 * seed);
    test::add_noise(target, 0.005, 2 * seed + 1);
    const IcpResult result = icp(source, target, shift_m(random, 0.5));
    if (!is_home(result)) continue;
    ++home;
    EXPECT_EQ(result.history.size(), std::size_t(result.iterations));
  }
  EXPECT_GE(home, 5);
}

}  // namespace
}  // namespace scan
