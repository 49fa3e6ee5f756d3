// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/shared_noise.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "libscan/core/random.h"

namespace scan {
namespace {

constexpr int most_side = 96;  // points of a square grid, so that patches are squares, too

struct Pulls {
  std::vector<Vector6> pulls;
  std::vector<Eigen::Vector3d> at;
};

// Noise averaged over windows of `width` x `width` points, times six smooth functions of the place,
// whitened and freed of the sum that an estimate would have followed.
Pulls pulls_sharing(int width, std::uint64_t seed, int side = most_side) {
  const int wide = side + width - 1;
  std::vector<double> white;
  for (int i = 0; i < wide * wide; ++i)
    white.push_back(RandomStream(seed, 0, std::uint64_t(i)).normal());
  Pulls made;
  Matrix6 squares = Matrix6::Zero();
  Vector6 sum = Vector6::Zero();
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      double noise = 0;
      for (int i = 0; i < width; ++i)
        for (int j = 0; j < width; ++j) noise += white[std::size_t((r + i) * wide + c + j)];
      const double x = 2.0 * r / side - 1, y = 2.0 * c / side - 1;
      Vector6 shape;
      shape << 1, x, y, std::sin(3 * x), std::cos(3 * y), x * y;
      made.at.emplace_back(x, y, 0);
      made.pulls.push_back(noise * shape);
      sum += made.pulls.back();
      squares += shape * shape.transpose();
    }
  // Least squares of the six functions take their share of the sum from every point.
  const Vector6 fitted = squares.ldlt().solve(sum);
  Matrix6 scatter = Matrix6::Zero();
  for (std::size_t i = 0; i < made.pulls.size(); ++i) {
    const double x = made.at[i].x(), y = made.at[i].y();
    Vector6 shape;
    shape << 1, x, y, std::sin(3 * x), std::cos(3 * y), x * y;
    made.pulls[i] -= shape * shape.dot(fitted);
    scatter += made.pulls[i] * made.pulls[i].transpose();
  }
  const Eigen::LLT<Matrix6> root(scatter);
  for (Vector6& pull : made.pulls) pull = root.matrixL().solve(pull);
  return made;
}

// A window of w x w points makes the sum's variance w^2 times that of noise of their own. The
// inverse of one estimate varies by 6.5 / 64 = 0.32^2, the mean over 40 by 0.05, of which three.
TEST(NoiseSharing, OfAWindowIsItsArea) {
  for (const int width : {1, 2, 3, 5}) {
    double mean = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      const Pulls made = pulls_sharing(width, seed);
      mean += width * width / noise_sharing(made.pulls, made.at, 6) / 40;
    }
    EXPECT_NEAR(mean, 1, 0.15) << width;
  }
}

// So of fewer than a thousand points, by half as many patches. The inverse of one estimate varies
// by 6.5 / 32 = 0.2, the mean over 200 by 0.032, of which three; the correction of its mean is of
// first order and leaves about twice the square of 0.2.
TEST(NoiseSharing, OfAWindowIsItsAreaOfFewPoints) {
  for (const int width : {1, 2, 3}) {
    double mean = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const Pulls made = pulls_sharing(width, seed, 31);
      mean += width * width / noise_sharing(made.pulls, made.at, 6) / 200;
    }
    EXPECT_NEAR(mean, 1, 0.18) << width;
  }
}

// Estimates below one are cut off where 1.5 sigma of chance takes them, so that the inverse keeps
// its mean but for 0.01; cut off at one it would lose 0.13. The mean over 400 varies by 0.016, of
// which three.
TEST(NoiseSharing, OfNoneSharedHasItsInverseRight) {
  double mean = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Pulls made = pulls_sharing(1, 1000 + seed);
    mean += 1 / noise_sharing(made.pulls, made.at, 6) / 400;
  }
  EXPECT_NEAR(mean, 0.99, 0.048);
}

// Nor far below one, where chance would have it.
TEST(NoiseSharing, IsNeverFarBelowOne) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Pulls made = pulls_sharing(1, seed);
    EXPECT_GT(noise_sharing(made.pulls, made.at, 6), 2.0 / 3);
  }
}

// The order of the points means nothing.
TEST(NoiseSharing, DoesNotDependOnTheOrder) {
  Pulls made = pulls_sharing(3, 7);
  const double ratio = noise_sharing(made.pulls, made.at, 6);
  std::reverse(made.pulls.begin(), made.pulls.end());
  std::reverse(made.at.begin(), made.at.end());
  EXPECT_NEAR(noise_sharing(made.pulls, made.at, 6), ratio, 1e-9 * ratio);
}

TEST(NoiseSharing, OfFewOrNoPullsIsFinite) {
  EXPECT_GT(noise_sharing({}, {}, 6), 0.5);
  const std::vector<Vector6> pulls(3, Vector6::Zero());
  const std::vector<Eigen::Vector3d> at(3, Eigen::Vector3d::Zero());
  EXPECT_GT(noise_sharing(pulls, at, 6), 0.5);
}

}  // namespace
}  // namespace scan
