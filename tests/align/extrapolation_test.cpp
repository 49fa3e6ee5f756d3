// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/extrapolation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "libscan/core/random.h"

namespace scan {
namespace {

Matrix6 random_matrix(std::uint64_t seed) {
  Matrix6 m;
  for (int i = 0; i < 36; ++i) m(i / 6, i % 6) = RandomStream(seed, 0, std::uint64_t(i)).normal();
  return m;
}

// Steps of the right direction that are too short by another share along each of six axes.
struct ShortSteps {
  Matrix6 shares;
  Vector6 zero;
  Vector6 step(const Vector6& x) const { return shares * (zero - x); }
};

ShortSteps short_steps(std::uint64_t seed) {
  const Matrix6 axes = random_matrix(seed) + 5 * Matrix6::Identity();
  Vector6 shares, zero;
  shares << 0.1, 0.2, 0.35, 0.5, 0.7, 0.9;
  for (int i = 0; i < 6; ++i) zero[i] = RandomStream(seed, 1, std::uint64_t(i)).normal();
  return {axes * shares.asDiagonal() * axes.inverse(), zero};
}

// Six changes tell all of a linear map of six dimensions, so that the seventh move ends at its zero
// (Walker and Ni 2011, theorem 2.2). By the steps alone 0.9^7 of the way along the first axis is
// left. Rounding grows with the conditions of the map and of the squared changes: 1e-16 * 10 * 1e8.
TEST(Extrapolation, EndsAtTheZeroOfALinearMapInSevenMoves) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const ShortSteps map = short_steps(seed);
    const Matrix6 root = random_matrix(seed + 100);
    const Matrix6 metric = root.transpose() * root + Matrix6::Identity();
    Extrapolation extrapolation;
    Vector6 x = Vector6::Zero(), plain = Vector6::Zero();
    for (int k = 0; k < 7; ++k) {
      x += extrapolation.move(map.step(x), metric, 0);
      plain += map.step(plain);
    }
    EXPECT_LT((x - map.zero).norm(), 1e-7 * map.zero.norm()) << seed;
    EXPECT_GT((plain - map.zero).norm(), 1e-2 * map.zero.norm()) << seed;
  }
}

// More moves than dimensions: the oldest are forgotten, and a zero that moves is followed.
TEST(Extrapolation, FollowsAZeroThatMoves) {
  ShortSteps map = short_steps(3);
  Extrapolation extrapolation;
  Vector6 x = Vector6::Zero();
  for (int k = 0; k < 7; ++k) x += extrapolation.move(map.step(x), Matrix6::Identity(), 0);
  map.zero += Vector6::Ones();
  for (int k = 0; k < 14; ++k) x += extrapolation.move(map.step(x), Matrix6::Identity(), 0);
  EXPECT_LT((x - map.zero).norm(), 1e-6);
}

TEST(Extrapolation, LearnsNothingFromSmallChanges) {
  const ShortSteps map = short_steps(4);
  Extrapolation extrapolation;
  Vector6 x = Vector6::Zero();
  for (int k = 0; k < 8; ++k) {
    const Vector6 step = map.step(x);
    EXPECT_EQ(extrapolation.move(step, Matrix6::Identity(), 1e3), step);
    x += step;
  }
}

}  // namespace
}  // namespace scan
