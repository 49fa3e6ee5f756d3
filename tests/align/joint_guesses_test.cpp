// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_guesses.h"

#include <gtest/gtest.h>

#include "libscan/core/random.h"

namespace scan {
namespace {

using Eigen::Vector3d;

constexpr std::size_t scans = 40, weak_at = 20;
constexpr double slid_m = 0.03;

// Scans along x, one metre apart in the guesses. The chain found bends away from these by 0.005 rad
// at each couple, which the data hold; scan 20 and all behind it may slide along y, which nothing
// holds, and are 0.03 m off there.
struct BentChain {
  std::vector<Pose> poses, guesses;
  std::vector<JointForm> forms;
  JointFrame frame;
  JointBasis weak;
};

BentChain bent_chain() {
  BentChain c;
  c.weak = JointBasis::Zero(6 * scans, 1);
  for (std::size_t i = 0; i < scans; ++i) {
    c.guesses.push_back(Pose(Eigen::Translation3d(double(i), 0, 0)));
    if (i == 0) {
      c.poses.push_back(c.guesses[0]);
    } else {
      const Pose step = c.guesses[i - 1].inverse() * c.guesses[i];
      const Pose bend(Eigen::AngleAxisd(0.005, Vector3d::UnitY()));
      c.poses.push_back(c.poses.back() * bend * step);
    }
  }
  for (std::size_t i = 0; i < scans; ++i) {
    if (i >= weak_at) c.poses[i] = Eigen::Translation3d(0, slid_m, 0) * c.poses[i];
    c.frame.centres.push_back(c.poses[i].translation());
    c.frame.free.push_back(i > 0);
    if (i > 0)
      c.forms.push_back({.source = i,
                         .target = i - 1,
                         .pairs = 10,
                         .frame = {.centre = c.poses[i].translation(), .size_m = 0.5}});
    if (i >= weak_at) c.weak(6 * Eigen::Index(i) + 4, 0) = 1 / std::sqrt(double(scans - weak_at));
  }
  c.frame.size_m = 2;
  return c;
}

// By its place the end of the chain is 39^2 / 2 0.005 m = 3.8 m off the guess: the couple that may
// slide is not to make up for that. Its guess is 0.03 m away, seen from a target that is turned by
// 19 x 0.005 rad about the very axis it slides along.
TEST(WayToGuesses, BringsBackTheCoupleThatIsOpenNotTheDrift) {
  const BentChain c = bent_chain();
  const WayToGuesses way = way_to_guesses(c.forms, c.frame, c.weak, c.poses, c.guesses, 1);
  EXPECT_TRUE(way.whole);
  for (std::size_t i = 0; i < scans; ++i) {
    const double y_m = i < weak_at ? 0 : -slid_m;
    EXPECT_LT((2 * way.twists[i].tail<3>() - Vector3d(0, y_m, 0)).norm(), 1e-9) << i;
    EXPECT_EQ(way.twists[i].head<3>(), Vector3d::Zero()) << i;
  }
}

TEST(WayToGuesses, IsCutWhereACoupleWouldLoseItsPartners) {
  const BentChain c = bent_chain();
  const WayToGuesses way = way_to_guesses(c.forms, c.frame, c.weak, c.poses, c.guesses, 0.01);
  EXPECT_FALSE(way.whole);
  EXPECT_NEAR(2 * way.twists[weak_at][4], -0.01, 1e-12);
}

TEST(WayToGuesses, IsNoneWhereNothingIsWeak) {
  const BentChain c = bent_chain();
  const WayToGuesses way =
      way_to_guesses(c.forms, c.frame, JointBasis(6 * scans, 0), c.poses, c.guesses, 1);
  EXPECT_TRUE(way.whole);
  for (const Vector6& twist : way.twists) EXPECT_EQ(twist, Vector6::Zero());
}

}  // namespace
}  // namespace scan
