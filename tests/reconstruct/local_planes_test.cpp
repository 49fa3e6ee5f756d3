// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/local_planes.h"

#include <gtest/gtest.h>

#include "tests/reconstruct/shapes.h"

namespace scan {
namespace {

// `count` points less every `step`-th.
void expect_those_of_all_anew(std::size_t count, std::size_t step) {
  const std::vector<Eigen::Vector3d> points = scattered(torus_cloud(count), 0.01).points;
  std::vector<Eigen::Vector3d> left;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < count; ++i)
    if (i % step != 0) {
      kept.push_back(i);
      left.push_back(points[i]);
    }
  const LocalPlanes found = remaining_planes(local_planes(points, 16), left, kept);
  const LocalPlanes expected = local_planes(left, 16);
  EXPECT_EQ(found.neighbours, expected.neighbours);
  EXPECT_EQ(found.around, expected.around);
  ASSERT_EQ(found.planes.size(), expected.planes.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    EXPECT_EQ(found.planes[i].normal, expected.planes[i].normal);
    EXPECT_EQ(found.planes[i].thickness_m, expected.planes[i].thickness_m);
    EXPECT_EQ(found.planes[i].reach_m, expected.planes[i].reach_m);
  }
}

TEST(LocalPlanes, RemainAsIfFittedAnew) {
  expect_those_of_all_anew(2000, 50);
  expect_those_of_all_anew(20, 3);  // 13 are left, fewer than 16 neighbours
}

}  // namespace
}  // namespace scan
