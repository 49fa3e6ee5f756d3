// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Samples of true surfaces: on the surface, uniform by area, nothing buried.
//
// Shares of samples are binomial; crossings of one line come in pairs, which at most doubles the
// variance. Limits are five such standard deviations.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "libscan/core/error.h"
#include "libscan/core/parallel.h"
#include "libscan/verify/surface_error.h"
#include "tests/core/meshes.h"

namespace scan {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t count = 40'000;
using Samples = std::vector<SurfaceSample>;
using Operation = CombinedShape::Operation;

PlacedShape at(const Eigen::Vector3d& centre, Shape shape) {
  return {make_pose(Eigen::Matrix3d::Identity(), centre), std::move(shape)};
}

void expect_share(const Samples& samples, double expected,
                  const std::function<bool(const SurfaceSample&)>& belongs, const char* what) {
  double found = 0;
  for (const SurfaceSample& sample : samples) found += belongs(sample);
  const double n = static_cast<double>(samples.size());
  const double sd = std::sqrt(2 * expected * (1 - expected) / n);
  EXPECT_NEAR(found / n, expected, 5 * sd) << what;
}

// Archimedes: area of a sphere is uniform in z; ten slices.
TEST(SampleTruth, IsUniformOnASphere) {
  const PlacedShape sphere = at({3, 4, 5}, SphereShape{2});
  const Samples samples = sample_truth({{sphere}, {}}, count, 1);
  ASSERT_EQ(samples.size(), count);
  for (int slice = 0; slice < 10; ++slice)
    expect_share(samples, 0.1, [&](const SurfaceSample& s) {
      return std::floor((s.point.z() - 3) / 0.4) == slice;
    }, "slice");
  for (const SurfaceSample& s : samples) {
    ASSERT_NEAR((s.point - Eigen::Vector3d(3, 4, 5)).norm(), 2, 1e-14);
    ASSERT_LT((s.normal - (s.point - Eigen::Vector3d(3, 4, 5)) / 2).norm(), 1e-13);
  }
}

// The outer half of a torus has the share 1/2 + r / (pi R) of its area 4 pi^2 R r.
TEST(SampleTruth, IsUniformOnATorus) {
  const Samples samples = sample_truth({{at({0, 0, 0}, TorusShape{0.6, 0.2})}, {}}, count, 2);
  expect_share(samples, 0.5 + 0.2 / (0.6 * pi), [](const SurfaceSample& s) {
    return std::hypot(s.point.x(), s.point.y()) > 0.6;
  }, "outer half");
  expect_share(samples, 0.5, [](const SurfaceSample& s) { return s.point.z() > 0; }, "upper half");
}

// A drilled plate: faces less the hole's discs, sides, and the hole's wall 2 pi r h.
TEST(SampleTruth, IsUniformOnACombination) {
  const double r = 0.2, h = 0.3, discs = 2 * pi * r * r, wall = 2 * pi * r * h;
  const double faces = 2 * 1 * 0.8 - discs, sides = 2 * h * (1 + 0.8);
  const double total = faces + sides + wall;
  const PlacedShape plate =
      at({0, 0, 0}, CombinedShape{Operation::subtract, 0,
                                  {at({0, 0, 0}, BoxShape{{1, 0.8, h}, 0}),
                                   at({0.1, 0, 0}, CylinderShape{r, 1})}});
  const Samples samples = sample_truth({{plate}, {}}, count, 3);
  const auto radius = [](const SurfaceSample& s) {
    return std::hypot(s.point.x() - 0.1, s.point.y());
  };
  expect_share(samples, faces / total, [](const SurfaceSample& s) {
    return std::abs(s.normal.z()) > 0.5;
  }, "faces");
  expect_share(samples, wall / total, [&](const SurfaceSample& s) {
    return radius(s) < r + 1e-9 && std::abs(s.normal.z()) < 0.5;
  }, "wall");
  for (const SurfaceSample& s : samples) {
    ASSERT_NEAR(field(plate, s.point).value_m, 0, 1e-14);
    const bool on_wall = radius(s) < r + 1e-9 && std::abs(s.normal.z()) < 0.5;
    const double outwards = s.normal.x() * (s.point.x() - 0.1) + s.normal.y() * s.point.y();
    ASSERT_FALSE(on_wall && outwards > 0);  // the wall's normal points into the hole
  }
}

TEST(SampleTruth, WeighsPartsByArea) {
  const Samples samples =
      sample_truth({{at({5, 0, 0}, SphereShape{0.5})}, {cube(1), torus(20, 1, 40, 40)}}, count, 4);
  const double sphere = pi, box = 6, ring = area_m2(torus(20, 1, 40, 40));
  const double total = sphere + box + ring;
  expect_share(samples, sphere / total, [](const SurfaceSample& s) {
    return (s.point - Eigen::Vector3d(5, 0, 0)).norm() < 0.6;
  }, "sphere");
  expect_share(samples, ring / total, [](const SurfaceSample& s) { return s.point.norm() > 15; },
               "torus mesh");
}

// Unit spheres at x = -0.6 and 0.6: of each the cap beyond x = 0 is buried, height 0.4 of 2.
TEST(SampleTruth, LeavesOutBuriedSurface) {
  const TrueSurface two{{at({-0.6, 0, 0}, SphereShape{1}), at({0.6, 0, 0}, SphereShape{1})}, {}};
  const Samples samples = sample_truth(two, count, 5);
  ASSERT_EQ(samples.size(), count);
  expect_share(samples, 0.5, [](const SurfaceSample& s) { return s.point.x() < 0; }, "left");
  for (const SurfaceSample& s : samples)
    ASSERT_NEAR((s.point - Eigen::Vector3d(std::copysign(0.6, s.point.x()), 0, 0)).norm(), 1, 1e-13);
  // visible height of each is 1.6, of which 1 lies beyond the centre
  expect_share(samples, 1 / 1.6, [](const SurfaceSample& s) { return std::abs(s.point.x()) > 0.6; },
               "outer halves");
}

// A box that stands on a plane: its foot and the plane below it touch, and nobody sees either.
TEST(SampleTruth, LeavesOutSurfacesInContact) {
  const TrueSurface scene{
      {at({0, 0, 0}, PlaneShape{}), at({0, 0, 0.5}, BoxShape{{1, 1, 1}, 0})}, {}};
  const Bounds region(Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 0.1));
  const Samples samples = sample_truth(scene, count, 6, region);
  for (const SurfaceSample& s : samples) {
    const bool below = s.point.z() < 1e-9 && s.point.head<2>().cwiseAbs().maxCoeff() < 0.5 - 1e-9;
    ASSERT_FALSE(below) << s.point.transpose();
    ASSERT_LE(s.point.cwiseAbs().maxCoeff(), 1 + 1e-12);
  }
  // 2 m x 2 m of plane less the foot of 1, and five faces of the box
  expect_share(samples, 3.0 / 8, [](const SurfaceSample& s) { return s.point.z() < 1e-9; }, "plane");
}

TEST(SampleTruth, IsTheSameForAnyNumberOfThreads) {
  const TrueSurface scene{{at({0, 0, 0}, TorusShape{0.6, 0.2}), at({1, 0, 0}, SphereShape{0.5})}, {}};
  Samples first;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    const Samples samples = sample_truth(scene, 5000, 7);
    if (threads == 1) first = samples;
    for (std::size_t i = 0; i < samples.size(); ++i) ASSERT_EQ(samples[i].point, first[i].point);
  }
}

TEST(SampleTruth, RefusesWhatHasNoSurface) {
  EXPECT_THROW(sample_truth({}, 10, 1), Error);
  EXPECT_THROW(sample_truth({{at({0, 0, 0}, PlaneShape{})}, {}}, 10, 1), Error);
}

}  // namespace
}  // namespace scan
