// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/choose_method.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

PointCloud cap(std::size_t count) {
  const PointCloud sphere = sphere_cloud(count);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < sphere.size(); ++i)
    if (sphere.points[i][2] > 0.3) kept.push_back(i);
  return subset(sphere, kept);
}

TEST(ChooseMethod, TakesSsdForAClosedSurface) {
  const MethodChoice choice = choose_method(prepare_points(torus_cloud(10000), {}));
  EXPECT_EQ(choice.method, ReconstructMethod::ssd);
  EXPECT_LT(choice.rim_share, 0.01);
  EXPECT_NE(choice.reason.find("closed"), std::string::npos);
}

// A rim of 2 pi sqrt(0.91) = 6 and a spacing of 0.035: neighbours are short on one side within
// about half their reach of 0.1 / 2, 7 % of the cap's 4.4 at most.
TEST(ChooseMethod, TakesLocalFitsForAnOpenOneAndRaysWhereTheyAreKnown) {
  const PointCloud open = cap(10000);
  const MethodChoice blind = choose_method(prepare_points(open, {}));
  EXPECT_GT(blind.rim_share, 0.02);
  EXPECT_LT(blind.rim_share, 0.07);
  EXPECT_EQ(blind.method, ReconstructMethod::mls);
  std::vector<Eigen::Vector3d> scanners;
  for (const auto& x : open.points) scanners.push_back(3 * x);
  EXPECT_EQ(choose_method(prepare_points(open, scanners)).method, ReconstructMethod::range_fusion);
}

TEST(ChooseMethod, TakesSsdForNoise) {
  PointCloud noisy = cap(10000);
  RandomStream random(5, 0, 0);
  for (auto& x : noisy.points) {
    const double a = random.normal(), b = random.normal(), c = random.normal();
    x += 0.02 * Eigen::Vector3d(a, b, c);
  }
  const MethodChoice choice = choose_method(prepare_points(noisy, {}));
  EXPECT_GT(choice.unflatness, 0.1);
  EXPECT_EQ(choice.method, ReconstructMethod::ssd);
}

TEST(ChooseMethod, IsToldInTheResult) {
  const SurfaceResult result = reconstruct(
      torus_cloud(2000), {}, {.method = ReconstructMethod::automatic, .ssd = {.depth = 5}});
  EXPECT_EQ(result.method, "ssd");
  EXPECT_NE(result.method_reason.find("closed"), std::string::npos);
}

}  // namespace
}  // namespace scan
