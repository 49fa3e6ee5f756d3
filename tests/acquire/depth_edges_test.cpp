// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/acquire/depth_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace scan::decoding {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

// A slope of 0.4 px per column: steep, but one surface.
Image<float> ramp(int width, int height) {
  Image<float> disparity(width, height);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      disparity(column, row) = 20 + 0.4f * static_cast<float>(column);
  return disparity;
}

std::size_t count(const std::vector<char>& near) {
  std::size_t marked = 0;
  for (const char mark : near) marked += mark != 0;
  return marked;
}

TEST(NearDepthEdge, IsNowhereOnOneSurface) {
  EXPECT_EQ(count(near_depth_edge(ramp(60, 40), 8)), 0u);
}

TEST(NearDepthEdge, IsTheMarginOnBothSidesOfAStep) {
  Image<float> disparity(60, 40, 20);
  for (int row = 0; row < 40; ++row)
    for (int column = 30; column < 60; ++column) disparity(column, row) = 25;
  const auto near = near_depth_edge(disparity, 4);
  // Pairs one and two columns apart straddle the step: columns 28 to 31 are its edge.
  for (int column = 0; column < 60; ++column)
    EXPECT_EQ(near[disparity.index(column, 20)] != 0, column >= 28 - 4 && column <= 31 + 4)
        << column;
}

TEST(NearDepthEdge, SurroundsHolesButNotSingleMisses) {
  Image<float> single = ramp(60, 40);
  single(30, 20) = unknown;
  EXPECT_EQ(count(near_depth_edge(single, 8)), 0u);

  Image<float> hole = ramp(60, 40);
  for (int row = 18; row < 23; ++row)
    for (int column = 28; column < 33; ++column) hole(column, row) = unknown;
  const auto near = near_depth_edge(hole, 3);
  EXPECT_EQ(count(near), 11u * 11u - 25u);  // the square grown by 3 on each side, without itself
  EXPECT_TRUE(near[hole.index(25, 15)]);
  EXPECT_FALSE(near[hole.index(24, 20)]);
  EXPECT_FALSE(near[hole.index(30, 20)]) << "a hole's pixels are misses already";
}

}  // namespace
}  // namespace scan::decoding
