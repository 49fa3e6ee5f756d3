// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Truths of distance fields. A value is the exact distance if the field is 1-Lipschitz (so no
// surface is nearer) and the point at that distance against the gradient lies on the surface.
#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "tests/core/shape_cases.h"

namespace scan::test {
namespace {

TEST(Shape, CasesCoverTheVariant) {
  std::vector<bool> covered(std::variant_size_v<Shape>, false);
  for (const ShapeCase& c : all_cases()) covered[c.shape.index()] = true;
  for (std::size_t i = 0; i < covered.size(); ++i)
    EXPECT_TRUE(covered[i]) << "no case for alternative " << i;
}

TEST(Field, IsNegativeExactlyInside) {
  for (const ShapeCase& c : all_cases())
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(1, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.2);
      ASSERT_EQ(field(c.shape, x).value_m < 0, c.inside(x)) << c.name << " " << x.transpose();
    }
}

// Rounding of coordinates of size 1: some 1e-16.
TEST(Field, IsLipschitz) {
  std::vector<ShapeCase> cases = all_cases();
  cases.push_back({"filleted", filleted(), {}});
  for (const ShapeCase& c : cases)
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(2, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.2);
      const double reach = std::pow(10, -4 * random.uniform());
      const Eigen::Vector3d y = x + point_in_cube(random, reach);
      const double change = std::abs(field(c.shape, x).value_m - field(c.shape, y).value_m);
      ASSERT_LE(change, (x - y).norm() + 1e-15) << c.name;
      ASSERT_LE(field(c.shape, x).gradient.norm(), 1 + 1e-15) << c.name;
    }
}

TEST(Field, OfASimpleShapeIsTheExactDistance) {
  for (const ShapeCase& c : simple_cases())
    for (std::uint64_t i = 0; i < 5000; ++i) {
      RandomStream random(3, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.5);
      const DistanceField f = field(c.shape, x);
      ASSERT_NEAR(f.gradient.norm(), 1, 1e-15) << c.name;
      ASSERT_NEAR(field(c.shape, x - f.value_m * f.gradient).value_m, 0, 1e-15) << c.name;
    }
}

// Central differences with h = 1e-6 err by rounding, 2e-16 / 1e-6 = 2e-10, and by curvature; a
// point whose neighbours lie on both sides of a ridge of the field has no derivative, and at most
// a fraction of about h / size of all points has: so one in a thousand may fail.
TEST(Field, GradientIsTheDerivative) {
  std::vector<ShapeCase> cases = all_cases();
  cases.push_back({"filleted", filleted(), {}});
  for (const ShapeCase& c : cases) {
    int wrong = 0;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      RandomStream random(4, 0, i);
      const Eigen::Vector3d x = point_in_cube(random, 1.2);
      Eigen::Vector3d slope;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(k);
        slope(k) = (field(c.shape, x + h).value_m - field(c.shape, x - h).value_m) / 2e-6;
      }
      wrong += (slope - field(c.shape, x).gradient).norm() > 1e-8;
    }
    EXPECT_LE(wrong, 2) << c.name;
  }
}

TEST(Field, KeepsItsValueUnderMotion) {
  const Pose world_from_shape = pose_of(1, -2, 0.5, 3, 4, 5);
  for (const ShapeCase& c : all_cases()) {
    RandomStream random(5, 0, 0);
    const Eigen::Vector3d x = point_in_cube(random, 1);
    const DistanceField local = field(c.shape, x);
    const DistanceField world = field(PlacedShape{world_from_shape, c.shape}, world_from_shape * x);
    EXPECT_NEAR(world.value_m, local.value_m, 1e-14) << c.name;
    EXPECT_LT((world.gradient - world_from_shape.linear() * local.gradient).norm(), 1e-14)
        << c.name;
  }
}

TEST(Bounds, HoldEverySurfacePoint) {
  std::vector<ShapeCase> cases = all_cases();
  cases.push_back({"filleted", filleted(), {}});
  const Pose world_from_shape = pose_of(0.4, 0.8, -1, 1, 2, 3);
  for (const ShapeCase& c : cases) {
    if (std::holds_alternative<PlaneShape>(c.shape)) continue;
    Bounds box = bounds_of(PlacedShape{world_from_shape, c.shape});
    box = Bounds(box.min() - Eigen::Vector3d::Constant(1e-12),
                 box.max() + Eigen::Vector3d::Constant(1e-12));
    for (const auto& point : surface_points(c.shape, 500))
      EXPECT_TRUE(box.contains(world_from_shape * point)) << c.name;
  }
  EXPECT_FALSE(bounds_of(PlacedShape{Pose::Identity(), PlaneShape{}}).sizes().allFinite());
}

TEST(Check, NamesShapeAndField) {
  for (const ShapeCase& c : all_cases()) EXPECT_NO_THROW(check(c.shape)) << c.name;
  const std::vector<std::pair<Shape, std::string>> broken = {
      {SphereShape{0}, "radius"},
      {SphereShape{std::nan("")}, "radius"},
      {CylinderShape{1, -1}, "height"},
      {BoxShape{{1, 1, 0}, 0}, "size"},
      {BoxShape{{1, 1, 1}, 0.6}, "rounding"},
      {TorusShape{1, 0}, "minor radius"},
      {TorusShape{1, 1.5}, "minor radius"},
      {CombinedShape{}, "no parts"},
      {CombinedShape{Operation::unite, -1, {at(0, 0, 0, SphereShape{1})}}, "blend"},
      {CombinedShape{Operation::unite, 0, {at(0, 0, 0, SphereShape{-1})}}, "radius"}};
  for (const auto& [shape, word] : broken) try {
      check(shape);
      FAIL() << word;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace scan::test
