// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "libscan/align/joint_solver.h"
#include "libscan/align/shared_noise.h"
#include "tests/align/joint_forms.h"

namespace scan::test {
namespace {

using Eigen::Vector3d;

// The damping of 1e-10 of the diagonal changes a solution by that times the condition, some 100.
TEST(JointStep, AgreesWithTheDenseNormalEquations) {
  const Ring r = ring();
  const Eigen::VectorXd x = r.a.partialPivLu().solve(r.b);
  const auto twists = joint_step(r.forms, frame_of(4), JointBasis(24, 0));
  EXPECT_EQ(twists[0], Vector6::Zero());
  for (int i = 0; i < 3; ++i)
    EXPECT_LT((twists[std::size_t(i) + 1] - x.segment<6>(6 * i)).norm(), 1e-7);
}

// A form about another centre and in another unit means the same motion of the points.
TEST(TwistToForm, CarriesPointsAsTheTwistItselfDoes) {
  JointFrame frame = frame_of(1);
  frame.centres[0] = {1, -2, 3};
  frame.size_m = 0.7;
  const JointForm form{.frame = {.centre = {4, 5, -6}, .size_m = 2.5}};
  RandomStream random(2, 0, 0);
  const Vector6 own = random_row(random);
  const Vector6 carried = twist_to_form(frame, 0, form) * own;
  const Vector3d x(7, 8, 9);
  const Vector3d by_own = own.head<3>().cross(x - frame.centres[0]) + 0.7 * own.tail<3>();
  const Vector3d by_form = carried.head<3>().cross(x - form.frame.centre) + 2.5 * carried.tail<3>();
  EXPECT_LT((by_own - by_form).norm(), 1e-12);
}

// Lagrange's equations of the constrained minimum: A x + W l = b, W^T x = 0.
// Of one scan by itself, and of two together, which are withheld in different ways.
TEST(JointStep, GivesNoPartAlongWhatIsWeak) {
  const Ring r = ring();
  for (const double other : {0.0, 0.8}) {
    JointBasis weak = JointBasis::Zero(24, 1);
    weak(9, 0) = 0.6, weak(8, 0) = other == 0 ? 0.8 : 0, weak(20, 0) = other;
    Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(19, 19);
    saddle.topLeftCorner<18, 18>() = r.a;
    saddle.topRightCorner<18, 1>() = weak.bottomRows<18>();
    saddle.bottomLeftCorner<1, 18>() = weak.bottomRows<18>().transpose();
    Eigen::VectorXd right = Eigen::VectorXd::Zero(19);
    right.head<18>() = r.b;
    const Eigen::VectorXd x = saddle.partialPivLu().solve(right);
    const auto twists = joint_step(r.forms, frame_of(4), weak);
    for (int i = 0; i < 3; ++i)
      EXPECT_LT((twists[std::size_t(i) + 1] - x.segment<6>(6 * i)).norm(), 1e-7);
  }
}

// 300 scans in a row, three motions of each withheld: of all x with W^T x = 0 it is the minimum,
// where the slope A x - b lies in the span of W. The damping of 1e-10 is as above, the condition of
// a row of n some n^2 times larger.
TEST(JointStep, WithholdsManyMotionsOfSingleScans) {
  constexpr std::size_t scans = 300;
  RandomStream random(5, 0, 0);
  std::vector<JointForm> forms;
  for (std::size_t i = 0; i + 1 < scans; ++i) forms.push_back(random_form(i + 1, i, random));
  JointBasis weak = JointBasis::Zero(6 * scans, 3 * (scans - 1));
  for (Eigen::Index i = 1; i < Eigen::Index(scans); ++i)
    for (Eigen::Index k = 0; k < 3; ++k) {
      weak(6 * i + k, 3 * (i - 1) + k) = 0.6;
      weak(6 * i + k + 3, 3 * (i - 1) + k) = 0.8;
    }
  const auto twists = joint_step(forms, frame_of(scans), weak);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6 * scans), slope = x;
  for (std::size_t i = 0; i < scans; ++i) x.segment<6>(6 * Eigen::Index(i)) = twists[i];
  for (const JointForm& form : forms) {
    const Vector6 along = form.a * (twists[form.source] - twists[form.target]) - form.b;
    slope.segment<6>(6 * Eigen::Index(form.source)) += along;
    slope.segment<6>(6 * Eigen::Index(form.target)) -= along;
  }
  slope.head<6>().setZero();  // scan 0 is held
  EXPECT_GT(x.norm(), 1);
  EXPECT_LT((weak.transpose() * x).norm(), 1e-9);
  EXPECT_LT((slope - weak * (weak.transpose() * slope)).norm(), 1e-5);
}

TEST(JointStep, BendsALongRowByAllThatItsCouplesAskFor) {
  Row row = row_of(1000);
  Vector6 bend;
  bend << 1e-6, 2e-6, -1e-6, 3e-6, 1e-6, 2e-6;
  for (JointForm& form : row.forms) form.b = form.a * bend;
  const auto twists = joint_step(row.forms, row.frame, JointBasis(6000, 0));
  for (const JointForm& form : row.forms) {
    const Vector6 found = twist_to_form(row.frame, form.source, form) * twists[form.source] -
                          twist_to_form(row.frame, form.target, form) * twists[form.target];
    EXPECT_LT((found - bend).norm(), 4e-3 * bend.norm()) << form.source;
  }
}

// A row that sways as a whole does not move; one whose last scan alone moves does, by x^T A x.
TEST(RelativeSteps, AreWhatMovesBetweenScans) {
  RandomStream random(7, 0, 0);
  const std::vector<JointForm> forms = {random_form(2, 1, random), random_form(3, 2, random)};
  const Vector6 x = random_row(random);
  for (const RelativeStep& step : relative_steps(forms, frame_of(4), std::vector<Vector6>(4, x)))
    EXPECT_EQ(step.square + step.rotation_rad + step.translation, 0);
  std::vector<Vector6> last(4, Vector6::Zero());
  last[3] = x;
  const auto steps = relative_steps(forms, frame_of(4), last);
  EXPECT_EQ(steps[1].square, 0);
  for (const std::size_t i : {2u, 3u}) {
    EXPECT_DOUBLE_EQ(steps[i].square, x.dot(forms[1].a * x));
    EXPECT_DOUBLE_EQ(steps[i].rotation_rad, x.head<3>().norm());
    EXPECT_DOUBLE_EQ(steps[i].translation, x.tail<3>().norm());
  }
}

}  // namespace
}  // namespace scan::test
