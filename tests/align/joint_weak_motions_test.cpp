// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Motions of scans, alone and together, that noise leaves open.
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

// The least eigenvalue of a row of n that bends is that of a clamped beam, (1.875 / n)^4: 1.2e-11
// of a couple's own for n = 1,000.
TEST(JointWeakMotions, ALongRowMayBendNoMoreThanItsCouplesLetIt) {
  const Row row = row_of(1000);
  EXPECT_EQ(joint_weak_motions(row.forms, row.frame).cols(), 0);
}

// Each couple asks for one and the same bend. The diagonal of 2.5 is made larger by 1e-14 of it,
// which is 0.002 of the least eigenvalue.
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

}  // namespace
}  // namespace scan::test
