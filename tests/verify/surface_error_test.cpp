// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Accuracy and completeness of squares and spheres whose errors are known in closed form.
#include "libscan/verify/surface_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/core/random.h"
#include "tests/core/meshes.h"
#include "tests/verify/figure.h"

namespace scan {
namespace {

Mesh rectangle(double width, double height, double z) {
  return {{{0, 0, z}, {width, 0, z}, {width, height, z}, {0, height, z}}, {{0, 1, 2}, {0, 2, 3}}};
}

TrueSurface unit_square() {
  return {{}, {rectangle(1, 1, 0)}};
}

TEST(SurfaceError, OfAShiftedSquareIsTheShift) {
  const auto figures = surface_error(rectangle(1, 1, 0.01), unit_square(),
                                     {.samples = 5000, .f_score_threshold_m = 0.011});
  for (const char* name :
       {"accuracy_mean", "accuracy_rms", "accuracy_p95", "accuracy_max", "completeness_mean",
        "completeness_rms", "completeness_p95", "completeness_max"})
    EXPECT_NEAR(figure(figures, name), 0.01, 1e-14) << name;
  EXPECT_NEAR(figure(figures, "hausdorff"), 0.01, 1e-14);
  EXPECT_EQ(figure(figures, "f_score"), 1);
  EXPECT_NEAR(figure(figures, "normal_error_mean"), 0, 1e-15);
  const auto strict = surface_error(rectangle(1, 1, 0.01), unit_square(),
                                    {.samples = 5000, .f_score_threshold_m = 0.009});
  EXPECT_EQ(figure(strict, "f_score"), 0);
}

// Half of the square is missing: there the distance u is uniform in (0, 1/2), so the mean over all
// is 1/8, the mean square 1/2 * 1/12 and the p95 0.45. Samples are stratified by triangle only, so
// a binomial spread of 1 / sqrt(n) with five standard deviations.
TEST(SurfaceError, OfAHalfMissingSquare) {
  constexpr std::size_t n = 20'000;
  const auto figures = surface_error(rectangle(0.5, 1, 0), unit_square(),
                                     {.samples = n, .f_score_threshold_m = 0.1});
  const double spread = 5 / std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(figure(figures, "accuracy_max"), 0, 1e-15);
  EXPECT_NEAR(figure(figures, "completeness_mean"), 0.125, 0.17 * spread);
  EXPECT_NEAR(figure(figures, "completeness_rms"), std::sqrt(1.0 / 24), 0.2 * spread);
  EXPECT_NEAR(figure(figures, "completeness_p95"), 0.45, 0.22 * spread);
  EXPECT_NEAR(figure(figures, "f_score"), 2 * 0.6 / 1.6, 0.5 * spread);
  // Precision is 1 of n, recall 0.6 +- 1.96 sqrt(0.24 / n); dF / dR = 2 / (1 + R)^2.
  const Measurement f = measurement(figures, "f_score");
  const double drawn = static_cast<double>(f.count) / 2;  // of each surface, doubled up to thrice
  const double width = 2 * 1.96 * std::sqrt(0.24 / drawn) * 2 / 2.56;
  EXPECT_NEAR(f.interval->high - f.interval->low, width, 0.05 * width);
  EXPECT_LT(f.interval->low, 0.75);
  EXPECT_GT(f.interval->high, 0.75);
  EXPECT_EQ(f.over, "samples within 0.1 m, both ways");
  EXPECT_LE(figure(figures, "completeness_max"), 0.5);
}

TEST(SurfaceError, SeenPointsRestrictCompleteness) {
  std::vector<Eigen::Vector3d> seen;
  for (int i = 0; i <= 50; ++i)
    for (int k = 0; k <= 100; ++k) seen.emplace_back(0.01 * i, 0.01 * k, 0);
  const auto figures =
      surface_error(rectangle(0.5, 1, 0), unit_square(),
                    {.samples = 20'000, .seen_points = seen, .seen_distance_m = 0.02});
  EXPECT_LE(figure(figures, "completeness_max"), 0.02);
  const auto share = static_cast<double>(measurement(figures, "completeness_max").count) /
                     static_cast<double>(measurement(figures, "accuracy_max").count);
  EXPECT_NEAR(share, 0.52, 5 * 0.5 / std::sqrt(20'000.0));
  const std::vector<Eigen::Vector3d> elsewhere{{9, 9, 9}};
  EXPECT_THROW(surface_error(rectangle(1, 1, 0), unit_square(),
                             {.samples = 10, .seen_points = elsewhere, .seen_distance_m = 0.1}),
               Error);
}

TEST(SurfaceError, NormalErrorIsTheTilt) {
  Vector6 turn = Vector6::Zero();
  turn(0) = 0.2;
  const Mesh tilted = transformed(exp(turn), rectangle(1, 1, 0));
  EXPECT_NEAR(figure(surface_error(tilted, {{PlacedShape{Pose::Identity(), PlaneShape{}}}, {}},
                                   {.samples = 1000}),
                     "normal_error_mean"),
              0.2, 2e-13);  // the sum of at most 8000 numbers rounds at 8000 * 0.2 * 1e-16
  Mesh flipped = rectangle(1, 1, 0);
  for (Triangle& t : flipped.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(figure(surface_error(flipped, unit_square(), {.samples = 1000}), "normal_error_mean"),
              std::numbers::pi, 1e-12);  // adding 1000 numbers rounds at 1000 * 3 * 2e-16
}

// The default threshold is a hundredth of the diagonal sqrt(2).
TEST(SurfaceError, DefaultThresholdIsAHundredthOfTheDiagonal) {
  const auto score = [](double shift_m) {
    return figure(surface_error(rectangle(1, 1, shift_m), unit_square(), {.samples = 20'000}),
                  "f_score");
  };
  EXPECT_EQ(score(0.0138), 1);
  EXPECT_EQ(score(0.0142), 0);
}

TEST(CloudError, OfPointsAroundASphere) {
  const TrueSurface sphere{{PlacedShape{Pose::Identity(), SphereShape{1}}}, {}};
  PointCloud cloud;
  for (int k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      cloud.points.push_back(side * 1.1 * Eigen::Vector3d::Unit(k));
      cloud.normals.push_back(side * Eigen::Vector3d::Unit(k));
    }
  cloud.points.push_back({0, 0, 0.8});
  cloud.normals.push_back({0, 0, 0});  // unknown
  cloud.points.push_back(Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  cloud.normals.push_back({0, 0, 1});
  const auto figures = cloud_error(cloud, sphere, {.samples = 5000});
  EXPECT_EQ(measurement(figures, "accuracy_mean").count, 7u);
  EXPECT_NEAR(figure(figures, "accuracy_mean"), (6 * 0.1 + 0.2) / 7, 1e-15);
  EXPECT_NEAR(figure(figures, "accuracy_max"), 0.2, 1e-15);
  EXPECT_NEAR(figure(figures, "normal_error_mean"), 0, 1e-15);
  EXPECT_EQ(measurement(figures, "normal_error_mean").count, 6u);
  // farthest from six points on the axes is the diagonal direction: |d - 1.1 e| with d . e = 3^-1/2
  EXPECT_NEAR(figure(figures, "completeness_max"), std::sqrt(1 + 1.21 - 2.2 / std::sqrt(3)), 0.02);
}

TEST(CloudError, WithoutNormalsSaysNothingOfThem) {
  PointCloud cloud;
  cloud.points = {{0, 0, 1}};
  const TrueSurface sphere{{PlacedShape{Pose::Identity(), SphereShape{1}}}, {}};
  EXPECT_THROW(figure(cloud_error(cloud, sphere, {.samples = 100}), "normal_error_mean"),
               std::out_of_range);
}

TEST(SurfaceError, IsTheSameForAnyNumberOfThreads) {
  const TrueSurface ring{{PlacedShape{Pose::Identity(), TorusShape{3, 1}}}, {}};
  std::vector<Measurement> first;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    const auto figures = surface_error(torus(3, 1, 30, 20), ring, {.samples = 5000});
    if (threads == 1) first = figures;
    for (std::size_t i = 0; i < figures.size(); ++i) EXPECT_EQ(figures[i].value, first[i].value);
  }
}

// A grid of 60 x 40 inscribed in the torus: the sagitta of a chord that spans the angle a on a
// circle of radius R is R (1 - cos(a/2)); errors of both directions add at most.
TEST(SurfaceError, OfAFineTorusIsTheSagitta) {
  const TrueSurface ring{{PlacedShape{Pose::Identity(), TorusShape{3, 1}}}, {}};
  const auto figures = surface_error(torus(3, 1, 60, 40), ring, {.samples = 20'000});
  const double pi = std::numbers::pi;
  const double sagitta = 4 * (1 - std::cos(pi / 60)) + 1 - std::cos(pi / 40);
  EXPECT_LE(figure(figures, "accuracy_max"), sagitta);
  EXPECT_GT(figure(figures, "accuracy_max"), sagitta / 3);
  EXPECT_LE(figure(figures, "completeness_max"), sagitta);
}

// Points on a sphere that is 0.3 % too large, far from the origin, against the analytic one.
TEST(CloudError, OfAScaledSphereIsItsGrowth) {
  const Eigen::Vector3d centre(10, -20, 5);
  const TrueSurface sphere{
      {PlacedShape{make_pose(Eigen::Matrix3d::Identity(), centre), SphereShape{2}}}, {}};
  PointCloud cloud;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    RandomStream random(1, 0, i);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    cloud.points.push_back(centre + 2.006 * Eigen::Vector3d(x, y, z).normalized());
  }
  // coordinates of 22 m round at 4e-15 m, which is 1e-12 of 6 mm
  for (const char* name : {"accuracy_mean", "accuracy_rms", "accuracy_median", "accuracy_p95",
                           "accuracy_p997", "accuracy_max"})
    EXPECT_NEAR(figure(cloud_error(cloud, sphere, {.samples = 1000}), name), 6e-3, 2e-14) << name;
}

// The corner that turns farthest out, in closed form (hausdorff_test.cpp has the derivation).
TEST(SurfaceError, OfATurnedBoxHasItsHausdorffDistance) {
  const double t = 0.1;
  const Eigen::Translation3d middle(0.5, 0.5, 0.5);
  const Pose turn(middle * Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()) * middle.inverse());
  const auto figures = surface_error(transformed(turn, cube(1)), {{}, {cube(1)}}, {.samples = 500});
  const double expected = std::sqrt(0.5) * std::sin(std::numbers::pi / 4 + t) - 0.5;
  EXPECT_NEAR(figure(figures, "hausdorff"), expected, 1e-12 * expected);
  EXPECT_LE(measurement(figures, "hausdorff").interval->high, 1.01 * expected);
  EXPECT_LT(figure(figures, "accuracy_max"), expected);
}

TEST(SurfaceError, RefusesNothing) {
  EXPECT_THROW(surface_error(Mesh{}, unit_square()), Error);
  EXPECT_THROW(cloud_error(PointCloud{}, unit_square()), Error);
  EXPECT_THROW(surface_error(rectangle(1, 1, 0), TrueSurface{}), Error);
  EXPECT_THROW(surface_error(rectangle(1, 1, 0), unit_square(), {.samples = 0}), Error);
}

// A grid of points on the square leaves no place of it farther than half a cell's diagonal, 0.036;
// one more point stands exactly at the threshold, and counts.
TEST(CloudError, WhatLiesAtTheThresholdIsWithinIt) {
  PointCloud cloud;
  for (int i = 0; i <= 20; ++i)
    for (int k = 0; k <= 20; ++k) cloud.points.push_back({i / 20.0, k / 20.0, 0});
  cloud.points.push_back({0.5, 0.5, 0.25});
  const auto figures =
      cloud_error(cloud, unit_square(), {.samples = 1000, .f_score_threshold_m = 0.25});
  EXPECT_EQ(figure(figures, "f_score"), 1);
}

// Points of one half are near to the square, the square's other half is far from them, and the
// other way round with one point high above all of it.
TEST(CloudError, HausdorffIsTheFartherOfBothWays) {
  PointCloud cloud;
  for (int i = 0; i <= 10; ++i)
    for (int k = 0; k <= 20; ++k) cloud.points.push_back({i / 20.0, k / 20.0, 0});
  const auto half = cloud_error(cloud, unit_square(), {.samples = 1000});
  EXPECT_EQ(figure(half, "hausdorff"), figure(half, "completeness_max"));
  EXPECT_GT(figure(half, "hausdorff"), 0.4);
  cloud.points.push_back({0.5, 0.5, 2});
  const auto high = cloud_error(cloud, unit_square(), {.samples = 1000});
  EXPECT_EQ(figure(high, "hausdorff"), figure(high, "accuracy_max"));
  EXPECT_NEAR(figure(high, "hausdorff"), 2, 1e-15);
}

// Of distances that are uniform from 0 the 95 % interval of the mean is 2 * 1.96 / sqrt(3 n) = 7 %
// of it wide with 1000 samples and 2.5 % with 8000: more than 2 %, so all three doublings are done.
// Distances that are all equal are known at once.
TEST(SurfaceError, TakesMoreSamplesUntilTheMeansAreKnown) {
  Mesh tilted = rectangle(1, 1, 0);
  tilted.vertices[1].z() = tilted.vertices[2].z() = 0.01;
  EXPECT_EQ(
      measurement(surface_error(tilted, unit_square(), {.samples = 1000}), "accuracy_mean").count,
      8000u);
  EXPECT_EQ(measurement(surface_error(rectangle(1, 1, 0.01), unit_square(), {.samples = 1000}),
                        "accuracy_mean")
                .count,
            1000u);
}

}  // namespace
}  // namespace scan
