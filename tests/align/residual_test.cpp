// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/residual.h"

#include <gtest/gtest.h>

#include "tests/align/test_clouds.h"

namespace scan {
namespace {

using Eigen::Vector3d;

PointPair random_pair(RandomStream& random) {
  const auto point = [&] { return Vector3d(random.normal(), random.normal(), random.normal()); };
  return {point(), point(), test::random_direction(random), test::random_direction(random)};
}

PointPair perturbed(const PointPair& pair, const Vector6& twist, const Vector3d& centre) {
  const Pose motion = exp(twist);
  return {centre + motion * (pair.moved - centre), pair.target, pair.normal,
          motion.linear() * pair.moved_normal};
}

template <class Residual>
class ResidualTest : public testing::Test {};
using Residuals = testing::Types<PointToPoint, PointToPlane, Symmetric>;
TYPED_TEST_SUITE(ResidualTest, Residuals);

// Central differences with step h are off by h^2 |r'''| / 6 + eps |r| / h: 1e-10 for h = 1e-5.
TYPED_TEST(ResidualTest, JacobianIsTheDerivative) {
  RandomStream random(1, 0, 0);
  constexpr int rows = TypeParam::dimension;
  for (int trial = 0; trial < 20; ++trial) {
    const PointPair pair = random_pair(random);
    const Vector3d centre(random.normal(), random.normal(), random.normal());
    const Eigen::Matrix<double, rows, 6> jacobian = TypeParam::jacobian(pair, centre);
    for (int k = 0; k < 6; ++k) {
      const Vector6 step = 1e-5 * Vector6::Unit(k);
      const Eigen::Matrix<double, rows, 1> plus(TypeParam::value(perturbed(pair, step, centre)));
      const Eigen::Matrix<double, rows, 1> minus(TypeParam::value(perturbed(pair, -step, centre)));
      EXPECT_LT(((plus - minus) / 2e-5 - jacobian.col(k)).norm(), 1e-9);
    }
  }
}

// Seen from any other frame the residual has the same size.
TYPED_TEST(ResidualTest, SizeDoesNotDependOnTheFrame) {
  RandomStream random(2, 0, 0);
  constexpr int rows = TypeParam::dimension;
  for (int trial = 0; trial < 20; ++trial) {
    const PointPair pair = random_pair(random);
    const Pose frame = test::random_pose(random, 2, 1);
    const PointPair turned{frame * pair.moved, frame * pair.target, frame.linear() * pair.normal,
                           frame.linear() * pair.moved_normal};
    const Eigen::Matrix<double, rows, 1> a(TypeParam::value(pair)), b(TypeParam::value(turned));
    EXPECT_NEAR(a.norm(), b.norm(), 1e-14 * 10);
  }
}

TEST(PointToPoint, IsZeroOnlyAtTheTarget) {
  EXPECT_EQ(PointToPoint::value({{1, 2, 3}, {1, 2, 3}, {}}), Vector3d::Zero());
  EXPECT_EQ(PointToPoint::value({{1, 2, 3}, {0, 0, 0}, {}}), Vector3d(1, 2, 3));
}

// n = (0.6, 0.8, 0), slide (0.8, -0.6, 0): zero, where a product by components would give 0.46 m^2.
TEST(PointToPlane, IsZeroForMotionInThePlane) {
  const PointPair pair{{0.8, -0.6, 0}, {0, 0, 0}, {0.6, 0.8, 0}};
  EXPECT_NEAR(PointToPlane::value(pair), 0, 1e-16);
  RandomStream random(3, 0, 0);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d normal = test::random_direction(random);
    const Vector3d slide = normal.cross(test::random_direction(random));
    EXPECT_NEAR(PointToPlane::value({slide, Vector3d::Zero(), normal}), 0, 1e-15);
  }
}

TEST(PointToPlane, IsTheDistanceAlongTheNormal) {
  const Vector3d normal(0.6, 0, 0.8), target(3, 4, 5);
  EXPECT_NEAR(PointToPlane::value({target + 0.25 * normal, target, normal}), 0.25, 1e-15);
}

// Two points of a sphere with their normals: the chord is perpendicular to the sum of the radii.
TEST(Symmetric, IsZeroAlongASphereWhereAPlaneIsNot) {
  RandomStream random(4, 0, 0);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3d a = test::random_direction(random), b = test::random_direction(random);
    const PointPair pair{2 * a, 2 * b, b, a};
    if (a.dot(b) <= 0.1) continue;
    EXPECT_NEAR(Symmetric::value(pair), 0, 1e-15);
    EXPECT_GT(std::abs(PointToPlane::value(pair)), 1e-4);
  }
}

TEST(Symmetric, DoesNotMindTheSignOfANormal) {
  RandomStream random(5, 0, 0);
  const PointPair pair = random_pair(random);
  PointPair flipped = pair;
  flipped.moved_normal = -flipped.moved_normal;
  EXPECT_EQ(Symmetric::value(flipped), Symmetric::value(pair));
  EXPECT_EQ(Symmetric::jacobian(flipped, {1, 2, 3}), Symmetric::jacobian(pair, {1, 2, 3}));
}

}  // namespace
}  // namespace scan
