// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples go to creases that a fit has rounded off, and noise alone moves none.
#include "libscan/reconstruct/bilateral_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr double spacing = 0.01, sigma = 0.25 * spacing, fitted_length = 1.2 * spacing;
constexpr int side = 80;

struct Case {
  Samples samples;
  FittedSamples fit;
};

// A roof z = -slope |x|, sampled at random with noise along its normals, and a fit of it that
// rounds the ridge off as the hyperbola z = -slope sqrt(x^2 + length^2).
Case roof(double slope, double length) {
  Case result;
  Samples& s = result.samples;
  const Eigen::Vector3d middle(0.5, 0.5, 0.5);
  for (int i = 0; i < side * side; ++i) {
    RandomStream random(1, 0, static_cast<std::uint64_t>(i));
    const double x = (random.uniform() - 0.5) * side * spacing / std::hypot(1, slope);
    const double y = (random.uniform() - 0.5) * side * spacing;
    const double noise = sigma * random.normal();
    const Eigen::Vector3d up = Eigen::Vector3d(std::copysign(slope, x), 0, 1).normalized();
    const Eigen::Vector3d p = Eigen::Vector3d(x, y, -slope * std::abs(x)) + noise * up;
    const double root = std::hypot(p[0], length);
    const Eigen::Vector3d normal = Eigen::Vector3d(slope * p[0] / root, 0, 1).normalized();
    s.points.push_back(middle + p);
    s.normals.push_back(up);
    result.fit.normals.push_back(normal);
    result.fit.residuals.push_back((p[2] + slope * root) * normal[2]);
  }
  s.area.assign(s.points.size(), spacing * spacing);
  s.sigma.assign(s.points.size(), sigma);
  result.fit.length.assign(s.points.size(), fitted_length);
  result.fit.trust.assign(s.points.size(), 1.0);
  return result;
}

std::optional<BilateralSamples> moved(const Case& c, double least_length = 0) {
  return bilateral_samples(c.samples, c.fit, LocalSmoothing(c.samples), least_length);
}

// Mean distance of these points from the roof, of those within three spacings of its ridge.
double mean_distance(const std::vector<Eigen::Vector3d>& points, double slope) {
  double sum = 0, count = 0;
  for (const Eigen::Vector3d& p : points) {
    const double x = std::abs(p[0] - 0.5);
    if (x > 3 * spacing) continue;
    sum += std::abs(p[2] - 0.5 + slope * x) / std::hypot(1, slope);
    count += 1;
  }
  return sum / count;
}

// One-sided averages over pi 3.5^2 / 2 = 19 samples with weights of which as many count in full as
// half of them leave sigma / sqrt(10) = 0.08 spacings; the roof's true mean distance is then 0.06,
// and some samples take the normal of the wrong side. A symmetric average is off by sigma /
// sqrt(19) and the ridge: slope x mean |x| / sqrt(2) = 0.4 spacings at its top.
TEST(BilateralSamples, GoToACreaseThatTheFitRoundsOff) {
  const Case c = roof(1, fitted_length);
  const auto result = moved(c);
  ASSERT_TRUE(result);
  std::vector<Eigen::Vector3d> feet;
  for (std::size_t i = 0; i < c.samples.points.size(); ++i)
    feet.push_back(c.samples.points[i] - c.fit.residuals[i] * c.fit.normals[i]);
  std::vector<Eigen::Vector3d> near_ridge;
  for (std::size_t i = 0; i < feet.size(); ++i)
    if (result->samples.sigma[i] == 0) near_ridge.push_back(result->samples.points[i]);
  EXPECT_LT(mean_distance(near_ridge, 1), 0.1 * spacing);
  EXPECT_LT(mean_distance(near_ridge, 1), 0.5 * mean_distance(feet, 1));
}

// The fit is the plane itself: whatever moves is taken in by chance.
TEST(BilateralSamples, StayWhereThereIsNoiseAlone) {
  Case plane = roof(0, 0);
  plane.fit.length.assign(plane.fit.length.size(), 8 * spacing);
  EXPECT_FALSE(moved(plane));
}

// The greater reach smooths as a length of 6 / (2 sqrt(2 log 2)) = 2.55 spacings does.
TEST(BilateralSamples, AreNotLessSmoothThanAskedFor) {
  const Case c = roof(1, fitted_length);
  EXPECT_TRUE(moved(c, 2.5 * spacing));
  EXPECT_FALSE(moved(c, 2.6 * spacing));
}

TEST(BilateralSamples, StayWhereScatterHidesWhoIsNextToWhom) {
  Case c = roof(1, fitted_length);
  c.samples.sigma.assign(c.samples.sigma.size(), 1.01 * spacing);
  EXPECT_FALSE(moved(c));
}

TEST(BilateralSamples, AreTheSameForAnyNumberOfThreads) {
  const Case c = roof(1, fitted_length);
  const auto many = moved(c);
  const ThreadLimit one_thread(1);
  const auto one = moved(c);
  ASSERT_TRUE(many && one);
  EXPECT_EQ(many->samples.points, one->samples.points);
  EXPECT_EQ(many->samples.normals, one->samples.normals);
  EXPECT_EQ(many->length, one->length);
}

}  // namespace
}  // namespace scan
