// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/observability.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

struct Found {
  TwistBasis weak;
  std::vector<std::string> names;
};

Found weak_of(const PointCloud& cloud, bool with_normals) {
  std::vector<std::uint32_t> all(cloud.size());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<LocalFit> fits = local_fits(cloud.points, KdTree(cloud.points), 16);
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& x : cloud.points) mean += x / double(cloud.size());
  double sum2 = 0;
  for (const Vector3d& x : cloud.points) sum2 += (x - mean).squaredNorm();
  const DataFrame frame{mean, std::sqrt(sum2 / double(cloud.size()))};
  const std::span<const Vector3d> none;
  Found found;
  found.weak = weak_motions(all, cloud.points, with_normals ? cloud.normals : none, fits, frame);
  found.names = name_motions(found.weak, frame, Vector3d::Zero());
  return found;
}

struct Case {
  const char* name;
  PointCloud cloud;
  int weak;
};

std::vector<Case> cases() {
  return {{"plane", test::plane(5000, 1), 3},
          {"corridor", test::corridor(8000, 1), 1},
          {"sphere", test::sphere(5000, 1), 3},
          {"cylinder", test::closed_cylinder(6000, 1), 1},
          {"cylinder with fin", test::cylinder_with_fin(6000, 0.05, 1), 0},
          {"cone", test::cone(5000, 1), 1},
          {"spiral ramp", test::spiral_ramp(5000, 1), 1},
          {"bumpy surface", test::bumpy_surface(5000, 1), 0}};
}

TEST(WeakMotions, AreTheSymmetriesOfTheShape) {
  for (const Case& c : cases()) EXPECT_EQ(weak_of(c.cloud, true).weak.cols(), c.weak) << c.name;
}

TEST(WeakMotions, AreFoundWithoutNormals) {
  for (const Case& c : cases()) EXPECT_EQ(weak_of(c.cloud, false).weak.cols(), c.weak) << c.name;
}

// Noise of 1 % of the shape tilts the fitted normals by some degrees: false information.
TEST(WeakMotions, AreNotHiddenByNoise) {
  for (Case& c : cases()) {
    if (std::string_view(c.name) == "bumpy surface" || std::string_view(c.name) == "plane")
      continue;
    test::add_noise(c.cloud, 0.01, 2);
    const std::vector<Vector3d> exact = c.cloud.normals;
    test::estimate_normals(c.cloud, [](const Vector3d& x) { return x; });
    EXPECT_EQ(weak_of(c.cloud, true).weak.cols(), c.weak) << c.name;
  }
}

TEST(WeakMotions, AreNamed) {
  EXPECT_EQ(weak_of(test::corridor(8000, 1), true).names,
            std::vector<std::string>{"slide along (1, 0, 0)"});
  const std::vector<std::string> plane = weak_of(test::plane(5000, 1), true).names;
  ASSERT_EQ(plane.size(), 3u);
  EXPECT_EQ(plane[0].substr(0, 5), "slide");
  EXPECT_EQ(plane[1].substr(0, 5), "slide");
  EXPECT_EQ(plane[2].substr(0, 29), "turn about (0, 0, 1) through ");
  EXPECT_EQ(weak_of(test::cone(5000, 1), true).names[0].substr(0, 20), "turn about (0, 0, 1)");
  const std::string ramp = weak_of(test::spiral_ramp(5000, 1), true).names[0];
  EXPECT_EQ(ramp.substr(0, 21), "screw about (0, 0, 1)");
  EXPECT_NE(ramp.find(" by 3.14"), std::string::npos) << ramp;  // 0.5 m per rad = pi m per turn
}

// The solution minimises |A x - b| and has no part along the withheld motion.
TEST(SolveWithholding, LeavesTheWithheldMotionAlone) {
  RandomStream random(1, 0, 0);
  Matrix6 root;
  for (int i = 0; i < 36; ++i) root.data()[i] = random.normal();
  const Matrix6 a = root.transpose() * root;
  const Vector6 x = Vector6::LinSpaced(1, 6);
  EXPECT_LT((solve_withholding(a, a * x, TwistBasis(6, 0)) - x).norm(), 1e-9);
  const TwistBasis third = Vector6::Unit(3);
  const Vector6 kept = solve_withholding(a, a * x, third);
  EXPECT_NEAR(kept[3], 0, 1e-12);
  // Stationary within the rest: the gradient has only the withheld component.
  Vector6 gradient = a * kept - a * x;
  gradient[3] = 0;
  EXPECT_LT(gradient.norm(), 1e-9 * (a * x).norm());
}

TEST(MotionInformation, OfPartsAddsUpToThatOfTheWhole) {
  MotionInformation whole, parts[2], sum;
  for (std::uint64_t i = 0; i < 20; ++i) {
    RandomStream random(9, 0, i);
    const Vector3d arm = test::random_direction(random), normal = test::random_direction(random);
    std::optional<Vector3d> error;
    if (i % 3 != 0) error = 0.1 * test::random_direction(random);
    whole.add_plane(arm, normal, error);
    parts[i % 2].add_plane(arm, normal, error);
  }
  for (const MotionInformation& part : parts) sum += part;
  EXPECT_TRUE(sum.apparent().isApprox(whole.apparent(), 1e-14));
  EXPECT_TRUE(sum.noise().isApprox(whole.noise(), 1e-14));
}

}  // namespace
}  // namespace scan
