// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples go to creases that a fit has rounded off, and stay where the fit is as near.
#include "libscan/reconstruct/bilateral_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/reconstruct.h"
#include "tests/reconstruct/solids.h"

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
    result.fit.feet.push_back(middle + p - (p[2] + slope * root) * normal[2] * normal);
  }
  s.area.assign(s.points.size(), spacing * spacing);
  s.sigma.assign(s.points.size(), sigma);
  result.fit.length.assign(s.points.size(), fitted_length);
  result.fit.trust.assign(s.points.size(), 1.0);
  return result;
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

// Where the fit smooths over four spacings averages reach over 12.8 and count as 5 pi R^2 / 9 = 286
// samples: 0.8 x 0.25 / sqrt(286) leaves a mean distance of 0.012 spacings, six spacings 0.025. The
// fit stands half a spacing below the plane, so that any average is better. Of samples farther from
// the plane's end than that some 30 share no neighbours: chance moves that by a seventh.
TEST(BilateralSamples, AverageAsFarAsTheFitSmooths) {
  Case plane = roof(0, 0);
  for (Eigen::Vector3d& foot : plane.fit.feet) foot[2] -= spacing / 2;
  plane.fit.length.assign(plane.fit.length.size(), 4 * spacing);
  const auto moved = bilateral_samples(plane.samples, plane.fit);
  ASSERT_TRUE(moved);
  double sum = 0, count = 0;
  for (const Eigen::Vector3d& p : moved->points) {
    if ((p - Eigen::Vector3d(0.5, 0.5, p[2])).cwiseAbs().maxCoeff() > (side / 2 - 13) * spacing)
      continue;
    sum += std::abs(p[2] - 0.5);
    count += 1;
  }
  EXPECT_LT(sum / count, 0.018 * spacing);
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

// Half a plane, then waves of wave number k and height h that begin with slope 0.
double height_of_waves(double x, double h, double k) {
  return x > 0.5 ? h * (1 - std::cos(k * (x - 0.5))) : 0;
}

// As the roof; its fit lies half a spacing below, so that any average is better.
Case waves(double h, double k, double length) {
  Case result = roof(0, 0);
  for (std::size_t i = 0; i < result.samples.points.size(); ++i) {
    Eigen::Vector3d &p = result.samples.points[i], &foot = result.fit.feet[i];
    const double slope = p[0] > 0.5 ? h * k * std::sin(k * (p[0] - 0.5)) : 0;
    const double up = height_of_waves(p[0], h, k);
    p[2] += up;
    foot = {p[0], p[1], 0.5 + up - spacing / 2};
    result.samples.normals[i] = result.fit.normals[i] = Eigen::Vector3d(-slope, 0, 1).normalized();
  }
  result.fit.length.assign(result.samples.points.size(), length);
  return result;
}

// Heights off the waves, in the mean over the samples from x to x + 20 spacings and away from the
// sides.
double mean_off_waves(const std::vector<Eigen::Vector3d>& points, double h, double k, double x) {
  double sum = 0, count = 0;
  for (const Eigen::Vector3d& p : points) {
    const double along = (p[0] - x) / spacing;
    if (along < 0 || along > 20 || std::abs(p[1] - 0.5) > (side / 2 - 7) * spacing) continue;
    sum += std::abs(p[2] - 0.5 - height_of_waves(p[0], h, k));
    count += 1;
  }
  return sum / count;
}

// What averages of reach R take from waves of height h, in the mean over their sines. A biweight
// passes a = 48 J_3(x) / x^3 of waves of k R = x, two rounds a^2 of their slopes; the mean of (n_i
// + n_j) / 2 . (p_j - p_i) then leaves a - a^2 x a' / 2 of their height, a' = -48 J_4(x) / x^3.
double taken(double h, double x) {
  const double a = 48 * std::cyl_bessel_j(3, x) / std::pow(x, 3);
  const double left = a + a * a * 24 * std::cyl_bessel_j(4, x) / (x * x);
  return h * (1 - left) * 2 / std::numbers::pi;
}

// The full reach takes 0.16 spacings, of which weights by normals, 30 degrees apart here, give half
// back; half of it takes 0.02 and leaves 0.05 of noise: below 0.4 of what the full one takes. On
// the plane that leaves 0.025 of noise, 1/sqrt(2) of it 0.035: there 1300 samples are some 20
// averages, so that chance moves the mean by an eighth of it.
TEST(BilateralSamples, ReachLessFarWhereTheSurfaceCurves) {
  const double k = 3.5 / (6 * spacing), h = 0.5 * spacing;
  const Case c = waves(h, k, fitted_length);
  const auto moved = bilateral_samples(c.samples, c.fit);
  ASSERT_TRUE(moved);
  EXPECT_LT(mean_off_waves(moved->points, h, k, 0.5 + 15 * spacing), 0.4 * taken(h, 3.5));
  EXPECT_LT(mean_off_waves(moved->points, h, k, 0.5 - 35 * spacing), 0.03 * spacing);
}

// Lengths of 4 spacings reach over 12.8. Where scatter is said to be above a spacing all of it
// stays.
TEST(BilateralSamples, ReachAsFarAsEverWhereScatterHidesWhoIsNextToWhom) {
  const double k = 3.5 / (12.8 * spacing), h = 1.2 * spacing;
  Case c = waves(h, k, 4 * spacing);
  for (Eigen::Vector3d& foot : c.fit.feet) foot[2] -= 2 * spacing;
  for (const auto& [spacings, is_shorter] : {std::pair(0.99, true), {1.01, false}}) {
    c.samples.sigma.assign(c.samples.sigma.size(), spacings * spacing);
    const auto moved = bilateral_samples(c.samples, c.fit);
    ASSERT_TRUE(moved);
    EXPECT_EQ(mean_off_waves(moved->points, h, k, 0.5 + 15 * spacing) < 0.4 * taken(h, 3.5),
              is_shorter)
        << spacings;
  }
}

// No neighbour's normal agrees with these samples', which are their own averages: they go to the
// fit among waves, where averages are short, and stay on the plane.
TEST(BilateralSamples, GoToTheFitWhereShortAveragesAreTheirOwn) {
  const double k = 3.5 / (6 * spacing), h = 0.5 * spacing;
  Case c = waves(h, k, fitted_length);
  std::size_t on_plane = 0, on_waves = 0;
  for (std::size_t i = 0; i < c.samples.points.size(); ++i) {
    const Eigen::Vector3d off = (c.samples.points[i] - Eigen::Vector3d(0.5, 0.5, 0.5)) / spacing;
    if (std::abs(off[1]) > 20) continue;
    if (std::abs(off[0] + 25) < 5) on_plane = i;
    if (std::abs(off[0] - 25) < 5) on_waves = i;
  }
  for (const std::size_t i : {on_plane, on_waves}) c.fit.normals[i] = Eigen::Vector3d::UnitY();
  const auto moved = bilateral_samples(c.samples, c.fit);
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->points[on_waves], c.fit.feet[on_waves]);
  EXPECT_EQ(moved->points[on_plane], c.samples.points[on_plane]);
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
