// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "synth/viewpoints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/error.h"

namespace scan::synth {
namespace {

const Eigen::Vector3d centre(0.1, -0.2, 0.05);

void expect_looks_at_centre(const Pose& pose) {
  const Eigen::Vector3d view = pose.linear().col(2);
  EXPECT_NEAR((view - (centre - pose.translation()).normalized()).norm(), 0, 1e-14);
  EXPECT_NEAR(pose.linear()(2, 0), 0, 1e-14) << "x is horizontal";
  EXPECT_LE(pose.linear()(2, 1), 1e-14) << "y points down";
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-14);
}

TEST(Turntable, StandsAtEqualAnglesAndLooksAtItsCentre) {
  const auto poses = true_poses({Turntable{12, 0.4, 0.1, centre}, {}});
  ASSERT_EQ(poses.size(), 12u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    expect_looks_at_centre(poses[i]);
    const Eigen::Vector3d eye = poses[i].translation() - centre;
    EXPECT_NEAR(eye.head<2>().norm(), 0.4, 1e-15);
    EXPECT_NEAR(eye.z(), 0.1, 1e-15);
    const Eigen::Vector3d next = poses[(i + 1) % 12].translation() - centre;
    const double turn =
        std::atan2(eye.x() * next.y() - eye.y() * next.x(), eye.head<2>().dot(next.head<2>()));
    EXPECT_NEAR(turn, std::numbers::pi / 6, 1e-14);
  }
}

TEST(Ring, ReachesBothEndsOfItsArc) {
  const auto poses = true_poses({Ring{5, 0.4, 0, 0.3, 1.2, centre}, {}});
  ASSERT_EQ(poses.size(), 5u);
  const auto azimuth = [&](const Pose& p) {
    return std::atan2(p.translation().y() - centre.y(), p.translation().x() - centre.x());
  };
  EXPECT_NEAR(azimuth(poses.front()), 0.3, 1e-14);
  EXPECT_NEAR(azimuth(poses.back()), 1.5, 1e-14);
  for (const Pose& pose : poses) expect_looks_at_centre(pose);
  const auto full = true_poses({Ring{4, 0.4, 0, 0, 2 * std::numbers::pi, centre}, {}});
  EXPECT_GT(translation_distance_m(full.front(), full.back()), 0.5)
      << "a full turn repeats no place";
  EXPECT_EQ(true_poses({Ring{1, 0.4, 0, 0, 1, centre}, {}}).size(), 1u);
}

TEST(Dome, SpreadsEvenlyOverItsCap) {
  const int count = 1000;
  const double lowest = 0.3;
  const auto poses = true_poses({Dome{count, 0.5, lowest, centre}, {}});
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pose& pose : poses) {
    expect_looks_at_centre(pose);
    const Eigen::Vector3d direction = (pose.translation() - centre) / 0.5;
    EXPECT_NEAR(direction.norm(), 1, 1e-14);
    EXPECT_GE(direction.z(), std::sin(lowest));
    sum += direction;
  }
  // mean height of a cap is half way between its rim and the pole
  EXPECT_NEAR(sum.z() / count, (1 + std::sin(lowest)) / 2, 1e-12);
  EXPECT_LT(sum.head<2>().norm() / count, 0.01);
}

TEST(PoseGuesses, AreExactForTheFirstScanAndWithoutNoise) {
  Viewpoints viewpoints{Turntable{6, 0.4, 0.1, centre}, {0.05, 0.01}};
  const auto truth = true_poses(viewpoints), guesses = guessed_poses(viewpoints, 3);
  EXPECT_EQ(guesses[0].matrix(), truth[0].matrix());
  for (int i = 1; i < 6; ++i) {
    EXPECT_GT(rotation_distance_rad(truth[i], guesses[i]), 0);
    EXPECT_GT(translation_distance_m(truth[i], guesses[i]), 0);
  }
  viewpoints.pose_noise = {};
  const auto exact = guessed_poses(viewpoints, 3);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR((exact[i].matrix() - truth[i].matrix()).norm(), 0, 1e-15);
}

TEST(PoseGuesses, HaveTheDeviationsAskedFor) {
  const int count = 20000;
  const Viewpoints viewpoints{Turntable{count, 0.4, 0, centre}, {0.03, 0.02}};
  const auto truth = true_poses(viewpoints), guesses = guessed_poses(viewpoints, 5);
  double rotation2 = 0, translation2 = 0;
  Eigen::Vector3d mean_shift = Eigen::Vector3d::Zero();
  for (int i = 1; i < count; ++i) {
    rotation2 += std::pow(rotation_distance_rad(truth[i], guesses[i]), 2);
    translation2 += std::pow(translation_distance_m(truth[i], guesses[i]), 2);
    mean_shift += guesses[i].translation() - truth[i].translation();
  }
  const double relative = 4 * std::sqrt(2.0 / count);  // four standard errors of a variance
  EXPECT_NEAR(rotation2 / count, 0.03 * 0.03, 0.03 * 0.03 * relative);
  EXPECT_NEAR(translation2 / count, 0.02 * 0.02, 0.02 * 0.02 * relative);
  EXPECT_LT(mean_shift.norm() / count, 4 * 0.02 / std::sqrt(count));
}

TEST(PoseGuesses, DependOnTheSeedAlone) {
  const Viewpoints viewpoints{Turntable{4, 0.4, 0, centre}, {0.03, 0.02}};
  EXPECT_EQ(guessed_poses(viewpoints, 5)[2].matrix(), guessed_poses(viewpoints, 5)[2].matrix());
  EXPECT_NE(guessed_poses(viewpoints, 5)[2].matrix(), guessed_poses(viewpoints, 6)[2].matrix());
}

TEST(Viewpoints, RefuseWhatIsNoPlace) {
  EXPECT_THROW(check(Viewpoints{Turntable{0}, {}}), Error);
  EXPECT_THROW(check(Viewpoints{Turntable{3, -1}, {}}), Error);
  EXPECT_THROW(check(Viewpoints{Ring{.sweep_rad = 7}, {}}), Error);
  EXPECT_THROW(check(Viewpoints{Dome{.lowest_rad = 1.6}, {}}), Error);
  EXPECT_THROW(check(Viewpoints{PoseList{}, {}}), Error);
  Pose mirrored = Pose::Identity();
  mirrored.linear()(0, 0) = -1;
  EXPECT_THROW(check(Viewpoints{PoseList{{mirrored}}, {}}), Error);
  EXPECT_THROW(check(Viewpoints{Turntable{}, {-0.1, 0}}), Error);
}

}  // namespace
}  // namespace scan::synth
