// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/reconstruct/wendland.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "libscan/core/random.h"

namespace scan {
namespace {

double phi(const Eigen::Vector3d& d) {
  return d.squaredNorm() < 1 ? wendland(d.squaredNorm()).value : 0;
}

Eigen::Vector3d place(RandomStream& random) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return {x, y, z};
}

// Central differences of step h err by h^2/6 times the third derivative, which is below 600 for
// t < 1, and by 1e-16 / h of rounding: 1e-8 and 1e-12 for h = 1e-5.
TEST(Wendland, SlopeAndBendAreItsDerivatives) {
  constexpr double h = 1e-5;
  RandomStream random(1, 0, 0);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d d = 0.55 * place(random);
    const Wendland w = wendland(d.squaredNorm());
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(a);
      EXPECT_NEAR(w.slope * d[a], (phi(d + step) - phi(d - step)) / (2 * h), 2e-8);
      const Eigen::Vector3d after = d + step, before = d - step;
      const Eigen::Vector3d row = (wendland(after.squaredNorm()).slope * after -
                                   wendland(before.squaredNorm()).slope * before) /
                                  (2 * h);
      for (int b = 0; b < 3; ++b)
        EXPECT_NEAR(w.bend * d[a] * d[b] + (a == b ? w.slope : 0), row[b], 1e-6);
    }
  }
}

TEST(Wendland, EndsWithoutAStepInItsSecondDerivative) {
  const Wendland w = wendland(1);
  EXPECT_EQ(w.value, 0);
  EXPECT_EQ(w.slope, 0);
  EXPECT_EQ(w.bend, 0);
  EXPECT_EQ(wendland(0).value, 1);
  EXPECT_DOUBLE_EQ(wendland(0).slope, -wendland_curvature);
}

// The matrix of values and gradients between any places is positive definite (Wendland 1995).
TEST(Wendland, InfluenceIsSymmetricAndPositiveDefinite) {
  constexpr int count = 12;
  RandomStream random(2, 0, 0);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < count; ++i) places.push_back(0.8 * place(random));
  Eigen::MatrixXd matrix(4 * count, 4 * count);
  for (int j = 0; j < count; ++j)
    for (int c = 0; c < 4; ++c) {
      Jet unit;
      (c == 0 ? unit.value : unit.gradient[c - 1]) = 1;
      for (int i = 0; i < count; ++i) {
        const Eigen::Vector3d d = places[i] - places[j];
        const Jet at = d.squaredNorm() < 1 ? influence(unit, d, d.squaredNorm()) : Jet{};
        matrix(4 * i, 4 * j + c) = at.value;
        matrix.block<3, 1>(4 * i + 1, 4 * j + c) = at.gradient;
      }
    }
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  EXPECT_GT(eigen.eigenvalues()[0], 0);
}

}  // namespace
}  // namespace scan
