// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/guess_gate.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "libscan/align/multiview.h"
#include "tests/align/open_views.h"

namespace scan::test {
namespace {

// Two scans whose middles stand half a metre in front of their scanners.
struct GuessedPair {
  PreparedScans scans;
  std::vector<Pose> truth, guesses;  // world_from_local
  std::vector<GuessSigma> sigmas = {{.rotation_rad = 0.003, .translation_m = 0.004},
                                    {.rotation_rad = 0.01, .translation_m = 0.002}};

  explicit GuessedPair(RandomStream& random) {
    scans.clouds.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
      scans.clouds[i].origin = Eigen::Vector3d(0.1, -0.2, 0.5);
      const Pose scanner = random_pose(random, 1, 0.5);
      const Pose local(Eigen::Translation3d(scans.clouds[i].origin));
      truth.push_back(scanner * local);
      guesses.push_back(drawn_guess(scanner, sigmas[i], random) * local);
    }
  }
  Pose true_pair() const { return truth[1].inverse() * truth[0]; }
  bool rules_out(const Pose& target_from_source, const Matrix6& information) const {
    return is_ruled_out(scans, {0, 1, target_from_source, information}, {guesses, sigmas});
  }
};

// Of pairs that are right to 1e-9 none but one in a thousand is far from guesses drawn as stated;
// the sum of two such errors is more often small than one of them: of 4,000 at most 4 + 3 sqrt(4).
TEST(GuessGate, LetsRightPairsPass) {
  RandomStream random(1, 0, 0);
  int ruled_out = 0;
  for (int k = 0; k < 4000; ++k) {
    const GuessedPair pair(random);
    ruled_out += pair.rules_out(pair.true_pair(), 1e18 * Matrix6::Identity());
  }
  EXPECT_LE(ruled_out, 10);
}

// What the guesses' errors and the pair's own make of it, along one axis after another: in sigmas
// that the square root of three chi-squares' 99.9 % reaches. Guesses are right here; a turn of the
// source is about its middle, half a metre from either scanner, which adds what those turns carry.
TEST(GuessGate, CountsTheErrorsOfBothGuessesAndOfThePair) {
  RandomStream random(2, 0, 0);
  GuessedPair pair(random);
  pair.guesses = pair.truth;
  Vector6 unit;
  unit << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.005);
  const Matrix6 information = unit.cwiseAbs2().cwiseInverse().asDiagonal();
  // About the target's middle and in its frame, all to first order by differences.
  Matrix6 covariance = information.inverse();
  for (std::size_t i = 0; i < 2; ++i)
    for (int k = 0; k < 6; ++k) {
      constexpr double step = 1e-6;
      const double sigma = (k < 3 ? pair.sigmas[i].rotation_rad : pair.sigmas[i].translation_m);
      Vector6 twist = Vector6::Zero();
      twist[k] = step;
      const Eigen::Vector3d scanner = pair.guesses[i] * Eigen::Vector3d(-0.1, 0.2, -0.5);
      const Pose error =
          Eigen::Translation3d(scanner) * exp(twist) * Eigen::Translation3d(-scanner);
      std::vector<Pose> moved = pair.guesses;
      moved[i] = error * moved[i];
      const Vector6 by =
          log(moved[1].inverse() * moved[0] * pair.true_pair().inverse()) / step * sigma;
      covariance += by * by.transpose() / 3;
    }
  for (int k = 0; k < 6; ++k) {
    const double at_limit = std::sqrt(3 * 13.816 / covariance.inverse()(k, k));
    for (const double share : {0.97, -0.97, 1.03, -1.03}) {
      Vector6 twist = Vector6::Zero();
      twist[k] = share * at_limit;  // at most 0.1 rad, whose logarithm is straight to 1 %
      EXPECT_EQ(pair.rules_out(exp(twist) * pair.true_pair(), information), std::abs(share) > 1)
          << k << ' ' << share;
    }
  }
}

// A pair says nothing of what it leaves open, and guesses of which nobody knows anything rule out
// nothing.
TEST(GuessGate, CountsOnlyWhatIsKnown) {
  RandomStream random(3, 0, 0);
  GuessedPair pair(random);
  pair.guesses = pair.truth;
  Vector6 far = Vector6::Zero();
  far[5] = 0.5;
  Matrix6 information = 1e8 * Matrix6::Identity();
  EXPECT_TRUE(pair.rules_out(exp(far) * pair.true_pair(), information));
  information(5, 5) = 0;
  EXPECT_FALSE(pair.rules_out(exp(far) * pair.true_pair(), information));
  information(5, 5) = 1e8;
  pair.sigmas.clear();
  EXPECT_FALSE(pair.rules_out(exp(far) * pair.true_pair(), information));
}

}  // namespace
}  // namespace scan::test
