// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/surface_uncertainty.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libscan/core/error.h"
#include "libscan/reconstruct/ssd.h"
#include "libscan/reconstruct/surface_weights.h"
#include "tests/reconstruct/plane_patch.h"

namespace scan {
namespace {

constexpr int side = 20;

// The same grid seen by two scans.
PointCloud seen_twice() {
  PointCloud cloud = square_points(40, 0.5);
  append(cloud, square_points(40, 0.5));
  cloud.sigma_m.assign(cloud.size(), 1e-3);
  return cloud;
}

CommonErrors of_two_scans(const PointCloud& cloud) {
  CommonErrors common;
  for (std::size_t i = 0; i < cloud.size(); ++i) common.scan.push_back(i >= cloud.size() / 2);
  common.poses.scans.assign(2, StatedPose{});
  return common;
}

SurfaceVariance at_middle(const PointCloud& cloud, const CommonErrors& common) {
  return surface_variances(smoothed_square(side, 1), cloud, common)[middle_of(side)];
}

// Half of the weight is each scan's. Only shifts along the normal count at the middle; what the
// second scan shares with the first counts twice, and what is not known as much as it may.
TEST(SurfaceVariances, OfPosesCountWhatTheyShare) {
  const PointCloud cloud = seen_twice();
  CommonErrors common = of_two_scans(cloud);
  EXPECT_EQ(at_middle(cloud, common).poses_m2, 0);
  Matrix6 shift = Matrix6::Zero();
  shift.diagonal() << 0, 0, 0, 7, 8, 4;
  common.poses.scans[1]->covariance = shift;
  EXPECT_NEAR(at_middle(cloud, common).poses_m2, 1, 1e-9);  // 4 / 2^2, the other is held
  common.poses.scans[0]->covariance = shift;
  EXPECT_NEAR(at_middle(cloud, common).poses_m2, 4, 1e-9);
  common.poses.between = {{0, 1, Matrix6::Zero()}};
  EXPECT_NEAR(at_middle(cloud, common).poses_m2, 2, 1e-9);
  common.poses.between[0].covariance(5, 5) = -4;  // against one another
  EXPECT_NEAR(at_middle(cloud, common).poses_m2, 0, 1e-9);
  common.poses.scans.push_back(common.poses.scans[0]);  // of a third scan that has no points here
  common.poses.between[0].second = 2;
  EXPECT_NEAR(at_middle(cloud, common).poses_m2, 4, 1e-9);  // not of these two
  common.poses.scans[0].reset();
  EXPECT_EQ(at_middle(cloud, common).poses_m2, std::numeric_limits<double>::infinity());
}

// Turns drawn from a full covariance about a place off the plane move the weighed points as stated:
// a variance over 4000 draws is right to 1 / sqrt(2000) = 2.2 %, three of them 7 %.
TEST(SurfaceVariances, OfPosesAreThoseOfDrawnMotions) {
  const PointCloud cloud = seen_twice();
  CommonErrors common = of_two_scans(cloud);
  Eigen::Matrix<double, 12, 12> root;
  RandomStream random(5, 0, 0);
  for (int i = 0; i < 144; ++i) root(i / 12, i % 12) = 1e-4 * random.normal();
  const Eigen::Matrix<double, 12, 12> covariance = root * root.transpose();
  for (int s = 0; s < 2; ++s)
    common.poses.scans[std::size_t(s)] =
        StatedPose{covariance.block<6, 6>(6 * s, 6 * s), {3, -2.0 + s, 5}};
  common.poses.between = {{0, 1, covariance.block<6, 6>(0, 6)}};
  const SurfaceResult square = smoothed_square(side, 1);
  const std::size_t v = middle_of(side) + 4;
  const double stated = surface_variances(square, cloud, common)[v].poses_m2;
  const auto weights = SurfaceWeights(square.surface, square.vertex_smoothing_m, cloud).at(v);
  double squares = 0;
  constexpr int draws = 4000;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::Matrix<double, 12, 1> white;
    for (double& one : white) one = random.normal();
    const Eigen::Matrix<double, 12, 1> twists = root * white;
    double moved = 0;
    for (const WeighedPoint& p : weights) {
      const std::size_t s = common.scan[p.point];
      const Eigen::Translation3d centre(common.poses.scans[s]->centre);
      const Pose motion = centre * exp(twists.segment<6>(6 * Eigen::Index(s))) * centre.inverse();
      moved += p.weight * (motion * cloud.points[p.point] - cloud.points[p.point]).z();
    }
    squares += moved * moved / draws;
  }
  EXPECT_NEAR(squares / stated, 1, 0.07);
}

// A covariance that leaves out what moves the surface here may say less than nothing of it.
TEST(SurfaceVariances, OfPosesAreNumbersDespiteRounding) {
  const PointCloud cloud = seen_twice();
  CommonErrors common = of_two_scans(cloud);
  common.poses.scans[0]->covariance(5, 5) = -1e-20;
  common.poses.scans[1]->covariance(5, 5) = 4;
  EXPECT_NEAR(at_middle(cloud, common).poses_m2, 1, 1e-9);
}

// Means over windows of white noise, drawn, against the stated variance: of 2000 draws three
// standard deviations of a variance are 9.5 %. Told nothing of windows it is that of points of
// their own.
TEST(SurfaceVariances, OfSharedNoiseAreThoseOfDrawnWindows) {
  constexpr int points = 40, window = 5, wide = points + window - 1;
  PointCloud cloud = square_points(points, 0.5);
  cloud.sigma_m.assign(cloud.size(), 1e-3);
  CommonErrors common;
  for (int i = 0; i < points * points; ++i)
    common.in_windows.emplace_back(double(i / points) / window, double(i % points) / window);
  const SurfaceResult square = smoothed_square(side, 1);
  const std::size_t v = middle_of(side);
  const double stated = surface_variances(square, cloud, common)[v].points_m2;
  const auto weights = SurfaceWeights(square.surface, square.vertex_smoothing_m, cloud).at(v);
  double squares = 0, own = 0;
  for (const WeighedPoint& p : weights) own += 1e-6 * p.weight * p.weight;
  RandomStream random(6, 0, 0);
  constexpr int draws = 2000;
  std::vector<double> white(wide * wide);
  for (int draw = 0; draw < draws; ++draw) {
    for (double& one : white) one = random.normal();
    double sum = 0;
    for (const WeighedPoint& p : weights)
      for (int i = 0; i < window * window; ++i)
        sum += p.weight * 1e-3 / window *
               white[(p.point / points + i / window) * wide + p.point % points + i % window];
    squares += sum * sum / draws;
  }
  EXPECT_NEAR(stated / squares, 1, 0.095);
  EXPECT_NEAR(surface_variances(square, cloud, {})[v].points_m2, own, 1e-12 * own);
  EXPECT_GT(stated, 5 * own);
}

// Two scans that saw the same, half of the weight each: what the points of one share is halved, and
// nothing is shared between them, wherever their windows begin and end.
TEST(SurfaceVariances, OfSharedNoiseAreEachScansOwn) {
  const PointCloud once = square_points(40, 0.5), twice = seen_twice();
  CommonErrors one, two = of_two_scans(twice);
  for (const int rows : {5, 100}) {  // in the end all are within one window's rows
    one.in_windows.clear();
    for (int i = 0; i < 1600; ++i)
      one.in_windows.emplace_back(double(i / 40) / rows, double(i % 40) / 5);
    two.in_windows = one.in_windows;
    two.in_windows.insert(two.in_windows.end(), one.in_windows.begin(), one.in_windows.end());
    PointCloud cloud = once;
    cloud.sigma_m.assign(cloud.size(), 1e-3);
    const double of_one = at_middle(cloud, one).points_m2;
    EXPECT_NEAR(at_middle(twice, two).points_m2, of_one / 2, 1e-9 * of_one) << rows;
  }
}

// Noise along the ray moves a surface that it meets at 60 degrees by half.
TEST(SurfaceVariances, OfPointsAreTakenAcrossTheSurface) {
  PointCloud cloud = seen_twice();
  const double along = at_middle(cloud, {}).points_m2;
  const Eigen::Vector3d ray(std::sqrt(0.75), 0, 0.5);
  cloud.covariances.assign(cloud.size(), 1e-6 * ray * ray.transpose());
  EXPECT_NEAR(at_middle(cloud, {}).points_m2, along / 4, 1e-9 * along);
  cloud.covariances.clear();
  cloud.sigma_m.clear();  // then each point errs by what the surface says of all
  SurfaceResult square = smoothed_square(side, 1);
  square.sigma_m = 2e-3;
  EXPECT_NEAR(surface_variances(square, cloud, {})[middle_of(side)].points_m2, 4 * along,
              1e-9 * along);
}

// Rays of a grid of ten columns in windows of 2 rows and 5 columns; a scan that does not know its
// rays shares no noise.
TEST(CommonErrors, PlaceRaysInTheirWindows) {
  std::vector<Scan> scans(2);
  scans[0].cloud.points.assign(2, Eigen::Vector3d::Zero());
  scans[0].ray = {7, 31};
  scans[0].grid = {9, 10};
  scans[1].cloud.points.assign(3, Eigen::Vector3d::Zero());
  EXPECT_TRUE(common_errors(scans, {}).in_windows.empty());
  scans[0].noise_window = {2, 5};
  const CommonErrors common = common_errors(scans, {});
  EXPECT_EQ(common.scan, (std::vector<std::uint32_t>{0, 0, 1, 1, 1}));
  EXPECT_EQ(common.in_windows[0], Eigen::Vector2d(0, 7.0 / 5));
  EXPECT_EQ(common.in_windows[1], Eigen::Vector2d(3.0 / 2, 1.0 / 5));
  EXPECT_GE(common.in_windows[4].x() - common.in_windows[3].x(), 1);
  scans[1].noise_window = {4, 4};  // which tells nothing without rays
  EXPECT_EQ(common_errors(scans, {}).in_windows, common.in_windows);
}

TEST(SurfaceVariances, RefuseListsThatDoNotFit) {
  const PointCloud cloud = seen_twice();
  CommonErrors common = of_two_scans(cloud);
  common.poses.scans.resize(1);
  EXPECT_THROW(at_middle(cloud, common), Error);
  common = of_two_scans(cloud);
  common.scan.pop_back();
  EXPECT_THROW(at_middle(cloud, common), Error);
}

// Points that are not finite are left out with what belongs to them; a surface without smoothing
// lengths keeps what it has.
TEST(StandardErrors, SpareBrokenPointsAndOtherMethods) {
  PointCloud cloud = seen_twice();
  CommonErrors common = of_two_scans(cloud);
  common.poses.scans[1]->covariance = 1e-6 * Matrix6::Identity();
  for (std::size_t i = 0; i < cloud.size(); ++i) common.in_windows.emplace_back(0.2 * double(i), 0);
  SurfaceResult whole = smoothed_square(side, 1), broken = whole, other = whole;
  add_standard_errors(whole, cloud, common);
  cloud.points.insert(cloud.points.begin(), {0, 0, std::nan("")});
  cloud.normals.insert(cloud.normals.begin(), Eigen::Vector3d::UnitZ());
  cloud.sigma_m.insert(cloud.sigma_m.begin(), 1);
  common.scan.insert(common.scan.begin(), 1);
  common.in_windows.insert(common.in_windows.begin(), {7, 7});
  add_standard_errors(broken, cloud, common);
  EXPECT_EQ(broken.standard_error_m, whole.standard_error_m);
  other.vertex_smoothing_m.clear();
  other.standard_error_m = {1, 2};
  add_standard_errors(other, cloud, common);
  EXPECT_EQ(other.standard_error_m, (std::vector<double>{1, 2}));
}

struct Coverage {
  double inside = 0, square = 0;
};

// Fits to spheres of `seeds` draws.
Coverage of_spheres(std::uint64_t seeds, double sigma_m) {
  Coverage coverage;
  double count = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    PointCloud cloud = sphere_cloud(8000, 1, seed);
    RandomStream random(seed, 1, 0);
    for (std::size_t i = 0; i < cloud.size(); ++i)
      cloud.points[i] += sigma_m * random.normal() * cloud.normals[i];
    cloud.sigma_m.assign(cloud.size(), sigma_m);
    SurfaceResult result = ssd(cloud);
    add_standard_errors(result, cloud, {});
    for (std::size_t v = 0; v < result.standard_error_m.size(); ++v, ++count) {
      const double ratio = (result.surface.vertices[v].norm() - 1) / result.standard_error_m[v];
      coverage.square += ratio * ratio;
      coverage.inside += ratio * ratio <= 3.8415;
    }
  }
  coverage.inside /= count, coverage.square /= count;
  return coverage;
}

// Some 150 patches a sphere err on their own: over four the share is certain to 2 * sqrt(0.95 *
// 0.05 / 600) = 1.8 %, the mean square to 3 * sqrt(2 / 600) = 0.17. What smoothing took counts the
// noise of the residuals too, up to half of V here, where there is next to nothing to take: of 1.5
// V that is a third less.
TEST(StandardErrors, CoverSpheres) {
  const Coverage coverage = of_spheres(4, 0.01);
  RecordProperty("inside", std::to_string(coverage.inside));
  RecordProperty("square", std::to_string(coverage.square));
  EXPECT_NEAR(coverage.inside, 0.955, 0.025);
  EXPECT_GT(coverage.square, 0.67 - 0.17);
  EXPECT_LT(coverage.square, 1 + 0.17);
}

}  // namespace
}  // namespace scan
