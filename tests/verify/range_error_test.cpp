// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Range errors of a handful of rays, counted by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "libscan/verify/surface_error.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

// Three rays hit at ranges 2, 5 and 3 m; the fourth hits nothing.
ScanTruth truth() {
  ScanTruth t;
  t.name = "000";
  t.rays.resize(4);
  t.rays[0] = {{0, 0, 2}, {0, 0, -1}, 0};
  t.rays[1] = {{3, 0, 4}, {0, 0, -1}, 0};
  t.rays[2] = {{0, 3, 0}, {0, -1, 0}, 1};
  return t;
}

TEST(RangeError, CountsByHand) {
  PointCloud cloud;
  cloud.points = {{0, 0, 2.01}, {2.988, 0, 3.984}, {9, 9, 9}};  // +0.01, -0.02, no true hit
  cloud.sigma_m = {0.01, 0.01, 0.01};
  const std::vector<std::uint32_t> ray{0, 1, 3};
  const auto figures = range_error(cloud, ray, truth());
  EXPECT_NEAR(figure(figures, "range_error_bias"), -0.005, 1e-15);
  EXPECT_NEAR(figure(figures, "range_error_rms"), std::sqrt(5e-4 / 2), 1e-15);
  EXPECT_NEAR(figure(figures, "range_error_p95"), 0.02, 1e-15);
  EXPECT_NEAR(figure(figures, "ray_hit_fraction"), 2.0 / 3, 1e-15);
  EXPECT_NEAR(figure(figures, "normalised_range_error_rms"), std::sqrt(5.0 / 2), 1e-13);
}

TEST(RangeError, CountsOnlyTheComponentAlongTheRay) {
  PointCloud cloud;
  cloud.points = {{0.5, 0, 2}};
  const std::vector<std::uint32_t> ray{0};
  EXPECT_EQ(figure(range_error(cloud, ray, truth()), "range_error_rms"), 0);
}

TEST(RangeError, TakesTheFirstReturnOfARay) {
  PointCloud cloud;
  cloud.points = {{0, 0, 7}, {0, 0, 2.5}, {0, 0, 4}};
  const std::vector<std::uint32_t> ray{0, 0, 0};
  const auto figures = range_error(cloud, ray, truth());
  EXPECT_DOUBLE_EQ(figure(figures, "range_error_bias"), 0.5);
  EXPECT_NEAR(figure(figures, "ray_hit_fraction"), 1.0 / 3, 1e-15);
}

// The device measures along (0, 0.6, 0.8), not along the ray: the error is three of its sigmas
// there, whatever sigma along the ray would make of it.
TEST(RangeError, IsNormalisedAlongTheCovariancesAxis) {
  PointCloud cloud;
  const Eigen::Vector3d line(0, 0.6, 0.8);
  cloud.points = {Eigen::Vector3d(0, 0, 2) + 0.03 * line};
  cloud.sigma_m = {0.02};
  cloud.covariances = {1e-4 * line * line.transpose()};
  const auto figures = range_error(cloud, std::vector<std::uint32_t>{0}, truth());
  EXPECT_NEAR(figure(figures, "range_error_rms"), 0.024, 1e-15);
  EXPECT_NEAR(figure(figures, "normalised_range_error_rms"), 3, 1e-12);
  EXPECT_EQ(figure(figures, "range_error_within_95"), 0);
}

TEST(RangeError, WithoutSigmaSaysNothingOfIt) {
  PointCloud cloud;
  cloud.points = {{0, 0, 2}};
  const std::vector<std::uint32_t> ray{0};
  EXPECT_THROW(figure(range_error(cloud, ray, truth()), "normalised_range_error_rms"),
               std::out_of_range);
}

TEST(RangeError, RefusesARayThatTheTruthLacks) {
  PointCloud cloud;
  cloud.points = {{0, 0, 2}};
  EXPECT_THROW(range_error(cloud, std::vector<std::uint32_t>{4}, truth()), Error);
  EXPECT_THROW(range_error(cloud, std::vector<std::uint32_t>{}, truth()), Error);
}

}  // namespace
}  // namespace scan
