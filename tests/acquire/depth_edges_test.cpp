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

// Where a step of the given height at 30 is marked, along columns or rows, with a margin of 4 px.
std::vector<bool> marked_at_a_step(float height_px, bool along_rows) {
  Image<float> disparity(60, 60, 20);
  for (int i = 0; i < 60; ++i)
    for (int beyond = 30; beyond < 60; ++beyond)
      (along_rows ? disparity(i, beyond) : disparity(beyond, i)) = 20 + height_px;
  const auto near = near_depth_edge(disparity, 4);
  std::vector<bool> marked;
  for (int i = 0; i < 60; ++i)
    marked.push_back(near[along_rows ? disparity.index(20, i) : disparity.index(i, 20)] != 0);
  return marked;
}

// Pairs one and two pixels apart straddle the step: 28 to 31 are its edge. One apart they may
// differ by 1 + 0.5 px, two apart by 1 + 2 * 0.5.
TEST(NearDepthEdge, IsTheMarginOnBothSidesOfAStep) {
  for (const bool along_rows : {false, true}) {
    const auto high = marked_at_a_step(5, along_rows), low = marked_at_a_step(1.6F, along_rows),
               none = marked_at_a_step(1.4F, along_rows);
    for (int i = 0; i < 60; ++i) {
      const auto at = static_cast<std::size_t>(i);
      EXPECT_EQ(high[at], i >= 28 - 4 && i <= 31 + 4) << i;
      EXPECT_EQ(low[at], i >= 29 - 4 && i <= 30 + 4) << i;
      EXPECT_FALSE(none[at]) << i;
    }
  }
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
