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
  EXPECT_LT(choice.rim_extent, 0.1);
  EXPECT_NE(choice.reason.find("closed"), std::string::npos);
}

// The rim is the circle of radius sqrt(0.91) that bounds the cap, whose box is higher by 0.7.
TEST(ChooseMethod, TakesLocalFitsForAnOpenOneAndRaysWhereTheyAreKnown) {
  const PointCloud open = cap(10000);
  const MethodChoice blind = choose_method(prepare_points(open, {}));
  EXPECT_NEAR(blind.rim_extent, 1, 0.1);
  EXPECT_EQ(blind.method, ReconstructMethod::mls);
  std::vector<Eigen::Vector3d> scanners;
  for (const auto& x : open.points) scanners.push_back(3 * x);
  EXPECT_EQ(choose_method(prepare_points(open, scanners)).method, ReconstructMethod::range_fusion);
}

TEST(ChooseMethod, TellsAnEndFromHolesAtAnyDensity) {
  for (const std::size_t count : {3000u, 30000u, 100000u}) {
    SCOPED_TRACE(count);
    EXPECT_EQ(choose_method(prepare_points(cap(count), {})).method, ReconstructMethod::mls);
    const PointCloud whole = sphere_cloud(count);
    std::vector<std::uint32_t> kept;  // without six caps of half-angle 0.3
    for (std::uint32_t i = 0; i < whole.size(); ++i)
      if (whole.points[i].cwiseAbs().maxCoeff() < std::cos(0.3)) kept.push_back(i);
    const MethodChoice holes = choose_method(prepare_points(subset(whole, kept), {}));
    EXPECT_EQ(holes.method, ReconstructMethod::ssd);
    // A circle's box over the cube's, 2 sqrt(2) sin(0.3) / (2 sqrt(3)) = 0.24; points that look
    // like rims by chance lengthen it by up to two reaches a side, 0.36 of 3.5 for 3,000.
    EXPECT_GT(holes.rim_extent, 0.2);
    EXPECT_LT(holes.rim_extent, 0.24 + 0.2);
  }
}

TEST(ChooseMethod, TakesSsdForNoise) {
  PointCloud noisy = cap(10000);
  RandomStream random(5, 0, 0);
  for (auto& x : noisy.points) {
    const double a = random.normal(), b = random.normal(), c = random.normal();
    x += 0.02 * Eigen::Vector3d(a, b, c);
  }
  const MethodChoice choice = choose_method(prepare_points(noisy, {}));
  EXPECT_GT(choice.unflatness, 0.25);
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
