// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Hard cases of many scans: long paths on which each meets but a few others.
#include <gtest/gtest.h>

#include "tests/align/simulated_path.h"
#include "tests/align/turntable.h"

namespace scan {
namespace {

// Each scan shares 60 % with the next, 20 % with the one after that, and of its places nothing with
// any other: what is between neighbours must stand as well as the pairs have it, and the far end
// where the errors of 299 links, added up, may put it.
TEST(HardPath, ThreeHundredScansInARowStayTied) {
  constexpr std::size_t scans = 300;
  const test::SimulatedViews path =
      test::simulated_path(test::ScannerNoise::lidar, scans, 30, 0.8, 1);
  const MultiviewResult result = align_scans(path.clouds, path.guesses);
  // Nothing is free to slide: that the row bends as a whole is as well known as its links are.
  for (const ScanPose& scan : result.scans) EXPECT_EQ(scan.stop, Stop::converged);
  // Ten rounds for a path of any length: the step of each holds for all of it.
  EXPECT_LT(result.rounds, 20);
  const test::LinkErrors errors = test::link_errors(result, path.truth);
  EXPECT_GT(errors.links, 0.9 * scans);
  // A mean of chi-squares over six degrees of freedom has a standard error of sqrt(2 / 6 / 270)
  // = 0.035; a tenth of bias is what calibration allows a pair.
  EXPECT_LT(errors.mean, 1 + 0.1 + 3 * 0.035);
}

// What the errors of 36 pairs leave open when they are chained around a full turn, as far as a
// point 1.5 m away from the axis is moved, is more than the 2 mm that curvature and noise of 1 mm
// allow each scan (AlignScans.ATurntableClosesItsLoop); of joint poses none may be farther off.
TEST(HardTurn, ThirtySixScansCloseTheirLoop) {
  constexpr int scans = 36;
  const test::Turntable turn = test::turntable(scans, 0.001, 3000);
  Pose loop = Pose::Identity();
  for (std::size_t i = 0; i < scans; ++i) {
    const std::size_t next = (i + 1) % scans;
    const Pose guess = turn.guesses[i].inverse() * turn.guesses[next];
    loop = loop * icp(turn.clouds[next], turn.clouds[i], guess).target_from_source;
  }
  EXPECT_GT(loop.translation().norm() + 1.5 * rotation_distance_rad(loop, Pose::Identity()), 2e-3);
  const MultiviewResult result = align_scans(turn.clouds, turn.guesses);
  EXPECT_EQ(result.stop, Stop::converged);
  double worst_m = 0;
  for (std::size_t i = 0; i < scans; ++i)
    for (const Eigen::Vector3d& x : turn.clouds[i].points)
      worst_m = std::max(worst_m, (result.scans[i].world_from_scan * x - turn.truth[i] * x).norm());
  EXPECT_LT(worst_m, 2e-3);
}

}  // namespace
}  // namespace scan
