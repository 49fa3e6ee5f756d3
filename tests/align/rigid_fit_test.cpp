// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/rigid_fit.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/test_clouds.h"

namespace scan {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

Points random_points(std::size_t count, std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  Points points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(random.normal(), random.normal(), random.normal());
  return points;
}

Points moved(const Pose& pose, Points points) {
  for (Vector3d& x : points) x = pose * x;
  return points;
}

// A product of a few 3x3 factors rounds by a few epsilon per entry.
constexpr double rounding = 1e-14;

void expect_proper(const Pose& pose) {
  EXPECT_NEAR(pose.linear().determinant(), 1, 1e-15 * 4);
  EXPECT_LT((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
            rounding);
}

// Horn 1987: the unit quaternion that is the eigenvector of the largest eigenvalue of a symmetric
// 4x4 matrix of the cross-covariance; shares no step with the SVD.
Eigen::Matrix3d horn_rotation(const Points& source, const Points& target,
                              const std::vector<double>& weights) {
  Vector3d s_mean = Vector3d::Zero(), t_mean = Vector3d::Zero();
  double total = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    s_mean += weights[i] * source[i];
    t_mean += weights[i] * target[i];
    total += weights[i];
  }
  s_mean /= total;
  t_mean /= total;
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i)
    m += weights[i] * (source[i] - s_mean) * (target[i] - t_mean).transpose();
  Eigen::Matrix4d n;
  n << m.trace(), m(1, 2) - m(2, 1), m(2, 0) - m(0, 2), m(0, 1) - m(1, 0),  //
      0, m(0, 0) - m(1, 1) - m(2, 2), m(0, 1) + m(1, 0), m(2, 0) + m(0, 2),  //
      0, 0, -m(0, 0) + m(1, 1) - m(2, 2), m(1, 2) + m(2, 1),                 //
      0, 0, 0, -m(0, 0) - m(1, 1) + m(2, 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n.selfadjointView<Eigen::Upper>());
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

TEST(RigidFit, RecoversAnyMotion) {
  for (const double angle : {0.0, 1e-9, 0.3, 2.0, std::numbers::pi - 1e-9, std::numbers::pi}) {
    RandomStream random(1, 0, 0);
    const Pose truth = test::random_pose(random, angle, 3);
    const Points source = random_points(20, 2);
    const RigidFit fit = rigid_fit(source, moved(truth, source));
    EXPECT_LT((fit.target_from_source.matrix() - truth.matrix()).norm(), 10 * rounding) << angle;
    EXPECT_EQ(fit.rank, 3);
    EXPECT_LT(fit.rms_m, rounding);
    expect_proper(fit.target_from_source);
  }
}

TEST(RigidFit, AgreesWithHornsQuaternionOnNoisyWeightedPairs) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomStream random(seed, 3, 0);
    const Pose truth = test::random_pose(random, 3 * random.uniform(), 1);
    const Points source = random_points(12, seed);
    Points target = moved(truth, source);
    std::vector<double> weights;
    for (Vector3d& x : target) {
      x += 0.2 * Vector3d(random.normal(), random.normal(), random.normal());
      weights.push_back(random.uniform());
    }
    const Eigen::Matrix3d rotation = rigid_fit(source, target, weights).target_from_source.linear();
    // Eigenvectors are good to rounding over the gap of the eigenvalues, here above 0.1 of the norm.
    EXPECT_LT((rotation - horn_rotation(source, target, weights)).norm(), 1e-12);
  }
}

TEST(RigidFit, NoOtherMotionIsBetter) {
  RandomStream random(4, 0, 0);
  const Points source = random_points(15, 5), target = random_points(15, 6);
  const RigidFit fit = rigid_fit(source, target);
  const auto sum2 = [&](const Pose& pose) {
    double sum = 0;
    for (std::size_t i = 0; i < source.size(); ++i) sum += (pose * source[i] - target[i]).squaredNorm();
    return sum;
  };
  const double least = sum2(fit.target_from_source);
  EXPECT_NEAR(std::sqrt(least / 15), fit.rms_m, rounding);
  for (int i = 0; i < 200; ++i) {
    Vector6 twist;
    for (int k = 0; k < 6; ++k) twist[k] = random.normal();
    for (const double size : {1e-3, 0.1, 1.0})
      EXPECT_GT(sum2(exp(size * twist) * fit.target_from_source), least);
  }
}

TEST(RigidFit, WeightsCountLikeRepetition) {
  const Points source = random_points(5, 7), target = random_points(5, 8);
  Points s = source, t = target;
  for (int i = 0; i < 2; ++i) s.push_back(source[1]), t.push_back(target[1]);
  const std::vector<double> weights{1, 3, 1, 1, 1};
  EXPECT_LT((rigid_fit(source, target, weights).target_from_source.matrix() -
             rigid_fit(s, t).target_from_source.matrix()).norm(), 1e-13);
}

TEST(RigidFit, AMirrorImageGetsARotation) {
  const Points source = random_points(30, 9);
  Points target = source;
  for (Vector3d& x : target) x.z() = -x.z();
  expect_proper(rigid_fit(source, target).target_from_source);
}

TEST(RigidFit, CoplanarPointsHaveRankTwoAndAUniqueRotation) {
  RandomStream random(10, 0, 0);
  const Pose truth = test::random_pose(random, 2.5, 1);
  Points source = random_points(10, 11);
  for (Vector3d& x : source) x.z() = 0;
  const RigidFit fit = rigid_fit(source, moved(truth, source));
  EXPECT_EQ(fit.rank, 2);
  EXPECT_LT((fit.target_from_source.matrix() - truth.matrix()).norm(), 10 * rounding);
  expect_proper(fit.target_from_source);
}

// Of all rotations that carry one line onto the other the one by the angle between them is smallest.
TEST(RigidFit, CollinearPointsGetTheSmallestRotation) {
  for (const double angle : {0.0, 0.7, std::numbers::pi}) {
    const Vector3d a = Vector3d(1, 2, -1).normalized(), axis = a.unitOrthogonal();
    const Vector3d b = Eigen::AngleAxisd(angle, axis) * a;
    Points source, target;
    for (const double t : {-1.0, 0.5, 2.0, 3.0}) {
      source.push_back(t * a);
      target.push_back(t * b + Vector3d(5, 6, 7));
    }
    const RigidFit fit = rigid_fit(source, target);
    EXPECT_EQ(fit.rank, 1);
    EXPECT_LT(fit.rms_m, 10 * rounding);
    EXPECT_NEAR(rotation_angle_rad(fit.target_from_source.linear()), angle, 1e-7);
    expect_proper(fit.target_from_source);
  }
}

TEST(RigidFit, TwoPointsAreALine) {
  const Points source{{0, 0, 0}, {1, 0, 0}}, target{{1, 1, 1}, {1, 2, 1}};
  const RigidFit fit = rigid_fit(source, target);
  EXPECT_EQ(fit.rank, 1);
  EXPECT_NEAR(rotation_angle_rad(fit.target_from_source.linear()), std::numbers::pi / 2, rounding);
}

TEST(RigidFit, EqualPointsFixOnlyTheTranslation) {
  const Points source(7, Vector3d(1, 2, 3)), target(7, Vector3d(4, 4, 4));
  const RigidFit fit = rigid_fit(source, target);
  EXPECT_EQ(fit.rank, 0);
  EXPECT_EQ(fit.target_from_source.linear(), Eigen::Matrix3d::Identity());
  EXPECT_LT((fit.target_from_source.translation() - Vector3d(3, 2, 1)).norm(), rounding);
}

TEST(RigidFit, NoPairsGiveTheIdentity) {
  const RigidFit fit = rigid_fit({}, {});
  EXPECT_EQ(fit.rank, 0);
  EXPECT_EQ(fit.target_from_source.matrix(), Pose::Identity().matrix());
}

// At 1e7 m coordinates are rounded to 2e-9 m; the extent is 1 m, so is the rotation to 2e-9.
TEST(RigidFit, FarCoordinatesCostOnlyTheirRounding) {
  RandomStream random(12, 0, 0);
  const Pose truth = test::random_pose(random, 1, 1);
  const Vector3d offset(1e6, 1e7, -3e6);
  Points source = random_points(30, 13), target = moved(truth, source);
  for (Vector3d& x : source) x += offset;
  for (Vector3d& x : target) x += offset;
  const RigidFit fit = rigid_fit(source, target);
  EXPECT_LT((fit.target_from_source.linear() - truth.linear()).norm(), 1e-8);
  EXPECT_LT(fit.rms_m, 1e-8);
  Points line_s, line_t;
  for (const double t : {-1.0, 0.0, 1.0, 2.0}) {
    line_s.push_back(offset + t * Vector3d(1, 1, 1));
    line_t.push_back(offset + t * Vector3d(1, -1, 1));
  }
  EXPECT_EQ(rigid_fit(line_s, line_t).rank, 1);
}

TEST(RigidFit, RefusesWhatItCannotUse) {
  const Points two(2, Vector3d::Zero()), one(1, Vector3d::Zero());
  const Points bad(2, Vector3d(0, std::nan(""), 0));
  EXPECT_THROW(rigid_fit(two, one), Error);
  EXPECT_THROW(rigid_fit(two, bad), Error);
  EXPECT_THROW(rigid_fit(two, two, std::vector<double>{1, -1}), Error);
  EXPECT_THROW(rigid_fit(two, two, std::vector<double>{1}), Error);
}

}  // namespace
}  // namespace scan
