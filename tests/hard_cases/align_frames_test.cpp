// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Alignment must not depend on the unit, the frame, or the distance from the origin.
#include <gtest/gtest.h>

#include "tests/align/icp_methods.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

class HardFrame : public testing::TestWithParam<IcpMethod> {
 protected:
  // Enough iterations for point-to-point, which creeps; 400 points keep it quick.
  IcpOptions options() const { return {.method = GetParam(), .max_iterations = 300}; }

  void SetUp() override {
    const auto halves = test::split(test::bumpy_surface(6000, 1), 2);
    source = halves.first;
    target = halves.second;
    test::add_noise(target, 1e-3, 3);
    RandomStream random(4, 0, 0);
    guess = test::random_pose(random, 0.03, 0.03);
    reference = icp(source, target, guess, options());
    ASSERT_EQ(reference.stop, Stop::converged);
  }

  PointCloud source, target;
  Pose guess;
  IcpResult reference;
};
INSTANTIATE_TEST_SUITE_P(EveryMethod, HardFrame, testing::ValuesIn(test::icp_methods),
                         test::method_name);

// H8: UTM, earth-centred, and farther. Coordinates there are rounded by 2^-53 of their size, so is
// the pose, relative to an extent of 2 m; 4 such roundings meet.
TEST_P(HardFrame, FarFromTheOriginThePoseIsTheSame) {
  for (const Vector3d& offset :
       {Vector3d(5e5, 5.4e6, 0), Vector3d(0, 6.378e6, 0), Vector3d(1e6, 1e7, 0)}) {
    PointCloud far_source = source, far_target = target;
    for (Vector3d& x : far_source.points) x += offset;
    for (Vector3d& x : far_target.points) x += offset;
    const Pose far_guess = Eigen::Translation3d(offset) * guess * Eigen::Translation3d(-offset);
    const IcpResult far = icp(far_source, far_target, far_guess, options());
    const double rounding_m = 4 * offset.norm() * 0x1p-53;
    EXPECT_EQ(far.stop, reference.stop);
    EXPECT_EQ(far.iterations, reference.iterations);
    EXPECT_LT((far.target_from_source.linear() - reference.target_from_source.linear()).norm(),
              rounding_m);
    for (const std::size_t i : {0u, 1000u, 2000u})
      EXPECT_LT((far.target_from_source * far_source.points[i] - offset -
                 reference.target_from_source * source.points[i])
                    .norm(),
                rounding_m);
  }
}

// H9: micrometres to thousands of kilometres; powers of ten round each coordinate once.
TEST_P(HardFrame, TheUnitDoesNotMatter) {
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    PointCloud s = source, t = target;
    for (Vector3d& x : s.points) x *= scale;
    for (Vector3d& x : t.points) x *= scale;
    const IcpResult scaled =
        icp(s, t, make_pose(guess.linear(), scale * guess.translation()), options());
    EXPECT_EQ(scaled.iterations, reference.iterations) << scale;
    EXPECT_LT((scaled.target_from_source.linear() - reference.target_from_source.linear()).norm(),
              1e-10);
    EXPECT_LT((scaled.target_from_source.translation() / scale -
               reference.target_from_source.translation())
                  .norm(),
              1e-10);
  }
}

// H10
TEST_P(HardFrame, TheFrameDoesNotMatter) {
  RandomStream random(5, 0, 0);
  for (int trial = 0; trial < 5; ++trial) {
    const Pose frame = test::random_pose(random, 3 * random.uniform(), 1);
    const IcpResult turned = icp(transformed(frame, source), transformed(frame, target),
                                 frame * guess * frame.inverse(), options());
    EXPECT_EQ(turned.iterations, reference.iterations);
    EXPECT_LT((frame.inverse() * turned.target_from_source * frame)
                      .matrix()
                      .isApprox(reference.target_from_source.matrix(), 1e-10)
                  ? 0
                  : 1,
              1);
  }
}

// H12: the start and the truth are half a turn apart from the identity; logarithms meet pi.
TEST_P(HardFrame, HalfATurnIsAnOrdinaryRotation) {
  for (const double angle : {std::numbers::pi, std::numbers::pi - 1e-9}) {
    const Pose turn =
        make_pose(Eigen::AngleAxisd(angle, Vector3d(0.6, 0, 0.8)).toRotationMatrix(), {1, 2, 3});
    const IcpResult turned = icp(source, transformed(turn, target), turn * guess, options());
    EXPECT_TRUE((turn.inverse() * turned.target_from_source)
                    .matrix()
                    .isApprox(reference.target_from_source.matrix(), 1e-10));
    EXPECT_NEAR(turned.target_from_source.linear().determinant(), 1, 4e-15);
  }
}

}  // namespace
}  // namespace scan
