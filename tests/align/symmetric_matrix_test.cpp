// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/symmetric_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/align/test_clouds.h"

namespace scan {
namespace {

using Eigen::Vector3d;

Eigen::Matrix3d with(const Vector3d& values, const Eigen::Matrix3d& turn) {
  return turn * values.asDiagonal() * turn.transpose();
}

TEST(SymmetricMatrix, AgreesWithAnIterativeSolver) {
  RandomStream random(1, 0, 0);
  for (int trial = 0; trial < 1000; ++trial) {
    Eigen::Matrix3d root;
    for (int i = 0; i < 9; ++i) root.data()[i] = random.normal();
    const Eigen::Matrix3d matrix = root * root.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
    const Vector3d values = eigenvalues_of(matrix);
    EXPECT_LT((values - solver.eigenvalues()).norm(), 1e-7 * values[2]);
    for (int i = 0; i < 3; ++i) {
      const Vector3d found = eigenvector_of(matrix, values[i]);
      EXPECT_NEAR(found.norm(), 1, 1e-14);
      EXPECT_LT((matrix * found - values[i] * found).norm(), 1e-6 * values[2]);
    }
  }
}

// A thin plane's normal is exact to the roundings of the matrix, at any scale and thickness.
TEST(SymmetricMatrix, FindsTheNormalOfAThinPlane) {
  RandomStream random(2, 0, 0);
  for (const double thickness2 : {0.0, 1e-12, 1e-4, 0.3})
    for (const double scale : {1e-20, 1.0, 1e20}) {
      const Eigen::Matrix3d turn = test::random_pose(random, 2, 0).linear();
      const Eigen::Matrix3d matrix = scale * with({thickness2, 1, 1.0001}, turn);
      const Vector3d values = eigenvalues_of(matrix);
      EXPECT_NEAR(values[0] / scale, thickness2, 1e-14);
      EXPECT_LT(eigenvector_of(matrix, values[0]).cross(turn.col(0)).norm(), 1e-13);
    }
}

TEST(SymmetricMatrix, HasAUnitVectorForEqualEigenvalues) {
  EXPECT_EQ(eigenvalues_of(2 * Eigen::Matrix3d::Identity()), Vector3d(2, 2, 2));
  EXPECT_EQ(eigenvector_of(2 * Eigen::Matrix3d::Identity(), 2).norm(), 1);
  const Eigen::Matrix3d line = Vector3d(1, 2, 2) * Eigen::RowVector3d(1, 2, 2);
  const Vector3d across = eigenvector_of(line, 0);
  EXPECT_NEAR(across.norm(), 1, 1e-15);
  EXPECT_NEAR(across.dot(Vector3d(1, 2, 2)), 0, 1e-15);
}

TEST(SymmetricSum, IsTheSumOfProducts) {
  SymmetricSum sum;
  sum.add({1, 2, 3});
  sum.add({-1, 0, 4});
  Eigen::Matrix3d expected;
  expected << 2, 2, -1, 2, 4, 6, -1, 6, 25;
  EXPECT_EQ(sum.matrix(), expected);
}

}  // namespace
}  // namespace scan
