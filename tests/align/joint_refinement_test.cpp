// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "libscan/core/random.h"

namespace scan {
namespace {

ScanPairForm random_form(std::size_t source, std::size_t target, RandomStream& random) {
  ScanPairForm form{.source = source, .target = target, .pairs = 10};
  for (int k = 0; k < 10; ++k) {
    Vector6 row;
    for (int i = 0; i < 6; ++i) row[i] = random.normal();
    form.a += row * row.transpose();
    form.b -= row * random.normal();
  }
  return form;
}

// The dense normal equations of the same problem: for each form, x = x_source - x_target.
TEST(SolveForms, AgreesWithTheDenseNormalEquations) {
  RandomStream random(1, 0, 0);
  const std::vector<ScanPairForm> forms{random_form(0, 1, random), random_form(1, 2, random),
                                        random_form(2, 3, random), random_form(3, 0, random)};
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(24, 24);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(24);
  for (const ScanPairForm& form : forms) {
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(6, 24);
    difference.middleCols<6>(6 * Eigen::Index(form.source)).setIdentity();
    difference.middleCols<6>(6 * Eigen::Index(form.target)) = -Matrix6::Identity();
    a += difference.transpose() * form.a * difference;
    b += difference.transpose() * form.b;
  }
  const Eigen::VectorXd rest = a.bottomRightCorner<18, 18>().partialPivLu().solve(b.tail<18>());
  const std::vector<Vector6> twists = solve_forms(forms, 4, {true, false, false, false});
  EXPECT_EQ(twists[0], Vector6::Zero());
  // Ceres damps by 1e-8 of the diagonal and stops at relative changes of 1e-14.
  for (int i = 0; i < 3; ++i)
    EXPECT_LT((twists[std::size_t(i) + 1] - rest.segment<6>(6 * i)).norm(), 1e-6);
}

TEST(SolveForms, MotionsThatNothingFixesStayZero) {
  ScanPairForm form{.source = 0, .target = 1, .pairs = 10};
  form.a(5, 5) = 3;
  form.b[5] = 6;
  const std::vector<Vector6> twists = solve_forms(std::vector{form}, 2, {false, true});
  EXPECT_LT((twists[0] - 2 * Vector6::Unit(5)).norm(), 1e-6);
}

}  // namespace
}  // namespace scan
