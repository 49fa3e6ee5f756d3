// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples go to creases that a fit has rounded off, and stay where the fit is as near.
#include "libscan/reconstruct/bilateral_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/reconstruct.h"
#include "tests/reconstruct/bilateral_cases.h"
#include "tests/reconstruct/solids.h"

namespace scan {
namespace {

using namespace bilateral;

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

// Biweights within R of a plane count as 5 pi R^2 / 9 = 63 samples in full, beside a crease as half
// of these: 0.25 / sqrt(31) leaves a mean distance of 0.036 spacings, and some samples at the ridge
// take the normal of the wrong side. Averages over both sides are off by slope x mean |x| /
// sqrt(2), 1 spacing at the top.
TEST(BilateralSamples, GoToACreaseThatTheFitRoundsOff) {
  const Case c = roof(1, fitted_length);
  const auto moved = bilateral_samples(c.samples, c.fit);
  ASSERT_TRUE(moved);
  EXPECT_LT(mean_distance(moved->points, 1), 0.1 * spacing);
  EXPECT_LT(mean_distance(moved->points, 1), 0.5 * mean_distance(c.fit.feet, 1));
}

// The fit is the plane itself.
TEST(BilateralSamples, StayWhereThereIsNoiseAlone) {
  Case plane = roof(0, 0);
  plane.fit.length.assign(plane.fit.length.size(), 8 * spacing);
  EXPECT_FALSE(bilateral_samples(plane.samples, plane.fit));
}

// Every 50th sample lies 30 sigma off, where the fit rightly leaves it: its residual is no loss.
TEST(BilateralSamples, StayWhereTheFitLeavesStraysBehind) {
  Case plane = roof(0, 0);
  plane.fit.length.assign(plane.fit.length.size(), 8 * spacing);
  for (std::size_t i = 0; i < plane.samples.points.size(); i += 50) {
    plane.samples.points[i][2] += 30 * sigma;
    plane.fit.trust[i] = 1e-4;
  }
  EXPECT_FALSE(bilateral_samples(plane.samples, plane.fit));
}

TEST(BilateralSamples, StayWhereScatterIsTooSmallOrHidesWhoIsNextToWhom) {
  Case c = roof(1, fitted_length);
  for (const auto& [spacings, moves] :
       {std::pair(0.09, false), {0.11, true}, {1.99, true}, {2.01, false}}) {
    c.samples.sigma.assign(c.samples.sigma.size(), spacings * spacing);
    EXPECT_EQ(bilateral_samples(c.samples, c.fit).has_value(), moves) << spacings;
  }
}

TEST(BilateralSamples, AreTheSameForAnyNumberOfThreads) {
  const Case c = roof(1, fitted_length);
  const auto many = bilateral_samples(c.samples, c.fit);
  const ThreadLimit one_thread(1);
  const auto one = bilateral_samples(c.samples, c.fit);
  ASSERT_TRUE(many && one);
  EXPECT_EQ(many->points, one->points);
  EXPECT_EQ(many->normals, one->normals);
}

// The two sheets of a plate half a spacing thick, sampled without noise where the fit merged them
// half way: neighbours' normals tell the sides apart, and each stays on its own.
TEST(BilateralSamples, KeepTheSidesOfAThinPlateApart) {
  Case plate = roof(0, 0);
  for (std::size_t i = 0; i < plate.samples.points.size(); ++i) {
    const double up = i % 2 == 0 ? 1 : -1;
    Eigen::Vector3d& p = plate.samples.points[i];
    p[2] = 0.5 + up * spacing / 4;
    plate.fit.feet[i] = {p[0], p[1], 0.5};
    plate.fit.normals[i] = {0, 0, up};
  }
  const auto moved = bilateral_samples(plate.samples, plate.fit);
  ASSERT_TRUE(moved);
  for (std::size_t i = 0; i < moved->points.size(); ++i)
    ASSERT_NEAR(moved->points[i][2], plate.samples.points[i][2], 1e-12) << i;
}

// (n_i + n_j) . (p_j - p_i) is 0 for any two places of a sphere, summed in grains or not; averages
// along n_i alone would be d^2 / (2 radius) off, whose mean over a biweight of reach R is R^2 / (8
// radius): 0.15 and 0.68 spacings for the two lengths. Normals averaged over chance samples lean by
// some hundredths, which leaves as much of that. The fit stands a quarter of a spacing inside,
// which costs it all of its risk.
TEST(BilateralSamples, DoNotTakeCurvatureForNoise) {
  Case ball = roof(0, 0);
  const Eigen::Vector3d middle(0.5, 0.5, 0.5);
  for (std::size_t i = 0; i < ball.samples.points.size(); ++i) {
    RandomStream random(2, 0, i);
    const double x = random.normal(), y = random.normal(), z = random.normal();
    const Eigen::Vector3d n = Eigen::Vector3d(x, y, z).normalized();
    ball.samples.points[i] = middle + 0.3 * n;
    ball.fit.feet[i] = middle + (0.3 - spacing / 4) * n;
    ball.fit.normals[i] = n;
  }
  for (const auto& [length, along_own_normal] : {std::pair(1.2, 0.15), {4.0, 0.68}}) {
    ball.fit.length.assign(ball.fit.length.size(), length * spacing);
    const auto moved = bilateral_samples(ball.samples, ball.fit);
    ASSERT_TRUE(moved);
    double sum = 0;
    for (const Eigen::Vector3d& p : moved->points) sum += std::abs((p - middle).norm() - 0.3);
    EXPECT_LT(sum / static_cast<double>(moved->points.size()), 0.1 * along_own_normal * spacing)
        << length;
  }
}

double mean_from_cube(const Mesh& mesh) {
  double sum = 0;
  for (const auto& x : mesh.vertices) sum += std::abs(from_cube(x));
  return sum / static_cast<double>(mesh.vertices.size());
}

// 63 samples leave a mean distance of 0.8 x 0.25 / sqrt(63) = 0.025 spacings on the faces, half of
// them 0.036 beside the edges, and these are rounded off a little: below twice that of faces.
TEST(BilateralSamples, BringTheSurfaceNearerToANoisyCube) {
  const double cube_spacing = std::sqrt(6.0 / 12000);
  const PointCloud cloud = scattered(cube_cloud(12000), 0.25 * cube_spacing);
  const SurfaceResult round = reconstruct(cloud, {}),
                      sharp = reconstruct(cloud, {}, {.sharp = true});
  EXPECT_LT(mean_from_cube(sharp.surface), 0.05 * cube_spacing);
  EXPECT_LT(mean_from_cube(sharp.surface), 0.75 * mean_from_cube(round.surface));
  const EdgeCensus census = edge_census(sharp.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 0);
  EXPECT_EQ(sharp.standard_error_m.size(), sharp.surface.vertices.size());
  EXPECT_GT(sharp.moved_points, cloud.size() * 9 / 10);
  EXPECT_EQ(round.moved_points, 0u);
  const SurfaceResult chosen = reconstruct(cloud, {}, {.method = ReconstructMethod::automatic});
  EXPECT_EQ(chosen.moved_points, sharp.moved_points);
  EXPECT_LT(mean_from_cube(chosen.surface), 0.75 * mean_from_cube(round.surface));
}

// A long smoothing is better than averages, and at half a spacing of scatter as good, if distances
// are told to more than first order: bytes stay.
TEST(BilateralSamples, LeaveANoisyTorusAsItWas) {
  for (const double scatter_m : {0.01, 0.0194}) {
    const PointCloud cloud = scattered(torus_cloud(8000), scatter_m);
    const SurfaceResult plain = reconstruct(cloud, {}),
                        sharp = reconstruct(cloud, {}, {.sharp = true});
    EXPECT_GT(plain.sigma_m, scatter_m / 2);
    EXPECT_EQ(sharp.moved_points, 0u) << scatter_m;
    EXPECT_EQ(sharp.surface.vertices, plain.surface.vertices);
    EXPECT_EQ(sharp.surface.triangles, plain.surface.triangles);
  }
}

}  // namespace
}  // namespace scan
