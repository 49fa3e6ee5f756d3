// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_refinement.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "libscan/align/joint_solver.h"
#include "libscan/align/shared_noise.h"
#include "libscan/core/random.h"

namespace scan {
namespace {

using Eigen::Vector3d;

Vector6 random_row(RandomStream& random) {
  Vector6 row;
  for (int i = 0; i < 6; ++i) row[i] = random.normal();
  return row;
}

JointForm random_form(std::size_t source, std::size_t target, RandomStream& random) {
  JointForm form{.source = source, .target = target, .pairs = 10};
  for (int k = 0; k < 10; ++k) {
    const Vector6 row = random_row(random);
    const double residual = random.normal();
    form.a += row * row.transpose();
    form.b -= row * residual;
  }
  form.apparent = form.a;
  return form;
}

JointFrame frame_of(std::size_t scans) {
  JointFrame frame{.centres = std::vector<Vector3d>(scans, Vector3d::Zero()),
                   .size_m = 1,
                   .free = std::vector<bool>(scans, true)};
  frame.free[0] = false;
  return frame;
}

struct Ring {
  std::vector<JointForm> forms;
  Eigen::MatrixXd a;  // dense normal equations of scans 1 to 3
  Eigen::VectorXd b;
};

Ring ring() {
  RandomStream random(1, 0, 0);
  Ring ring;
  for (std::size_t i = 0; i < 4; ++i) ring.forms.push_back(random_form(i, (i + 1) % 4, random));
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(24, 24);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(24);
  for (const JointForm& form : ring.forms) {
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(6, 24);
    difference.middleCols<6>(6 * Eigen::Index(form.source)).setIdentity();
    difference.middleCols<6>(6 * Eigen::Index(form.target)) = -Matrix6::Identity();
    a += difference.transpose() * form.a * difference;
    b += difference.transpose() * form.b;
  }
  ring.a = a.bottomRightCorner<18, 18>();
  ring.b = b.tail<18>();
  return ring;
}

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

// A row of couples half way between scans one metre apart, each as well held as the others.
struct Row {
  std::vector<JointForm> forms;
  JointFrame frame;
};

Row row_of(std::size_t scans) {
  Row row{.forms = {}, .frame = frame_of(scans)};
  for (std::size_t i = 0; i < scans; ++i) row.frame.centres[i] = {double(i), 0, 0};
  for (std::size_t i = 1; i < scans; ++i) {
    JointForm form{.source = i, .target = i - 1, .pairs = 10};
    form.frame = {.centre = {double(i) - 0.5, 0, 0}, .size_m = 1};
    form.a = form.apparent = Matrix6::Identity();
    form.noise = 0.001 * Matrix6::Identity();  // of three planes, by chance up to 0.025
    row.forms.push_back(form);
  }
  return row;
}

// The least eigenvalue of a row of n that bends is that of a clamped beam, (1.875 / n)^4: 1.2e-11
// of a couple's own for n = 1,000.
TEST(JointWeakMotions, ALongRowMayBendNoMoreThanItsCouplesLetIt) {
  const Row row = row_of(1000);
  EXPECT_EQ(joint_weak_motions(row.forms, row.frame).cols(), 0);
}

// Each couple asks for one and the same bend. The diagonal of 2.5 is made larger by 1e-14 of it,
// which is 0.002 of the least eigenvalue.
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

TEST(JointWeakMotions, AreNoneWhereTheDataFixAll) {
  const Ring r = ring();
  EXPECT_EQ(joint_weak_motions(r.forms, frame_of(4)).cols(), 0);
}

// A fifth above noise may be chance among a thousand planes, whose difference has a standard
// deviation of 2 sqrt(16 / 1000) = 25 % of the noise, and is none among a hundred thousand, 2.5 %.
TEST(JointWeakMotions, WhatRisesAboveNoiseCountsWhereManyPlanesSaySo) {
  const auto weak_among = [](double planes) {
    JointForm form{.source = 1, .target = 0};
    form.noise(0, 0) = 1;
    form.apparent.diagonal() << 1.2, planes, planes, planes / 3, planes / 3, planes / 3;
    return joint_weak_motions(std::vector{form}, frame_of(2)).cols();
  };
  EXPECT_EQ(weak_among(1e3), 1);
  EXPECT_EQ(weak_among(1e5), 0);
}

// Scans 2 and 3 hold each other, but what ties them to 0 and 1 leaves one motion to noise: they may
// go along it together, and only they.
TEST(JointWeakMotions, FindWhatAGroupOfScansMayDoTogether) {
  RandomStream random(3, 0, 0);
  std::vector<JointForm> forms = {random_form(1, 0, random), random_form(2, 3, random),
                                  random_form(2, 1, random), random_form(3, 0, random)};
  const Vector6 open = random_row(random).normalized();
  const Matrix6 rest = Matrix6::Identity() - open * open.transpose();
  for (const std::size_t k : {2u, 3u}) {
    // A tenth more than noise.
    forms[k].noise = 0.01 * open * open.transpose();
    forms[k].apparent = rest * forms[k].apparent * rest + 1.1 * forms[k].noise;
  }
  const JointFrame frame = frame_of(4);
  const JointBasis weak = joint_weak_motions(forms, frame);
  ASSERT_EQ(weak.cols(), 1);
  EXPECT_EQ(weak_motions_of(0, weak).cols(), 0);
  EXPECT_EQ(weak_motions_of(1, weak).cols(), 0);
  for (const std::size_t i : {2u, 3u}) {
    const TwistBasis own = weak_motions_of(i, weak);
    ASSERT_EQ(own.cols(), 1);
    // The ties within the group, and of scan 1 to 0, give by 0.01 over some units of information.
    EXPECT_GT(std::abs(own.col(0).dot(open)), 0.99);
  }
}

// One scan against the anchor, pulls known: B^-1 M B^-1 times what the whitened pulls share.
TEST(JointCovariances, AreTheSandwichOfCurvatureAndScatter) {
  RandomStream random(4, 0, 0);
  const std::vector<JointForm> forms = {random_form(1, 0, random), random_form(0, 1, random)};
  std::vector<JointDetail> details(2);
  Matrix6 scatter = Matrix6::Zero();
  std::vector<Vector6> pulls;
  std::vector<Vector3d> at;
  for (std::int64_t place = 0; place < 20; ++place) {
    const Vector6 there = random_row(random), back = random_row(random);
    details[0].pulls.push_back({{place, 0, 0}, there});
    details[1].pulls.push_back({{place, 0, 0}, back});
    pulls.push_back(there - back);  // scan 1 is the second's target
    at.emplace_back(double(place), 0, 0);
    scatter += pulls.back() * pulls.back().transpose();
  }
  const Eigen::LLT<Matrix6> spread(scatter);
  for (Vector6& pull : pulls) pull = spread.matrixL().solve(pull).eval();
  const double share = noise_sharing(pulls, at, 6);
  for (std::size_t k = 0; k < 2; ++k) details[k].curvature = forms[k].a;
  const Matrix6 inverse = (forms[0].a + forms[1].a).inverse();
  JointFrame frame = frame_of(2);
  frame.size_m = 3;
  std::vector<JointForm> scaled = forms;
  for (JointForm& form : scaled) form.frame.size_m = 3;
  const auto covariances = joint_covariances(scaled, details, frame, JointBasis(12, 0));
  ASSERT_TRUE(covariances[1]);
  Matrix6 units = Matrix6::Identity();
  units.bottomRightCorner<3, 3>() *= 3;
  const Matrix6 expected = share * units * inverse * scatter * inverse * units;
  EXPECT_LT((*covariances[1] - expected).norm(), 1e-7 * expected.norm());
  EXPECT_EQ(*covariances[0], Matrix6::Zero());
}

// Scans 1 and 2 in a row, the noise between them shared by places and ten times stronger: what
// holds scan 1 is its couple with the anchor alone. So its covariance is that of this couple, times
// a number.
TEST(JointCovariances, OfAChainAddUpFromTheAnchor) {
  RandomStream random(6, 0, 0);
  const std::vector<JointForm> forms = {random_form(1, 0, random), random_form(2, 1, random)};
  std::vector<JointDetail> details(2);
  Matrix6 scatter = Matrix6::Zero();
  for (std::int64_t place = 0; place < 2000; ++place) {
    const Vector6 near = random_row(random);
    details[0].pulls.push_back({{place, 0, 0}, near});
    scatter += near * near.transpose();
  }
  Vector6 shared = Vector6::Zero();
  for (std::int64_t place = 2000; place < 4000; ++place) {
    if (place % 20 == 0) shared = 10 * random_row(random);
    details[1].pulls.push_back({{place, 0, 0}, shared});
  }
  for (std::size_t k = 0; k < 2; ++k) details[k].curvature = forms[k].a;
  const auto covariances = joint_covariances(forms, details, frame_of(3), JointBasis(18, 0));
  const Matrix6 inverse = forms[0].a.inverse(), link = inverse * scatter * inverse;
  const double times = covariances[1]->trace() / link.trace();
  EXPECT_GE(times, 1);
  EXPECT_LT((*covariances[1] - times * link).norm(), 1e-7 * times * link.norm());
}

// With a motion of two scans together withheld: by Lagrange's equations, whose inverse's first
// block answers pulls with steps.
TEST(WithholdingSolver, SandwichesWhatIsNotWithheld) {
  const Ring r = ring();
  std::vector<JointDetail> details(4);
  for (std::size_t k = 0; k < 4; ++k) {
    RandomStream random(8, 0, k);
    details[k].curvature = r.forms[k].a;
    for (std::int64_t place = 0; place < 20; ++place)
      details[k].pulls.push_back({{place, std::int64_t(k), 0}, random_row(random)});
  }
  JointBasis weak = JointBasis::Zero(24, 1);
  weak(9, 0) = 0.6, weak(20, 0) = 0.8;
  const JointFrame frame = frame_of(4);
  const JointSystem system(r.forms, frame);
  Eigen::MatrixXd saddle = Eigen::MatrixXd::Zero(19, 19);
  saddle.topLeftCorner<18, 18>() = r.a;
  saddle.topRightCorner<18, 1>() = weak.bottomRows<18>();
  saddle.bottomLeftCorner<1, 18>() = weak.bottomRows<18>().transpose();
  const Eigen::MatrixXd reply = saddle.inverse().topLeftCorner<18, 18>();
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(18, 18);
  const std::vector<double> ones(4, 1);
  for (const JointEntry& entry : system.scatter(system.pulls_by_place(details, ones)))
    scatter(entry.row(), entry.col()) += entry.value();
  const Eigen::MatrixXd expected = reply * scatter * reply;
  const JointMatrix sparse = scatter.sparseView();
  const WithholdingSolver solver(JointMatrix(r.a.sparseView()), system.reduced(weak));
  const std::vector<Matrix6> blocks = solver.sandwich_blocks(sparse);
  for (Eigen::Index k = 0; k < 3; ++k)
    EXPECT_LT((blocks[std::size_t(k)] - expected.block<6, 6>(6 * k, 6 * k)).norm(),
              1e-7 * expected.norm());
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
}  // namespace scan
