// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What the couples' scatter makes of the poses.
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
  ASSERT_TRUE(covariances.of_scan[1]);
  Matrix6 units = Matrix6::Identity();
  units.bottomRightCorner<3, 3>() *= 3;
  const Matrix6 expected = share * units * inverse * scatter * inverse * units;
  EXPECT_LT((*covariances.of_scan[1] - expected).norm(), 1e-7 * expected.norm());
  EXPECT_EQ(*covariances.of_scan[0], Matrix6::Zero());
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
  const double times = covariances.of_scan[1]->trace() / link.trace();
  EXPECT_GE(times, 1);
  EXPECT_LT((*covariances.of_scan[1] - times * link).norm(), 1e-7 * times * link.norm());
}

// Of a ring of four scans: blocks of the dense sandwich, rows for the first scan. A couple's pulls
// are longer by what its free scans share.
TEST(JointCovariances, BetweenScansHaveTheFirstAlongTheRows) {
  const Ring r = ring();
  std::vector<JointDetail> details(4);
  std::vector<std::vector<Vector6>> pulls(4);
  std::vector<std::vector<Vector3d>> at(4);
  std::vector<Matrix6> scatter(4, Matrix6::Zero()), of_scan = scatter;
  RandomStream random(9, 0, 0);
  for (std::size_t k = 0; k < 4; ++k) {
    details[k].curvature = r.forms[k].a;
    for (std::int64_t place = 0; place < 20; ++place) {
      const Vector6 pull = random_row(random);
      details[k].pulls.push_back({{place, std::int64_t(k), 0}, pull});
      scatter[k] += pull * pull.transpose();
      for (const std::size_t scan : {r.forms[k].source, r.forms[k].target}) {
        pulls[scan].push_back(scan == r.forms[k].source ? pull : Vector6(-pull));
        at[scan].emplace_back(double(place), double(k), 0);
        of_scan[scan] += pull * pull.transpose();
      }
    }
  }
  std::vector<double> shares(4, 1);  // the anchor's do not count
  for (std::size_t i = 1; i < 4; ++i) {
    const Eigen::LLT<Matrix6> spread(of_scan[i]);
    for (Vector6& pull : pulls[i]) pull = spread.matrixL().solve(pull).eval();
    shares[i] = std::max(1.0, noise_sharing(pulls[i], at[i], 6));
  }
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(24, 24);
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t i = r.forms[k].source, j = r.forms[k].target;
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(6, 24);
    difference.middleCols<6>(6 * Eigen::Index(i)).setIdentity();
    difference.middleCols<6>(6 * Eigen::Index(j)) = -Matrix6::Identity();
    const double longer =
        i == 0 || j == 0 ? shares[i] * shares[j] : std::sqrt(shares[i] * shares[j]);
    all += longer * difference.transpose() * scatter[k] * difference;
  }
  const Eigen::MatrixXd inverse = r.a.inverse();
  const Eigen::MatrixXd expected = inverse * all.bottomRightCorner<18, 18>() * inverse;
  const auto found = joint_covariances(r.forms, details, frame_of(4), JointBasis(24, 0));
  ASSERT_EQ(found.between.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const CommonCovariance& couple = found.between[k];
    EXPECT_EQ(std::pair(couple.first, couple.second), std::pair(k + 1, k + 2));
    const Matrix6 block = expected.block<6, 6>(6 * Eigen::Index(k), 6 * Eigen::Index(k + 1));
    EXPECT_LT((couple.covariance - block).norm(), 1e-7 * expected.norm());
    EXPECT_GT((block - block.transpose()).norm(),
              1e-3 * expected.norm());  // tells rows from columns
  }
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
  const std::vector<BlockAt> places = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {2, 0}};
  const std::vector<Matrix6> blocks = solver.sandwich_blocks(sparse, places);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto [i, j] = places[k];
    const Matrix6 block = expected.block<6, 6>(6 * Eigen::Index(i), 6 * Eigen::Index(j));
    EXPECT_LT((blocks[k] - block).norm(), 1e-7 * expected.norm()) << k;
  }
}

}  // namespace
}  // namespace scan::test
