// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_prior.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "libscan/align/joint_guesses.h"
#include "libscan/align/joint_refinement.h"
#include "tests/align/joint_forms.h"
#include "tests/align/open_views.h"

namespace scan::test {
namespace {

constexpr double size_m = 0.25;

Vector6 twist_about(const Eigen::Vector3d& centre, const Pose& after, const Pose& before) {
  const Pose there =
      Eigen::Translation3d(-centre) * after * before.inverse() * Eigen::Translation3d(centre);
  Vector6 twist = log(there);
  twist.tail<3>() /= size_m;
  return twist;
}

// Guesses drawn 4,000 times about scanners half a metre off their points, that of the anchor too:
// the mean of e^T E^-1 e per degree of freedom is 1. Angle and distance are normal, along a
// direction by chance: of one part the square has variance 2, of six degrees 2 x 3 for the turn and
// as much for the shift over 36 at most a sigma of sqrt(12) / 6 / sqrt(4000) = 0.009, of which five
// are allowed; a twist of 0.01 rad is not linear to 1e-4.
TEST(GuessPrior, IsTheInformationOfDrawnGuesses) {
  const GuessSigma own{.rotation_rad = 0.01, .translation_m = 0.002},
      of_anchor{.rotation_rad = 0.003, .translation_m = 0.004};
  const std::vector<GuessSigma> sigmas = {of_anchor, own};
  RandomStream random(1, 0, 0);
  const Pose scanner[] = {random_pose(random, 1, 0.5), random_pose(random, 1, 0.5)};
  const Eigen::Vector3d middle(0.1, -0.2, 0.4);  // of the points in the scanner's frame
  const Pose local_in_scanner(Eigen::Translation3d{middle});
  double sum = 0;
  constexpr int draws = 4000;
  for (int k = 0; k < draws; ++k) {
    const Pose anchor_guess = drawn_guess(scanner[0], of_anchor, random);
    const Pose guess = drawn_guess(scanner[1], own, random);
    // Where scan 1 truly stands if the anchor stands as in its guess.
    const Pose should = anchor_guess * scanner[0].inverse() * scanner[1];
    const std::vector<Pose> guesses = {anchor_guess * local_in_scanner, guess * local_in_scanner},
                            poses = {guesses[0], should * local_in_scanner};
    const std::vector<Eigen::Vector3d> scanners = {anchor_guess.translation(), guess.translation()};
    const JointFrame frame{.centres = {poses[0].translation(), poses[1].translation()},
                           .size_m = size_m,
                           .free = {false, true}};
    const GuessPrior prior = guess_prior(frame, poses, guesses, scanners, sigmas, 0);
    EXPECT_EQ(prior.information[0], Matrix6::Zero());
    // The logarithm's shift is half of turn x shift off the end's, to this order.
    const Vector6& twist = prior.twists[1];
    EXPECT_LE((twist - twist_about(frame.centres[1], guesses[1], poses[1])).norm(),
              0.6 * twist.head<3>().norm() * twist.tail<3>().norm());
    sum += twist.dot(prior.information[1] * twist) / 6;
  }
  EXPECT_NEAR(sum / draws, 1, 5 * 0.009);
}

// Four scans in a ring whose couples leave the motions W open, with guesses: the posterior is a
// dense system.
struct OpenRing {
  std::vector<JointForm> forms;
  std::vector<JointDetail> details;
  JointFrame frame = frame_of(4);
  JointBasis weak;
  GuessPrior prior;
  Eigen::MatrixXd a, inverse_prior;  // 18 x 18, of scans 1 to 3
  Eigen::VectorXd b, e;
};

// Joint: what scans 1 and 2 may do together; else each scan by itself.
OpenRing open_ring(bool joint) {
  RandomStream random(9, 0, 0);
  const Vector6 open = random_row(random).normalized();
  const Matrix6 rest = Matrix6::Identity() - open * open.transpose();
  OpenRing r;
  r.a = r.inverse_prior = Eigen::MatrixXd::Zero(18, 18);
  r.b = r.e = Eigen::VectorXd::Zero(18);
  for (std::size_t i = 0; i < 4; ++i) {
    JointForm form = random_form(i, (i + 1) % 4, random);
    if (!joint || i != 1) form.a = (rest * form.a * rest).eval(), form.b = (rest * form.b).eval();
    JointDetail detail{.curvature = form.a};
    for (std::int64_t place = 0; place < 20; ++place) {
      Vector6 pull = random_row(random);
      if (!joint || i != 1) pull = (rest * pull).eval();
      detail.pulls.push_back({{place, std::int64_t(i), 0}, pull});
    }
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(6, 24);
    difference.middleCols<6>(6 * Eigen::Index(form.source)).setIdentity();
    difference.middleCols<6>(6 * Eigen::Index(form.target)) = -Matrix6::Identity();
    r.a += (difference.transpose() * form.a * difference).bottomRightCorner<18, 18>();
    r.b += (difference.transpose() * form.b).tail<18>();
    r.forms.push_back(form);
    r.details.push_back(detail);
  }
  r.weak = JointBasis::Zero(24, joint ? 2 : 3);
  for (Eigen::Index i = 1; i < 4; ++i)
    r.weak.block<6, 1>(6 * i, !joint ? i - 1 : i / 3) =
        open * (joint && i < 3 ? std::sqrt(0.5) : 1);
  r.prior.information.assign(4, Matrix6::Zero());
  r.prior.twists.assign(4, Vector6::Zero());
  for (Eigen::Index i = 1; i < 4; ++i) {
    Matrix6& own = r.prior.information[std::size_t(i)];
    for (int k = 0; k < 10; ++k) {
      const Vector6 row = random_row(random);
      own += 0.1 * row * row.transpose();
    }
    r.prior.twists[std::size_t(i)] = random_row(random);
    r.inverse_prior.block<6, 6>(6 * (i - 1), 6 * (i - 1)) = own;
    r.e.segment<6>(6 * (i - 1)) = r.prior.twists[std::size_t(i)];
  }
  return r;
}

// Of n scans no couple of which feigns anything, the step and the way to the guesses together are
// the most likely twists, (A + E^-1)^-1 (b + E^-1 e), to the 1e-10 that rounding_of adds.
TEST(GuessPrior, StepAndWayAreTheMostLikelyPoses) {
  for (const bool joint : {false, true}) {
    const OpenRing r = open_ring(joint);
    const Eigen::VectorXd most_likely =
        (r.a + r.inverse_prior).lu().solve(r.b + r.inverse_prior * r.e);
    const auto steps = joint_step(r.forms, r.frame, r.weak, r.prior);
    const std::vector<Pose> poses(4, Pose::Identity());
    const auto way = way_to_guesses(r.forms, r.frame, r.weak, poses, poses, 1e9, r.prior);
    EXPECT_TRUE(way.whole);
    for (std::size_t i = 1; i < 4; ++i)
      EXPECT_LT((steps[i] + way.twists[i] - most_likely.segment<6>(6 * Eigen::Index(i - 1))).norm(),
                1e-7 * most_likely.norm())
          << joint << i;
  }
}

// Without any scatter of the data what is left is what the guesses' errors make of the poses,
// H^-1 E^-1 H^-1 with H = A + E^-1; scatter adds to it.
TEST(GuessPrior, CovariancesAreThePosteriors) {
  for (const bool joint : {false, true}) {
    const OpenRing r = open_ring(joint);
    const auto stated = joint_covariances(r.forms, r.details, r.frame, r.weak, r.prior);
    const Eigen::MatrixXd posterior = (r.a + r.inverse_prior).inverse();
    std::vector<JointDetail> silent = r.details;
    for (JointDetail& detail : silent) detail.pulls.clear();
    const auto guessed = joint_covariances(r.forms, silent, r.frame, r.weak, r.prior);
    const Eigen::MatrixXd expected = posterior * r.inverse_prior * posterior;
    for (std::size_t i = 1; i < 4; ++i) {
      const Eigen::Index at = 6 * Eigen::Index(i - 1);
      ASSERT_TRUE(guessed.of_scan[i] && stated.of_scan[i]);
      EXPECT_LT((*guessed.of_scan[i] - expected.block<6, 6>(at, at)).norm(),
                1e-7 * expected.norm());
      EXPECT_GT((*stated.of_scan[i] - *guessed.of_scan[i]).trace(), 0);
      ASSERT_TRUE(guessed.from_guess[i]);
      EXPECT_LE(guessed.from_guess[i]->trace(), guessed.of_scan[i]->trace());
    }
    for (const CommonCovariance& couple : guessed.between) {
      const Matrix6 block = expected.block<6, 6>(6 * Eigen::Index(couple.first - 1),
                                                 6 * Eigen::Index(couple.second - 1));
      EXPECT_LT((couple.covariance - block).norm(), 1e-7 * expected.norm());
    }
    EXPECT_EQ(guessed.between.size(), 2u);
  }
}

}  // namespace
}  // namespace scan::test
