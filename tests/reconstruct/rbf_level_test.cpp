// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/rbf_level.h"

#include <gtest/gtest.h>

#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr double radius = 0.3;

Eigen::Vector3d place(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {x, y, z};
}

// f = x y + z^2 at places scattered through the cube.
std::vector<RbfNode> smooth_nodes(int count, double variance) {
  RandomStream random(3, 0, 0);
  std::vector<RbfNode> nodes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d x = place(random);
    const Eigen::Vector3d gradient(x[1], x[0], 2 * x[2]);
    nodes.push_back({x, {x[0] * x[1] + x[2] * x[2], radius * gradient}, variance});
  }
  return nodes;
}

TEST(RbfLevel, TakesOnTheValuesAndGradientsWanted) {
  const auto nodes = smooth_nodes(300, 0);
  RbfLevel level(radius, nodes);
  const RbfSolve solved = level.solve(radius / 3, 1e-10, 2000);
  EXPECT_LE(solved.relative_residual, 1e-10);
  // The residual is 1e-10 of the data, which are of the order of one.
  for (const RbfNode& node : nodes) {
    const Jet at = level.at(node.place);
    EXPECT_NEAR(at.value, node.wanted.value, 1e-7);
    EXPECT_LT((radius * at.gradient - node.wanted.gradient).norm(), 1e-7);
  }
}

TEST(RbfLevel, ValueAndGradientBelongTogether) {
  RbfLevel level(radius, smooth_nodes(300, 0));
  level.solve(radius / 3, 1e-6, 500);
  RandomStream random(4, 0, 0);
  constexpr double h = 1e-5;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d x = place(random);
    const Jet at = level.at(x);
    EXPECT_NEAR(at.value, level.value(x), 1e-12);
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(a);
      // Second differences of a function whose third derivatives are below 1e4: h^2 / 6 of them.
      EXPECT_NEAR(at.gradient[a], (level.value(x + step) - level.value(x - step)) / (2 * h), 1e-6);
    }
  }
}

TEST(RbfLevel, KeepsQuietWhereItsDataAreNoise) {
  RandomStream random(6, 0, 0);
  std::vector<RbfNode> nodes;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d x = place(random);
    nodes.push_back({x, {random.normal(), Eigen::Vector3d::Zero()}, 1});
  }
  RbfLevel level(0.2, nodes);
  level.solve(0.2 / 3, 1e-6, 500);
  std::size_t silent = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) silent += level.is_silent(i);
  // Two standard errors, and the largest left out: less than the normal tail of 2.3 %.
  EXPECT_GT(silent, 0.977 * 2000);
}

TEST(RbfLevel, FollowsDataThatStandOutOfTheNoise) {
  auto nodes = smooth_nodes(300, 1e-6);
  RbfLevel level(radius, nodes);
  level.solve(radius / 3, 1e-8, 2000);
  std::size_t silent = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) silent += level.is_silent(i);
  EXPECT_EQ(silent, 0u);
  for (const RbfNode& node : nodes) EXPECT_NEAR(level.value(node.place), node.wanted.value, 0.01);
}

}  // namespace
}  // namespace scan
