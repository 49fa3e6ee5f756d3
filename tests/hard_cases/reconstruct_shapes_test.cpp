// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Reconstruction where programs of the field give broken meshes: noise, outliers, uneven density,
// open surfaces, far origins, tiny and huge units.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "libscan/reconstruct/ssd.h"
#include "libscan/reconstruct/trim.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

void expect_torus(const SurfaceResult& result) {
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  EXPECT_EQ(census.components, 1u);
  EXPECT_EQ(census.genus, 1);
}

PointCloud with_noise(PointCloud cloud, double sigma_m, double sigma_normal) {
  RandomStream random(5, 0, 0);
  const auto step = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.points[i] += sigma_m * step();
    cloud.normals[i] = (cloud.normals[i] + sigma_normal * step()).normalized();
  }
  return cloud;
}

TEST(ReconstructHardCases, KeepsTheTopologyUnderNoise) {
  const double diagonal = std::sqrt(2 * 2.7 * 2.7 + 0.7 * 0.7);
  for (const double share : {0.001, 0.003}) {
    SCOPED_TRACE(share);
    expect_torus(ssd(with_noise(torus_cloud(20000), share * diagonal, 0.1), {.depth = 7}));
  }
}

TEST(ReconstructHardCases, HasTheSameTrianglesAtAnyScale) {
  const PointCloud cloud = torus_cloud(3000);
  const SurfaceResult metre = ssd(cloud, {.depth = 6});
  for (const double scale : {1e-6, 1e-3, 1e6}) {
    SCOPED_TRACE(scale);
    PointCloud scaled = cloud;
    for (auto& x : scaled.points) x *= scale;
    EXPECT_EQ(ssd(scaled, {.depth = 6}).surface.triangles, metre.surface.triangles);
  }
}

TEST(ReconstructHardCases, WorksFarFromTheOrigin) {
  PointCloud cloud = torus_cloud(3000);
  const Eigen::Vector3d offset(1e6, -1e6, 1e6);
  for (auto& x : cloud.points) x += offset;
  const SurfaceResult result = ssd(cloud, {.depth = 6});
  expect_torus(result);
  const SurfaceResult near = ssd(torus_cloud(3000), {.depth = 6});
  // Coordinates at 1e6 m are rounded to 1.2e-10 m.
  ASSERT_EQ(result.surface.vertices.size(), near.surface.vertices.size());
  for (std::size_t i = 0; i < near.surface.vertices.size(); ++i)
    EXPECT_LT((result.surface.vertices[i] - offset - near.surface.vertices[i]).norm(), 1e-6);
}

TEST(ReconstructHardCases, IgnoresAFarPoint) {
  PointCloud cloud = torus_cloud(3000);
  cloud.points.push_back({1e6, 0, 0});
  cloud.normals.push_back(Eigen::Vector3d::UnitX());
  const SurfaceResult result = ssd(cloud, {.depth = 6});
  expect_torus(result);
  EXPECT_EQ(result.outlying_points, 1u);
}

TEST(ReconstructHardCases, TakesRepeatedPoints) {
  PointCloud cloud = torus_cloud(3000);
  const SurfaceResult once = ssd(cloud, {.depth = 6});
  append(cloud, torus_cloud(3000));
  EXPECT_EQ(ssd(cloud, {.depth = 6}).surface.triangles, once.surface.triangles);
}

TEST(ReconstructHardCases, FollowsUnevenDensity) {
  const PointCloud all = torus_cloud(60000);
  RandomStream random(3, 0, 0);
  std::vector<std::uint32_t> kept;  // thinned by 200 along x
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (random.uniform() < std::pow(200.0, -(all.points[i][0] + 1.35) / 2.7)) kept.push_back(i);
  expect_torus(ssd(subset(all, kept), {.depth = 7}));
}

// Points on a line leave the surface free to turn about it: whatever comes is closed and near them.
TEST(ReconstructHardCases, TakesPointsOnALine) {
  PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    cloud.points.push_back({0.01 * i, 0, 0});
    cloud.normals.push_back(Eigen::Vector3d::UnitZ());
  }
  const SurfaceResult result = ssd(cloud, {.depth = 5});
  EXPECT_TRUE(edge_census(result.surface).watertight);
  // f = z is what the normals say and costs no bending; the walls close the surface.
  double nearest = 1;
  for (const auto& v : result.surface.vertices) nearest = std::min(nearest, std::abs(v[2]));
  EXPECT_LT(nearest, 1e-4);
}

// Two sheets that face away from each other, a plate three cells thick at depth 7.
TEST(ReconstructHardCases, KeepsAThinPlateWhole) {
  PointCloud cloud;
  RandomStream random(4, 0, 0);
  const double thickness = 3 * 1.25 / 128;
  for (int i = 0; i < 40000; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    cloud.points.push_back({random.uniform(), random.uniform(), side * thickness / 2});
    cloud.normals.push_back(side * Eigen::Vector3d::UnitZ());
  }
  const SurfaceResult result = ssd(cloud, {.depth = 7});
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_TRUE(census.watertight);
  for (const auto& v : result.surface.vertices) {
    const bool in_plate = v[0] > 0.1 && v[0] < 0.9 && v[1] > 0.1 && v[1] < 0.9;
    if (in_plate) {
      EXPECT_NEAR(std::abs(v[2]), thickness / 2, 0.1 * thickness);
    }
  }
}

TEST(ReconstructHardCases, KeepsAnOpenSurfaceOpenAfterTrimming) {
  const PointCloud sphere = sphere_cloud(20000);
  std::vector<std::uint32_t> cap;
  for (std::uint32_t i = 0; i < sphere.size(); ++i)
    if (sphere.points[i][2] > 0.3) cap.push_back(i);
  SurfaceResult result = ssd(subset(sphere, cap), {.depth = 6});
  EXPECT_TRUE(edge_census(result.surface).watertight);
  trim(result, 0.06);
  const EdgeCensus census = edge_census(result.surface);
  EXPECT_EQ(census.components, 1u);
  EXPECT_GT(census.boundary_edges, 0u);
  // 2 pi (1 - 0.3) and a rim of at most the trimming distance.
  EXPECT_NEAR(area_m2(result.surface), 1.4 * std::numbers::pi, 0.06 * 2 * std::numbers::pi);
  // Inside the cap the samples hold the surface; past the rim it goes on as smooth as it can, at a
  // slope to the sphere that stays below 1 : 4.
  for (const auto& v : result.surface.vertices)
    EXPECT_NEAR(v.norm(), 1, v[2] > 0.35 ? 1e-3 : 0.06 / 4);
}

}  // namespace
}  // namespace scan
