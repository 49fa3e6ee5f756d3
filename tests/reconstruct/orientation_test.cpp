// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/orientation.h"

#include <gtest/gtest.h>

#include "libscan/core/parallel.h"
#include "libscan/reconstruct/local_planes.h"
#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

std::size_t turn_back(PointCloud& cloud) {
  return agree_with_neighbours(cloud.points, local_planes(cloud.points, 16).around, cloud.normals);
}

TEST(Orientation, LeavesGoodNormalsAlone) {
  PointCloud cloud = torus_cloud(5000);
  EXPECT_EQ(turn_back(cloud), 0u);
  EXPECT_EQ(cloud.normals, torus_cloud(5000).normals);
}

// With 30 % reversed a point's 16 neighbours are right by majority, and its bonds join it to them
// whichever way it points: all come back.
TEST(Orientation, TurnsThirtyPercentBack) {
  PointCloud cloud = torus_cloud(5000);
  RandomStream random(9, 0, 0);
  std::size_t reversed = 0;
  for (auto& n : cloud.normals)
    if (random.uniform() < 0.3) {
      n = -n;
      ++reversed;
    }
  EXPECT_EQ(turn_back(cloud), reversed);
  EXPECT_EQ(cloud.normals, torus_cloud(5000).normals);
}

TEST(Orientation, TurnsAPatchBack) {
  PointCloud cloud = torus_cloud(5000);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.points[i][0] > 0.9) cloud.normals[i] = -cloud.normals[i];
  turn_back(cloud);
  EXPECT_EQ(cloud.normals, torus_cloud(5000).normals);
}

// Without a majority there are the two consistent choices; outwards from the centre is right for a
// star-shaped body.
TEST(Orientation, FindsTheOutsideOfASphere) {
  PointCloud cloud = sphere_cloud(3000);
  RandomStream random(9, 0, 0);
  for (auto& n : cloud.normals)
    if (random.uniform() < 0.5) n = -n;
  turn_back(cloud);
  EXPECT_EQ(cloud.normals, sphere_cloud(3000).normals);
}

// Two sheets three spacings apart, opposed, without a rim: nothing tells one what the other does.
TEST(Orientation, KeepsTheSidesOfAThinPlate) {
  PointCloud cloud;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j)
      for (const double side : {1.0, -1.0}) {
        cloud.points.push_back({0.1 * i, 0.1 * j, 0.15 * side});
        cloud.normals.push_back(side * Eigen::Vector3d::UnitZ());
      }
  PointCloud scattered = cloud;
  RandomStream random(9, 0, 0);
  for (auto& n : scattered.normals)
    if (random.uniform() < 0.2) n = -n;
  turn_back(scattered);
  EXPECT_EQ(scattered.normals, cloud.normals);
}

}  // namespace
}  // namespace scan
