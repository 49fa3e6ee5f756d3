// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Distances to unions against closed forms and against dense samples.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "libscan/verify/surface_error.h"
#include "tests/core/meshes.h"

namespace scan {
namespace {

PlacedShape at(const Eigen::Vector3d& centre, Shape shape) {
  return {make_pose(Eigen::Matrix3d::Identity(), centre), std::move(shape)};
}

Eigen::Vector3d random_point(std::uint64_t i, double half) {
  RandomStream random(1, 0, i);
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return half * Eigen::Vector3d(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

// The analytic box is the oracle for the mesh: value, sign, point; faces, edges and corners.
TEST(TrueDistance, OfACubeMeshIsThatOfTheBox) {
  const TrueDistance to_mesh(TrueSurface{{}, {cube(1)}});
  const PlacedShape box = at({0.5, 0.5, 0.5}, BoxShape{{1, 1, 1}, 0});
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const Eigen::Vector3d x = random_point(i, 1.5);
    const auto nearest = to_mesh.nearest(x);
    ASSERT_NEAR(nearest.signed_distance_m, field(box, x).value_m, 1e-14) << x.transpose();
    ASSERT_NEAR(field(box, nearest.point).value_m, 0, 1e-15);
    ASSERT_NEAR(nearest.normal.norm(), 1, 1e-14);
  }
}

TEST(TrueDistance, HasTheSideOfAnOpenMesh) {
  Mesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const TrueDistance distance(TrueSurface{{}, {sheet}});
  EXPECT_NEAR(distance.nearest({0.2, 0.2, 0.3}).signed_distance_m, 0.3, 1e-15);
  EXPECT_NEAR(distance.nearest({0.2, 0.2, -0.3}).signed_distance_m, -0.3, 1e-15);
}

TEST(TrueDistance, OfSeparateObjectsIsTheSmaller) {
  const TrueDistance distance(
      TrueSurface{{at({0, 0, 0}, SphereShape{0.5})},
                  {transformed(make_pose(Eigen::Matrix3d::Identity(), {2, 0, 0}), cube(1))}});
  EXPECT_NEAR(distance.nearest({0.8, 0, 0}).signed_distance_m, 0.3, 1e-15);
  EXPECT_NEAR(distance.nearest({1.9, 0.5, 0.5}).signed_distance_m, 0.1, 1e-15);
  EXPECT_NEAR(distance.nearest({2.5, 0.5, 0.9}).signed_distance_m, -0.1, 1e-15);
}

// Two spheres of radius 1 at x = -0.6 and 0.6 meet in the circle x = 0 of radius 0.8. In the middle
// the nearest surface of either is buried in the other; the union's nearest is the seam.
TEST(TrueDistance, IgnoresBuriedSurface) {
  const TrueSurface union_of_two{
      {at({-0.6, 0, 0}, SphereShape{1}), at({0.6, 0, 0}, SphereShape{1})}, {}};
  const TrueDistance distance(union_of_two);
  const auto middle = distance.nearest({0.01, 0.1, 0});
  EXPECT_NEAR(middle.signed_distance_m, -std::hypot(0.01, 0.7), 1e-9);
  // a point of the left sphere's buried cap is deep inside, not on the surface
  EXPECT_LT(distance.nearest({0.4, 0, 0}).signed_distance_m, -0.5);
  // on the visible side nothing changes
  EXPECT_NEAR(distance.nearest({-1.7, 0, 0}).signed_distance_m, 0.1, 1e-15);
}

// No sample of the visible surface is nearer than what is reported, and the reported point is on
// it.
TEST(TrueDistance, IsAsNearAsAnySample) {
  const TrueSurface scene{
      {at({0, 0, 0}, PlaneShape{}), at({0, 0, 0.2}, SphereShape{0.5}),
       at({0.6, 0, 0.1}, BoxShape{{0.4, 0.6, 0.5}, 0})},
      {transformed(make_pose(Eigen::Matrix3d::Identity(), {-1.2, -0.5, -0.1}), cube(0.5))}};
  const TrueDistance distance(scene);
  const auto samples = sample_truth(scene, 20'000, 3);
  for (std::uint64_t i = 0; i < 500; ++i) {
    Eigen::Vector3d x = random_point(i, 1);
    x.z() = std::abs(x.z());
    double least = std::numeric_limits<double>::infinity();
    for (const auto& sample : samples) least = std::min(least, (sample.point - x).norm());
    const auto nearest = distance.nearest(x);
    if (nearest.signed_distance_m < 0) continue;  // inside, seams with the mesh are not known
    ASSERT_LE(nearest.signed_distance_m, least + 1e-9) << x.transpose();
  }
}

TEST(TrueDistance, IsAccurateFarFromTheOrigin) {
  const Eigen::Vector3d far(1e6, 1e6, -1e6);
  const TrueDistance distance(TrueSurface{{at(far, SphereShape{1})}, {}});
  EXPECT_NEAR(distance.nearest(far + Eigen::Vector3d(0, 0, 1.25)).signed_distance_m, 0.25, 1e-9);
}

TEST(TrueDistance, RefusesAnEmptySurface) {
  EXPECT_THROW(TrueDistance(TrueSurface{}), Error);
}

TEST(Deviations, AreSignedAndKeepWhatIsNotFinite) {
  const TrueSurface sphere{{at({0, 0, 0}, SphereShape{1})}, {}};
  const std::vector<Eigen::Vector3d> points{{1.1, 0, 0}, {0, 0.9, 0}, {std::nan(""), 0, 0}};
  const auto deviations = deviations_m(points, sphere);
  EXPECT_NEAR(deviations[0], 0.1, 1e-15);
  EXPECT_NEAR(deviations[1], -0.1, 1e-15);
  EXPECT_TRUE(std::isnan(deviations[2]));
}

// Two balls under a blend: its field falls short of the distance, so that a ball which lies between
// the two in distance must be looked at though the blend's bound comes first.
TEST(TrueDistance, LooksBehindABoundThatFallsShort) {
  const PlacedShape blend =
      at({0, 0, 0},
         CombinedShape{CombinedShape::Operation::unite,
                       1.5,
                       {at({-1.2, 0, 0}, SphereShape{1}), at({1.2, 0, 0}, SphereShape{1})}});
  const Eigen::Vector3d x(0, 0, 2);
  const double bound_m = std::abs(field(blend, x).value_m);
  const double blend_m = TrueDistance(TrueSurface{{blend}, {}}).nearest(x).signed_distance_m;
  ASSERT_LT(bound_m, 0.9 * blend_m);
  const double ball_m = (std::max(bound_m, 0.9 * blend_m) + blend_m) / 2;
  const PlacedShape ball = at({0, 0, 2 + ball_m + 0.3}, SphereShape{0.3});
  EXPECT_NEAR(TrueDistance(TrueSurface{{blend, ball}, {}}).nearest(x).signed_distance_m, ball_m,
              1e-12);
}

}  // namespace
}  // namespace scan
