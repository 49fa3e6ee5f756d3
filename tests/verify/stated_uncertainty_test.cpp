// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Normalised errors of values drawn from the very distribution that is stated, and of others.
#include "libscan/verify/stated_uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/core/random.h"
#include "libscan/verify/chi_square.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

constexpr std::size_t count = 20'000;

// The mean of n squares has variance 2 / (n degrees), the share one of 0.95 0.05 / n; five standard
// deviations. The root halves the relative spread.
void expect_honest(const NormalisedErrors& errors, const std::string& what) {
  const auto figures = stated_uncertainty(what, errors, "draws");
  EXPECT_NEAR(figure(figures, "normalised_" + what + "_error_rms"), 1,
              2.5 * std::sqrt(2.0 / (count * errors.degrees)));
  EXPECT_NEAR(figure(figures, what + "_error_within_95"), 0.95, 5 * std::sqrt(0.95 * 0.05 / count));
  EXPECT_EQ(measurement(figures, what + "_error_within_95").count, errors.squares.size());
}

TEST(StatedUncertainty, CountsByHand) {
  const NormalisedErrors errors{.squares = {0, 1, 3.84, 3.85}, .degrees = 1};
  const auto figures = stated_uncertainty("range", errors, "rays");
  EXPECT_NEAR(figure(figures, "normalised_range_error_rms"), std::sqrt(8.69 / 4), 1e-15);
  EXPECT_EQ(figure(figures, "range_error_within_95"), 0.75);
  const NormalisedErrors poses{.squares = {6, 12.59, 12.60}, .degrees = 6};
  EXPECT_NEAR(figure(stated_uncertainty("pose", poses, ""), "normalised_pose_error_rms"),
              std::sqrt(31.19 / 18), 1e-15);
  EXPECT_NEAR(figure(stated_uncertainty("pose", poses, ""), "pose_error_within_95"), 2.0 / 3,
              1e-15);
  EXPECT_TRUE(stated_uncertainty("range", {}, "").empty());
  EXPECT_THROW(stated_uncertainty("range", {.squares = {1}, .degrees = 3}, ""), Error);
}

// By hand: roots of the quantiles of 2 and of 12 degrees over these.
TEST(StatedUncertainty, KnowsWhereHonestFiguresLie) {
  const auto two = measurement(stated_uncertainty("range", {.squares = {1, 9}}, ""),
                               "normalised_range_error_rms");
  ASSERT_TRUE(two.expected.has_value());
  EXPECT_NEAR(two.expected->low, std::sqrt(-std::log(0.975)), 1e-12);
  EXPECT_NEAR(two.expected->high, std::sqrt(-std::log(0.025)), 1e-12);
  const auto poses = measurement(stated_uncertainty("pose", {.squares = {1, 9}, .degrees = 6}, ""),
                                 "normalised_pose_error_rms");
  EXPECT_NEAR(poses.expected->low, std::sqrt(4.40379 / 12), 1e-6);
  EXPECT_NEAR(poses.expected->high, std::sqrt(23.3367 / 12), 1e-5);
  EXPECT_FALSE(measurement(stated_uncertainty("pose", {.squares = {1}, .degrees = 6}, ""),
                           "pose_error_within_95")
                   .expected.has_value());
}

TEST(StatedUncertainty, TheIntervalHoldsItsEnd) {
  const NormalisedErrors errors{.squares = {chi_square_quantile(0.95, 1)}};
  EXPECT_EQ(figure(stated_uncertainty("range", errors, ""), "range_error_within_95"), 1);
}

// 1 in 20 of honest figures lies beyond; five standard deviations of 1000 of them.
TEST(StatedUncertainty, ExpectsOfHonestErrorsWhatTheyGive) {
  int inside = 0;
  for (std::uint32_t trial = 0; trial < 1000; ++trial) {
    NormalisedErrors errors;
    RandomStream random(3, trial, 0);
    for (int i = 0; i < 40; ++i) errors.squares.push_back(std::pow(random.normal(), 2));
    const auto root =
        measurement(stated_uncertainty("range", errors, ""), "normalised_range_error_rms");
    inside += root.expected->low <= root.value && root.value <= root.expected->high;
  }
  EXPECT_NEAR(inside, 950, 5 * std::sqrt(1000 * 0.95 * 0.05));
}

// A point that errs along a known line, whatever that line: here the light plane's, not the ray's.
TEST(StatedUncertainty, OfPointsAlongTheirOwnLineIsHonest) {
  NormalisedErrors errors;
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(1, 0, i);
    const double x = random.normal(), y = random.normal(), z = random.normal(), e = random.normal();
    const Eigen::Vector3d shift_m = 1e-4 * Eigen::Vector3d(x, y, z);
    errors.squares.push_back(normalised_square(e * shift_m, shift_m * shift_m.transpose()).value());
  }
  expect_honest(errors, "range");
}

TEST(StatedUncertainty, TakesTheLongestAxis) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1, 9, 4).asDiagonal();
  EXPECT_NEAR(normalised_square({5, 6, 7}, covariance).value(), 4, 1e-12);
  EXPECT_FALSE(normalised_square({1, 1, 1}, Eigen::Matrix3d::Zero()).has_value());
  EXPECT_FALSE(normalised_square(
                   {1, 1, 1}, Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()))
                   .has_value());
}

Matrix6 stated_covariance() {
  Matrix6 root = Matrix6::Identity();
  root.topLeftCorner<3, 3>() *= 1e-4;
  root.bottomRightCorner<3, 3>() *= 1e-3;
  root(0, 4) = 3e-4, root(5, 1) = 2e-5;
  return root * root.transpose();
}

// Scans whose poses err by exactly what is stated, about a centre far from the origin, seen from an
// anchor whose own pose is off by a large motion: that is free.
TEST(StatedUncertainty, OfPosesIsHonestRelativeToTheAnchor) {
  const Eigen::Translation3d centre(3, -2, 5);
  const Eigen::Matrix<double, 6, 6> root = stated_covariance().llt().matrixL();
  const Pose world = exp((Vector6() << 0.3, -0.2, 0.5, 7, 8, 9).finished());
  std::vector<Pose> truth{Pose::Identity()}, estimated{world};
  std::vector<std::optional<StatedPose>> stated{std::nullopt};
  for (std::size_t i = 0; i < count; ++i) {
    RandomStream random(2, 0, i);
    Vector6 draw;
    for (double& value : draw) value = random.normal();
    truth.push_back(exp((Vector6() << 0, 1, 0, 0.1, 0.2, 0.3).finished()));
    estimated.push_back(centre * exp(root * draw) * centre.inverse() * world * truth.back());
    stated.push_back(StatedPose{stated_covariance(), centre.translation()});
  }
  expect_honest(normalised_pose_errors(estimated, truth, stated, 0), "pose");
  stated[0] = stated[1];  // what the anchor says of itself does not count
  EXPECT_EQ(normalised_pose_errors(estimated, truth, stated, 0).squares.size(), count);
  stated[1].reset();
  EXPECT_EQ(normalised_pose_errors(estimated, truth, stated, 0).squares.size(), count - 1);
  EXPECT_THROW(normalised_pose_errors(estimated, truth, stated, count + 1), Error);
  stated.pop_back();
  EXPECT_THROW(normalised_pose_errors(estimated, truth, stated, 0), Error);
}

TEST(StatedUncertainty, OfASurfaceCountsWhereDataSupportIt) {
  const std::vector<double> deviations_m{1e-3, -2e-3, 5, 1, 1}, errors_m{1e-3, 1e-3, 1e-3, 0, NAN},
      support_m{0, 0.1, 0.2, 0, 0};
  const auto errors = normalised_deviations(deviations_m, errors_m, support_m, 0.1);
  ASSERT_EQ(errors.squares.size(), 2u);
  EXPECT_NEAR(errors.squares[0], 1, 1e-15);
  EXPECT_NEAR(errors.squares[1], 4, 1e-15);
  EXPECT_THROW(normalised_deviations(deviations_m, {}, support_m, 1), Error);
}

}  // namespace
}  // namespace scan
