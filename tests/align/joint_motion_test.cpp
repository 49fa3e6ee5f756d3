// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_motion.h"

#include <gtest/gtest.h>

#include "libscan/core/random.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// Scans along x, one metre apart, each coupled to the next half way between.
struct Chain {
  std::vector<Pose> poses;
  std::vector<JointForm> forms;
  JointFrame frame;
};

Chain chain(std::size_t scans) {
  Chain c;
  c.frame.size_m = 0.7;
  for (std::size_t i = 0; i < scans; ++i) {
    RandomStream random(1, 0, i);
    const double x = random.normal(), y = random.normal();
    const Vector3d at(double(i), 0.1 * x, 0.1 * y);
    c.poses.push_back(make_pose(Eigen::AngleAxisd(x, Vector3d(1, y, 2).normalized()).matrix(), at));
    c.frame.centres.push_back(at);
    c.frame.free.push_back(i > 0);
    if (i > 0)
      c.forms.push_back({.source = i,
                         .target = i - 1,
                         .pairs = 10,
                         .frame = {.centre = at - Vector3d(0.5, 0, 0), .size_m = 0.5}});
  }
  return c;
}

// The chain turns by 0.1 rad about its start, and each couple by a thousandth or so more. Turned
// about their own centres and shifted, neighbours would be off by 0.1^2 / 2 of the metre between
// them.
TEST(MovedTogether, KeepsCouplesAsTheTwistsSayInALongChain) {
  const Chain c = chain(100);
  std::vector<Vector6> twists(100, Vector6::Zero());
  const Vector3d turn(0, 0.06, 0.08);
  RandomStream random(2, 0, 0);
  for (std::size_t i = 1; i < 100; ++i) {
    twists[i].head<3>() = turn;
    twists[i].tail<3>() = turn.cross(c.poses[i].translation()) / c.frame.size_m;
    for (int k = 0; k < 6; ++k) twists[i][k] += 1e-3 * random.normal();
  }
  Eigen::VectorXd all(600);
  for (Eigen::Index i = 0; i < 100; ++i) all.segment<6>(6 * i) = twists[std::size_t(i)];
  const Eigen::VectorXd wanted = relative_twists(c.forms, c.frame) * all;
  const std::vector<Pose> moved = moved_together(c.forms, c.frame, c.poses, twists);
  EXPECT_EQ(moved[0].matrix(), c.poses[0].matrix());
  for (std::size_t k = 0; k < c.forms.size(); ++k) {
    const JointForm& form = c.forms[k];
    const Pose there = c.poses[form.target] * moved[form.target].inverse() * moved[form.source];
    const Eigen::Translation3d centre(form.frame.centre);
    Vector6 twist = log(centre.inverse() * there * c.poses[form.source].inverse() * centre);
    twist.tail<3>() /= form.frame.size_m;
    // To the end of the corrections, 1e-7.
    EXPECT_LT((twist - wanted.segment<6>(6 * Eigen::Index(k))).norm(), 3e-7) << k;
  }
}

// A row of 1,000 whose couples all turn by 1e-4 rad, 0.1 rad from end to end: what is missing after
// the first round is a bend, of which the couples see n^-4.
TEST(MovedTogether, BendsALongChainAsItsCouplesDo) {
  const Chain c = chain(1000);
  std::vector<Vector6> twists(1000, Vector6::Zero());
  Vector6 wanted = Vector6::Zero();
  wanted[2] = 1e-4;
  // Of each scan as the couples before it have turned it and carried its centre.
  for (std::size_t i = 1; i < 1000; ++i) {
    const Vector3d step = c.frame.centres[i] - c.frame.centres[i - 1];
    const Vector3d arm = c.frame.centres[i] - c.forms[i - 1].frame.centre;
    const Vector3d before = twists[i - 1].head<3>(), turn = wanted.head<3>();
    twists[i].head<3>() = before + turn;
    twists[i].tail<3>() =
        twists[i - 1].tail<3>() + (before.cross(step) + turn.cross(arm)) / c.frame.size_m;
  }
  const std::vector<Pose> moved = moved_together(c.forms, c.frame, c.poses, twists);
  for (std::size_t k = 0; k < c.forms.size(); ++k)
    EXPECT_LT((relative_twist(c.forms[k], c.poses, moved) - wanted).norm(), 3e-7) << k;
}

// Points of a scan move as its twist says, less those of the scan that it is coupled to.
TEST(RelativeTwists, AreTheDifferenceAtTheForm) {
  const Chain c = chain(3);
  RandomStream random(3, 0, 0);
  Eigen::VectorXd all(18);
  for (Eigen::Index k = 0; k < 18; ++k) all[k] = random.normal();
  all.head<6>().setZero();
  const Eigen::VectorXd relative = relative_twists(c.forms, c.frame) * all;
  const Vector3d point(7, 8, 9);
  const auto velocity = [&](Eigen::Index scan) {
    const Vector6 own = all.segment<6>(6 * scan);
    return Vector3d(own.head<3>().cross(point - c.frame.centres[std::size_t(scan)]) +
                    c.frame.size_m * own.tail<3>());
  };
  const Vector6 x = relative.segment<6>(6);
  const Vector3d by_form = x.head<3>().cross(point - c.forms[1].frame.centre) + 0.5 * x.tail<3>();
  EXPECT_LT((by_form - (velocity(2) - velocity(1))).norm(), 1e-12);
}

}  // namespace
}  // namespace scan
