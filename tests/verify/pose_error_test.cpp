// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pose errors in closed form, and their freedom from the choice of the world frame.
#include "libscan/verify/pose_error.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Pose random_pose(RandomStream& random, double angle, double reach) {
  Vector6 twist;
  for (int k = 0; k < 3; ++k) twist(k) = angle * random.normal();
  for (int k = 3; k < 6; ++k) twist(k) = reach * random.normal();
  return exp(twist);
}

Points random_points(RandomStream& random, std::size_t count) {
  Points points(count);
  for (auto& point : points) point << random.normal(), random.normal(), 4 + random.normal();
  return points;
}

// Symmetric about the origin, so shifts of the cloud do not turn the fitted frame.
Points octahedron() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

struct Alignment {
  std::vector<Pose> estimated, truth;
  std::vector<Points> points;
};

Alignment noisy_alignment() {
  Alignment s;
  for (std::uint64_t i = 0; i < 4; ++i) {
    RandomStream random(1, 0, i);
    s.truth.push_back(random_pose(random, 1, 2));
    s.estimated.push_back(random_pose(random, 0.01, 0.02) * s.truth.back());
    s.points.push_back(random_points(random, 20 + 10 * i));
  }
  return s;
}

// Coordinates of 10 m round at 2e-15; some tens of operations.
TEST(PoseErrors, VanishForAnotherWorldFrame) {
  Alignment s = noisy_alignment();
  RandomStream random(2, 0, 0);
  const Pose other_world = random_pose(random, 1, 5);
  for (std::size_t i = 0; i < s.truth.size(); ++i) s.estimated[i] = other_world * s.truth[i];
  for (const PoseError& error : pose_errors(s.estimated, s.truth, s.points)) {
    EXPECT_LT(error.rotation_rad, 1e-13);
    EXPECT_LT(error.translation_m, 1e-13);
    EXPECT_LT(error.moved_points_rms_m, 1e-13);
  }
}

TEST(PoseErrors, DoNotDependOnTheWorldFrame) {
  Alignment s = noisy_alignment();
  const auto before = pose_errors(s.estimated, s.truth, s.points);
  RandomStream random(3, 0, 0);
  const Pose other_world = random_pose(random, 1, 5);
  for (Pose& pose : s.estimated) pose = other_world * pose;
  const auto after = pose_errors(s.estimated, s.truth, s.points);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GT(before[i].moved_points_rms_m, 1e-3);
    EXPECT_NEAR(after[i].rotation_rad, before[i].rotation_rad, 1e-13);
    EXPECT_NEAR(after[i].translation_m, before[i].translation_m, 1e-13);
    EXPECT_NEAR(after[i].moved_points_rms_m, before[i].moved_points_rms_m, 1e-13);
  }
}

// One scan of two is off by d and both have the same number of points: the fitted frame halves it.
// With weights 3 to 1 the heavier scan keeps a quarter.
TEST(PoseErrors, WeighScansByPoints) {
  const double d = 0.04;
  const std::vector<Pose> truth(2, Pose::Identity());
  const std::vector<Pose> estimated{Pose::Identity(),
                                    make_pose(Eigen::Matrix3d::Identity(), {d, 0, 0})};
  Points heavy = octahedron();
  for (int copy = 0; copy < 2; ++copy)
    for (const auto& x : octahedron()) heavy.push_back(x);
  const auto equal = pose_errors(estimated, truth, std::vector<Points>{octahedron(), octahedron()});
  EXPECT_NEAR(equal[0].translation_m, d / 2, 1e-15);
  EXPECT_NEAR(equal[1].translation_m, d / 2, 1e-15);
  const auto weighted = pose_errors(estimated, truth, std::vector<Points>{heavy, octahedron()});
  EXPECT_NEAR(weighted[0].translation_m, d / 4, 1e-15);
  EXPECT_NEAR(weighted[1].moved_points_rms_m, 3 * d / 4, 1e-15);
}

// Scans turned by +a and -a about z: the frame stays, each error is a. A point of the octahedron at
// distance 1 from the axis moves by 2 sin(a/2); four of six do.
TEST(PoseErrors, MeasureARotation) {
  const double a = 0.03;
  Vector6 turn = Vector6::Zero();
  turn(2) = a;
  const std::vector<Pose> truth(2, Pose::Identity()), estimated{exp(turn), exp(-turn)};
  for (const PoseError& error :
       pose_errors(estimated, truth, std::vector<Points>{octahedron(), octahedron()})) {
    EXPECT_NEAR(error.rotation_rad, a, 1e-15);
    EXPECT_NEAR(error.translation_m, 0, 1e-15);
    EXPECT_NEAR(error.moved_points_rms_m, 2 * std::sin(a / 2) * std::sqrt(4.0 / 6), 1e-15);
  }
}

// No small rotation or shift lowers the sum of squares that the gauge minimises.
TEST(Gauge, IsALeastSquaresMinimum) {
  const Alignment s = noisy_alignment();
  const Pose best = gauge(s.estimated, s.truth, s.points);
  const auto cost = [&](const Pose& g) {
    double sum = 0;
    for (std::size_t i = 0; i < s.truth.size(); ++i)
      for (const auto& x : s.points[i])
        sum += (g * s.estimated[i] * x - s.truth[i] * x).squaredNorm();
    return sum;
  };
  for (int k = 0; k < 6; ++k)
    for (const double step : {-1e-4, 1e-4})
      EXPECT_GT(cost(exp(step * Vector6::Unit(k)) * best), cost(best));
  EXPECT_NEAR(best.linear().determinant(), 1, 1e-14);
}

// Coordinates of 1e6 m round at 1e-10 m.
TEST(PoseErrors, AreAccurateFarFromTheOrigin) {
  const Pose far = make_pose(Eigen::Matrix3d::Identity(), {1e6, -2e6, 5e5});
  const std::vector<Pose> truth(2, far);
  const std::vector<Pose> estimated{far,
                                    make_pose(Eigen::Matrix3d::Identity(), {0.04, 0, 0}) * far};
  const auto errors =
      pose_errors(estimated, truth, std::vector<Points>{octahedron(), octahedron()});
  EXPECT_NEAR(errors[0].translation_m, 0.02, 2e-9);
  EXPECT_LT(errors[0].rotation_rad, 1e-8);
}

TEST(PoseErrors, RefuseWhatCannotBeCompared) {
  const std::vector<Pose> one(1, Pose::Identity()), two(2, Pose::Identity());
  EXPECT_THROW(pose_errors(one, two, std::vector<Points>(2, octahedron())), Error);
  EXPECT_THROW(pose_errors(one, one, std::vector<Points>(1)), Error);
  const Points line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  try {
    pose_errors(one, one, std::vector<Points>{line});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::computation);
  }
}

TEST(Summarise, TakesLargestAndMean) {
  const auto figures = summarise({{0.1, 1, 5}, {0.3, 2, 1}});
  EXPECT_DOUBLE_EQ(figure(figures, "rotation_error"), 0.3);
  EXPECT_DOUBLE_EQ(figure(figures, "translation_error"), 2);
  EXPECT_DOUBLE_EQ(figure(figures, "pose_error_rms"), 5);
  EXPECT_DOUBLE_EQ(figure(figures, "rotation_error_mean"), 0.2);
  EXPECT_DOUBLE_EQ(figure(figures, "translation_error_mean"), 1.5);
  EXPECT_DOUBLE_EQ(figure(figures, "pose_error_rms_mean"), 3);
}

// Of two scans, each with the same points in the world, the second is off by a turn of 0.2 about z.
// The gauge takes half of it: each is turned by 0.1 about the points' centroid, the origin. A
// target at distance 3 from the axis moves by 2 * 3 sin(0.05), one on it by 0.
TEST(TargetRegistrationError, OfASharedTurnIsTheChord) {
  Vector6 turn = Vector6::Zero();
  turn(2) = 0.2;
  const std::vector<Pose> truth(2, Pose::Identity());
  const std::vector<Points> points(2, octahedron());
  const Points targets{{3, 0, 7}, {0, 0, 1}};
  const Vector6 other = (Vector6() << 1, 2, 3, 4, 5, 6).finished();
  const std::vector<Pose> estimated{exp(other), exp(other) * exp(turn)};
  const auto figures = target_registration_error(estimated, truth, points, targets);
  const double chord = 6 * std::sin(0.05);
  EXPECT_NEAR(figure(figures, "target_registration_error_max"), chord, 1e-13);
  EXPECT_NEAR(figure(figures, "target_registration_error"), chord / std::sqrt(2), 1e-13);
  EXPECT_THROW(target_registration_error(estimated, truth, points, {}), Error);
}

// Two poses; the second is off by a turn of 0.1 about its own z and by 0.2 along its x, so that its
// motion to the first is off by just these, wherever the world frame lies.
TEST(RelativePoseErrors, AreThoseOfTheMotionBetweenNeighbours) {
  RandomStream random(4, 0, 0);
  const Pose first = random_pose(random, 1, 2), second = random_pose(random, 1, 2);
  const Pose other_world = random_pose(random, 1, 5);
  Vector6 turn = Vector6::Zero(), shift = Vector6::Zero();
  turn(2) = 0.1;
  shift(3) = 0.2;
  const std::vector<Pose> truth{first, second};
  const std::vector<Points> points{octahedron(), octahedron()};
  const auto turned = relative_pose_errors(
      std::vector<Pose>{other_world * first, other_world * second * exp(turn)}, truth, points);
  ASSERT_EQ(turned.size(), 1u);
  EXPECT_NEAR(turned[0].rotation_rad, 0.1, 1e-13);
  const auto shifted = relative_pose_errors(
      std::vector<Pose>{other_world * first, other_world * second * exp(shift)}, truth, points);
  EXPECT_NEAR(shifted[0].rotation_rad, 0, 1e-13);
  EXPECT_NEAR(shifted[0].translation_m, 0.2, 1e-13);
  const auto figures = summarise_relative(shifted);
  EXPECT_NEAR(figure(figures, "relative_translation_error"), 0.2, 1e-13);
  EXPECT_NEAR(figure(figures, "relative_translation_error_mean"), 0.2, 1e-13);
}

TEST(RelativePoseErrors, OfASingleScanAreNone) {
  const std::vector<Pose> one{Pose::Identity()};
  EXPECT_TRUE(relative_pose_errors(one, one, std::vector<Points>{octahedron()}).empty());
  EXPECT_TRUE(summarise_relative({}).empty());
}

// Of a hundred targets one lies far off, where a turn is felt most: the largest is its chord.
TEST(TargetRegistrationError, KnowsTheFarthestOfManyTargets) {
  Vector6 turn = Vector6::Zero();
  turn(2) = 0.2;
  const std::vector<Pose> truth(2, Pose::Identity()), estimated{Pose::Identity(), exp(turn)};
  const std::vector<Points> points(2, octahedron());
  Points targets(99, Eigen::Vector3d(0, 0, 1));
  targets.push_back({3, 0, 7});
  EXPECT_NEAR(figure(target_registration_error(estimated, truth, points, targets),
                     "target_registration_error_max"),
              6 * std::sin(0.05), 1e-13);
}

// A strip of 1 m by 2 cm fixes all rotations: its singular values are as 1 to 4e-4.
TEST(Gauge, IsFixedByANarrowStrip) {
  const Points strip{{-0.5, -0.01, 2}, {0.5, -0.01, 2}, {0.5, 0.01, 2}, {-0.5, 0.01, 2}};
  RandomStream random(6, 0, 0);
  const Pose world = random_pose(random, 1, 2);
  const std::vector<Pose> truth{Pose::Identity()}, estimated{world};
  const Pose fixed = gauge(estimated, truth, std::vector<Points>{strip});
  EXPECT_TRUE(fixed.isApprox(world.inverse(), 1e-12));
}

}  // namespace
}  // namespace scan
