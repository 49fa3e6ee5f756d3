// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/error.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr double eps = 2.3e-16;

// A grid of rays through a pinhole of focal length 100, each point at depth(column, row).
template <class Depth>
Scan grid_scan(int rows, int columns, Depth&& depth) {
  Scan scan;
  scan.grid = {static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(columns)};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      scan.ray.push_back(static_cast<std::uint32_t>(r * columns + c));
      const Eigen::Vector3d ray((c - columns / 2) / 100.0, (r - rows / 2) / 100.0, 1);
      scan.cloud.points.push_back(depth(ray) * ray);
    }
  return scan;
}

auto plane(const Eigen::Vector3d& normal, double offset_m) {
  return [=](const Eigen::Vector3d& ray) { return offset_m / normal.dot(ray); };
}

// Rounding of coordinates of 2 m over a neighbourhood of 0.03 m.
TEST(Normals, AreThoseOfThePlane) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  for (const bool grid : {true, false}) {
    Scan scan = grid_scan(20, 30, plane(normal, 1.5));
    if (!grid) scan.grid = {};
    estimate_normals(scan);
    for (const auto& found : scan.cloud.normals)
      EXPECT_LT((found + normal).norm(), 100 * eps * 2 / 0.03);  // towards the scanner: -normal
  }
}

// A fit over a cap of radius a on a sphere of radius R: neighbours are not quite symmetric about
// the point; tilt below a / R = 0.02, in the mean well below half of it.
TEST(Normals, AreThoseOfTheSphere) {
  RandomStream random(51, 0, 0);
  Scan scan;
  for (int i = 0; i < 20'000; ++i)
    scan.cloud.points.push_back(
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  estimate_normals(scan);
  double mean = 0;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    const double cosine =
        scan.cloud.normals[i].dot(-scan.cloud.points[i]);  // viewpoint: the centre
    EXPECT_GT(cosine, std::cos(0.05));
    mean += std::acos(std::min(cosine, 1.0)) / 20'000;
  }
  EXPECT_LT(mean, 0.01);
}

TEST(Normals, TurnTowardsEachPointsViewpoint) {
  Scan scan = grid_scan(10, 10, plane({0, 0, 1}, 1));
  std::vector<Eigen::Vector3d> viewpoints(100, Eigen::Vector3d::Zero());
  for (int i = 50; i < 100; ++i) viewpoints[i] = {0, 0, 3};
  estimate_normals(scan, {}, viewpoints);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(scan.cloud.normals[i].z(), i < 50 ? -1 : 1, 1e-12);
}

TEST(Normals, TurnTowardsTheScansViewpoint) {
  for (const bool grid : {true, false})
    for (const double side : {-1.0, 1.0}) {
      Scan scan = grid_scan(10, 10, plane({0, 0, 1}, 1));
      if (!grid) scan.grid = {};
      scan.viewpoint = {0, 0, 100 * side};
      estimate_normals(scan);
      for (const auto& normal : scan.cloud.normals) EXPECT_NEAR(normal.z(), side, 1e-12);
    }
}

// Steps ten times as far apart as the pixels of a step: nearest points would be one line.
TEST(Normals, UseBothDirectionsOfTheGrid) {
  Scan scan;
  scan.grid = {12, 40};
  for (int r = 0; r < 12; ++r)
    for (int c = 0; c < 40; ++c) {
      scan.ray.push_back(static_cast<std::uint32_t>(r * 40 + c));
      scan.cloud.points.emplace_back(0.01 * r, 0.001 * c, 1 + 0.002 * r + 0.0003 * c);
    }
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, 0.3, -1).normalized();
  estimate_normals(scan);
  for (const auto& found : scan.cloud.normals) EXPECT_LT((found - normal).norm(), 1e-9);
}

// Two walls, 1 m and 2 m away: no normal may lean across the jump.
TEST(Normals, DoNotBridgeAJump) {
  Scan scan = grid_scan(20, 21, [](const Eigen::Vector3d& ray) { return ray.x() < 0 ? 1.0 : 2.0; });
  estimate_normals(scan);
  for (const auto& found : scan.cloud.normals) EXPECT_NEAR(found.z(), -1, 1e-9);
}

TEST(Normals, AreUnknownWhereNoPlaneIsFixed) {
  Scan line, same, two;
  for (int i = 0; i < 30; ++i) {
    line.cloud.points.emplace_back(0.01 * i, 0.02 * i, 1 + 0.005 * i);
    same.cloud.points.emplace_back(1, 2, 3);
  }
  two.cloud.points = {{0, 0, 1}, {0.1, 0, 1}};
  for (Scan* scan : {&line, &same, &two}) {
    estimate_normals(*scan);
    for (const auto& found : scan->cloud.normals) EXPECT_TRUE(found.isZero(0)) << found.transpose();
  }
  Scan empty;
  EXPECT_NO_THROW(estimate_normals(empty));
}

TEST(Normals, LeaveOutPointsThatAreNotFinite) {
  for (const bool grid : {true, false}) {
    Scan scan = grid_scan(10, 10, plane({0, 0, 1}, 1));
    scan.cloud.points[33].x() = NAN;
    if (!grid) scan.grid = {};
    estimate_normals(scan);
    for (int i = 0; i < 100; ++i) EXPECT_NEAR(scan.cloud.normals[i].z(), i == 33 ? 0 : -1, 1e-12);
  }
}

// One point of sigma 1 m lies 3 mm off a plane of sigma 1 um: it weighs 1e-12, and moves no normal
// by more than 1e-12 * 3 mm over 10 mm.
TEST(Normals, WeighBySigma) {
  Scan scan = grid_scan(10, 10, plane({0, 0, 1}, 1));
  scan.cloud.sigma_m.assign(100, 1e-6);
  scan.cloud.points[44].z() += 0.003;
  scan.cloud.sigma_m[44] = 1;
  estimate_normals(scan);
  for (int i = 0; i < 100; ++i) EXPECT_NEAR(scan.cloud.normals[i].z(), -1, 1e-11) << i;
}

// 1,000 km from the origin coordinates are rounded by 1e-10 m, over 0.03 m.
TEST(Normals, HoldFarFromTheOrigin) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  Scan scan = grid_scan(20, 30, plane(normal, 1.5));
  for (auto& point : scan.cloud.points) point += Eigen::Vector3d(1e6, -1e6, 1e6);
  estimate_normals(scan);
  for (const auto& found : scan.cloud.normals) EXPECT_GT(std::abs(found.dot(normal)), 1 - 1e-12);
}

TEST(Normals, RefuseBrokenRequests) {
  Scan scan = grid_scan(4, 4, plane({0, 0, 1}, 1));
  EXPECT_THROW(estimate_normals(scan, {.neighbours = 2}), Error);
  EXPECT_THROW(estimate_normals(scan, {}, std::vector<Eigen::Vector3d>(3)), Error);
}

}  // namespace
}  // namespace scan
