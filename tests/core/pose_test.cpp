// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Truths of rigid motions: group laws, derivatives, accuracy at both ends of the angle.
#include "libscan/core/pose.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double angles_rad[] = {0,   1e-300, 1e-12, 1e-8,      1e-5,      0.00999,   0.01001,
                                 0.5, 2,      3,     pi - 1e-3, pi - 1e-6, pi - 1e-9};

Eigen::Vector3d unit_vector(RandomStream& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

Vector6 random_twist(RandomStream& random, double angle_rad) {
  Vector6 twist;
  twist << angle_rad * unit_vector(random), 3 * unit_vector(random);
  return twist;
}

double largest_difference(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

// Each entry is a sum of a few products of numbers of size 1 (rotation) or 3 pi (translation), so
// some tens of roundings of 2e-16 times that: 2e-14 and 1e-13.
TEST(ExpLog, RoundTripForEachAngle) {
  for (std::uint64_t i = 0; i < 20; ++i)
    for (const double angle_rad : angles_rad) {
      RandomStream random(1, 0, i);
      const Vector6 twist = random_twist(random, angle_rad);
      const Vector6 back = log(exp(twist));
      EXPECT_LT((back - twist).head<3>().norm(), 2e-14) << angle_rad;
      EXPECT_LT((back - twist).tail<3>().norm(), 1e-13) << angle_rad;
    }
}

TEST(ExpLog, RoundTripAtAHalfTurn) {
  for (std::uint64_t i = 0; i < 50; ++i) {
    RandomStream random(2, 0, i);
    const Pose half_turn = exp(random_twist(random, pi));
    EXPECT_LT(largest_difference(exp(log(half_turn)), half_turn), 1e-13);
    EXPECT_NEAR(log(half_turn).head<3>().norm(), pi, 1e-14);
  }
}

TEST(Exp, IsAOneParameterGroup) {
  RandomStream random(3, 0, 0);
  const Vector6 twist = random_twist(random, 1);
  for (const double s : {-7.0, -0.3, 1e-3, 2.0, 11.0})
    for (const double t : {-2.0, 4e-3, 0.7, 5.0})
      EXPECT_LT(largest_difference(exp(s * twist) * exp(t * twist), exp((s + t) * twist)), 1e-13);
}

// d exp(e v) x / d e at 0 is w cross x + t; central differences with step 1e-5 err by the third
// derivative, |w|^3 |x| h^2 / 6 < 1e-9, and by rounding, 1e-15 / h = 1e-10.
TEST(Exp, HasTheTwistAsItsDerivative) {
  RandomStream random(4, 0, 0);
  const Vector6 twist = random_twist(random, 1.3);
  const Eigen::Vector3d x(0.3, -2, 1);
  const double h = 1e-5;
  const Eigen::Vector3d slope = (exp(h * twist) * x - exp(-h * twist) * x) / (2 * h);
  EXPECT_LT((slope - (twist.head<3>().cross(x) + twist.tail<3>())).norm(), 2e-9);
}

TEST(Exp, GivesProperRotations) {
  for (const double angle_rad : {1e-9, 0.005, 0.5, 3.0, 100.0}) {
    RandomStream random(5, 0, 0);
    const Eigen::Matrix3d R = exp(random_twist(random, angle_rad)).linear();
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14) << angle_rad;
    EXPECT_NEAR(R.determinant(), 1, 1e-14);
  }
}

// Against the quarter turn about z while moving along x: a known screw motion. The centre of the
// circle that the origin runs on lies at distance 1 / (pi / 2), so it ends at (2 / pi) (1, 1, 0).
TEST(Exp, FollowsTheKnownArc) {
  Vector6 twist;
  twist << 0, 0, pi / 2, 1, 0, 0;
  EXPECT_LT((exp(twist).translation() - 2 / pi * Eigen::Vector3d(1, 1, 0)).norm(), 1e-15);
}

TEST(RotationAngle, IsAccurateAtBothEnds) {
  for (const double angle_rad : {1e-12, 1e-7, 1e-3, 1.0, pi - 1e-3, pi - 1e-7, pi - 1e-12}) {
    RandomStream random(6, 0, 0);
    const Pose pose = exp(random_twist(random, angle_rad));
    // absolute near pi, relative near 0: an arc cosine would lose half the digits at both
    EXPECT_NEAR(rotation_angle_rad(pose.linear()), angle_rad, 4e-16 + 4e-15 * angle_rad);
  }
}

TEST(RotationDistance, IsTheAngleBetween) {
  RandomStream random(7, 0, 0);
  const Pose a = exp(random_twist(random, 2)), turn = exp(random_twist(random, 0.25));
  EXPECT_NEAR(rotation_distance_rad(a, a * turn), 0.25, 1e-14);
  EXPECT_NEAR(rotation_distance_rad(a, turn * a), 0.25, 1e-14);
}

TEST(NearestRotation, UndoesAStretch) {
  RandomStream random(8, 0, 0);
  const Eigen::Matrix3d R = exp(random_twist(random, 2.2)).linear();
  Eigen::Matrix3d stretch;  // symmetric positive definite: R is the polar factor of R * stretch
  stretch << 2, 0.3, 0.1, 0.3, 1, -0.2, 0.1, -0.2, 0.5;
  EXPECT_LT((nearest_rotation(R * stretch) - R).norm(), 1e-14);
}

TEST(NearestRotation, IsProperForAReflection) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(3, 2, -1).asDiagonal();
  EXPECT_LT((nearest_rotation(mirror) - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  const Eigen::Matrix3d any = nearest_rotation(Eigen::Matrix3d::Zero());
  EXPECT_NEAR(any.determinant(), 1, 1e-14);
}

TEST(LookAt, SeesTheTargetUpright) {
  const Eigen::Vector3d eye(1, 2, 3), target(4, -1, 0);
  const Pose world_from_device = look_at(eye, target, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d seen = world_from_device.inverse() * target;
  EXPECT_NEAR(seen.x(), 0, 1e-14);
  EXPECT_NEAR(seen.y(), 0, 1e-14);
  EXPECT_GT(seen.z(), 0);
  const Eigen::Vector3d above = world_from_device.inverse() * (target + Eigen::Vector3d::UnitZ());
  EXPECT_LT(above.y(), 0);  // image rows grow downwards
  EXPECT_NEAR(above.x(), 0, 1e-14);
  EXPECT_NEAR(world_from_device.linear().determinant(), 1, 1e-14);
}

TEST(LookAt, ChoosesAnAxisWhenUpIsTheView) {
  const Pose pose = look_at({0, 0, 5}, {0, 0, 0}, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-14);
  EXPECT_LT((pose.linear().col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

}  // namespace
}  // namespace scan
