// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/joint_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "libscan/align/loss.h"
#include "libscan/align/pairs.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

// Two scans of a bumpy surface, each without one end, at poses near the truth.
struct Setting {
  PreparedCloud source, target;
  Pose world_from_source, world_from_target;
  IcpOptions options = {.method = IcpMethod::point_to_plane, .max_pair_distance_m = 0.2};
};

Setting setting(std::uint64_t seed) {
  RandomStream random(seed, 0, 0);
  auto [a, b] = test::split(test::bumpy_surface(1600, seed), seed);
  const auto part = [](const PointCloud& cloud, double low_m, double high_m) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
      if (cloud.points[i].x() > low_m && cloud.points[i].x() < high_m) kept.push_back(i);
    return subset(cloud, kept);
  };
  a = part(a, -1, 0.5);
  b = part(b, -0.5, 1);
  test::add_noise(a, 0.005, seed);
  Setting made{.source = prepare(a), .target = prepare(b)};
  const Pose world = test::random_pose(random, 1.2, 5);
  made.world_from_source = world * Eigen::Translation3d(made.source.origin);
  made.world_from_target =
      world * test::random_pose(random, 0.02, 0.02) * Eigen::Translation3d(made.target.origin);
  return made;
}

struct OraclePair {
  std::uint32_t source = 0, target = 0;
  double residual_m = 0;
};

// Of every asked point the nearest of all points, which counts if it is near, beside the target's
// plane by no more than its share of the fit's reach, and with a normal at most 45 degrees off.
std::vector<OraclePair> pairs_by_definition(const Setting& s, std::size_t stride,
                                            std::size_t first) {
  std::vector<OraclePair> pairs;
  for (std::uint32_t i = 0; i < s.source.size(); ++i) {
    if (s.source.index[i] % stride != first) continue;
    const Vector3d x = s.world_from_source * s.source.points[i];
    std::uint32_t best = 0;
    double least_m = unlimited_m;
    for (std::uint32_t j = 0; j < s.target.size(); ++j) {
      const double distance_m = (s.world_from_target * s.target.points[j] - x).norm();
      if (distance_m < least_m) best = j, least_m = distance_m;
    }
    const Vector3d n = s.world_from_target.linear() * s.target.normals[best];
    const Vector3d m = s.world_from_source.linear() * s.source.normals[i];
    const Vector3d apart = x - s.world_from_target * s.target.points[best];
    const double beside_m = (apart - apart.dot(n) * n).norm();
    if (least_m > s.options.max_pair_distance_m ||
        beside_m > plane_share_of_reach * s.target.fits[best].reach_m ||
        m.dot(n) < std::cos(s.options.max_normal_angle_rad))
      continue;
    pairs.push_back({i, best, std::abs(apart.dot(n))});
  }
  return pairs;
}

// The upper of the two middle ones.
double median_m(std::vector<OraclePair> pairs) {
  std::sort(pairs.begin(), pairs.end(),
            [](const OraclePair& a, const OraclePair& b) { return a.residual_m < b.residual_m; });
  return pairs[pairs.size() / 2].residual_m;
}

struct Sums {
  std::size_t pairs = 0;
  Matrix6 a = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
};

// Sum of w J^T J and -w J^T r over the squared sigma that the scale stands for, J by the twist
// about the form's centre in units of its size.
Sums sums_by_definition(const Setting& s, const std::vector<OraclePair>& pairs,
                        const JointForm& form) {
  Sums sums;
  const double sigma_m = 1.4826 / 1.5 * form.scale_m;
  for (const OraclePair& pair : pairs) {
    if (pair.residual_m > 3 * form.scale_m) continue;
    ++sums.pairs;
    const Vector3d x = s.world_from_source * s.source.points[pair.source];
    const Vector3d n = s.world_from_target.linear() * s.target.normals[pair.target];
    const double ratio = pair.residual_m / form.scale_m;
    const double weight = std::exp(-0.5 * ratio * ratio) / (sigma_m * sigma_m);
    Vector6 row;
    row << (x - form.frame.centre).cross(n), form.frame.size_m * n;
    sums.a += weight * row * row.transpose();
    sums.b -= weight * row * n.dot(x - s.world_from_target * s.target.points[pair.target]);
  }
  return sums;
}

// Both go through the same sums in another order and frame: to rounding, 1e-16 times the 800 pairs
// and the coordinates of some metres over residuals of millimetres, 1e-9.
TEST(JointForm, IsTheSumOverPartnersThatComparingAllWithAllFinds) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Setting s = setting(seed);
    for (const std::size_t stride : {1u, 3u}) {
      const std::size_t first = stride - 1;
      const JointCouple couple{.source = 0, .target = 1, .stride = stride, .first = first};
      const JointForm form = joint_form(couple, s.source, s.target, s.world_from_source,
                                        s.world_from_target, s.options);
      const auto pairs = pairs_by_definition(s, stride, first);
      ASSERT_GT(pairs.size(), 100u);
      ASSERT_LT(pairs.size(), form.asked);  // some found none
      EXPECT_NEAR(form.scale_m, 3 * median_m(pairs), 1e-12);
      const Sums sums = sums_by_definition(s, pairs, form);
      EXPECT_EQ(form.pairs, sums.pairs);
      EXPECT_LT((form.a - sums.a).norm(), 1e-9 * sums.a.norm());
      EXPECT_LT((form.b - sums.b).norm(), 1e-9 * sums.b.norm());
    }
  }
}

// A step by the normal equations of one form lowers what it is made of.
TEST(JointForm, SourceAndTargetMoveAgainstEachOther) {
  const Setting s = setting(4);
  const JointCouple couple{.source = 0, .target = 1};
  const JointForm form =
      joint_form(couple, s.source, s.target, s.world_from_source, s.world_from_target, s.options);
  Vector6 step = form.a.ldlt().solve(form.b);
  step.tail<3>() *= form.frame.size_m;
  const Pose about = Eigen::Translation3d(form.frame.centre) * exp(step) *
                     Eigen::Translation3d(-form.frame.centre);
  const auto rms_after = [&](const Pose& source, const Pose& target) {
    return joint_form(couple, s.source, s.target, source, target, s.options).rms_m;
  };
  const double with_source = rms_after(about * s.world_from_source, s.world_from_target);
  const double with_target = rms_after(s.world_from_source, about.inverse() * s.world_from_target);
  EXPECT_LT(with_source, 0.9 * form.rms_m);
  EXPECT_NEAR(with_source, with_target, 1e-9);  // only their relative pose matters
}

TEST(JointForm, ItsScaleFollowsTheResidualsButNeverWidensOrJumps) {
  const Setting s = setting(5);
  const auto form_after = [&](double last_m) {
    const JointCouple couple{.source = 0, .target = 1, .scale_m = last_m};
    return joint_form(couple, s.source, s.target, s.world_from_source, s.world_from_target,
                      s.options);
  };
  const auto scale_after = [&](double last_m) { return form_after(last_m).scale_m; };
  const double first_m = scale_after(unlimited_m), end_m = first_m / 2;  // 3 and 1.5 medians
  EXPECT_DOUBLE_EQ(scale_after(first_m), 0.7 * first_m);
  EXPECT_DOUBLE_EQ(scale_after(1.1 * end_m), end_m);
  EXPECT_DOUBLE_EQ(scale_after(0.9 * end_m), 0.9 * end_m);
  for (const double wide_m : {unlimited_m, first_m, 1.5 * end_m})
    EXPECT_TRUE(form_after(wide_m).narrowing) << wide_m;
  for (const double near_m : {1.4 * end_m, 1.1 * end_m, 0.9 * end_m})
    EXPECT_FALSE(form_after(near_m).narrowing) << near_m;
}

// The first one alone is as wide as it must be at least.
TEST(JointForm, ItsFirstScaleIsAsWideAsAsked) {
  const Setting s = setting(5);
  const auto scale_m = [&](double last_m, double first_m) {
    const JointCouple couple{.source = 0, .target = 1, .scale_m = last_m, .first_m = first_m};
    return joint_form(couple, s.source, s.target, s.world_from_source, s.world_from_target,
                      s.options)
        .scale_m;
  };
  const double usual_m = scale_m(unlimited_m, 0);
  EXPECT_EQ(scale_m(unlimited_m, 0.9 * usual_m), usual_m);
  EXPECT_EQ(scale_m(unlimited_m, 20 * usual_m), 20 * usual_m);
  EXPECT_DOUBLE_EQ(scale_m(10 * usual_m, 20 * usual_m), 7 * usual_m);
}

TEST(JointForm, TooSmallAnOverlapIsNone) {
  Setting s = setting(6);
  const JointCouple couple{.source = 0, .target = 1};
  const auto pairs_with = [&](double least) {
    s.options.min_overlap = least;
    return joint_form(couple, s.source, s.target, s.world_from_source, s.world_from_target,
                      s.options);
  };
  const JointForm form = pairs_with(0.01);
  const double share = double(form.pairs) / double(form.asked);
  EXPECT_EQ(pairs_with(0.999 * share).pairs, form.pairs);
  EXPECT_EQ(pairs_with(1.001 * share).pairs, 0u);
}

// What the couple pulls is the right side of its normal equations, place by place; along the
// surface a pull goes by the middle of the two points, which a turn about the centre tells apart.
TEST(JointForm, PullsAddUpToTheRightSide) {
  const Setting s = setting(7);
  JointDetail detail;
  const JointForm form =
      joint_form({.source = 0, .target = 1}, s.source, s.target, s.world_from_source,
                 s.world_from_target, s.options, 0.25, &detail);
  Vector6 sum = Vector6::Zero();
  std::set<std::array<std::int64_t, 3>> places;
  for (const PatchPull& pull : detail.pulls) {
    sum += pull.gradient;
    EXPECT_TRUE(places.insert(pull.place).second);
  }
  EXPECT_GT(places.size(), 20u);
  EXPECT_LT((sum + form.b).tail<3>().norm(), 1e-9 * form.b.tail<3>().norm());
  EXPECT_EQ(detail.paired.size(), form.pairs);
}

TEST(JointCouples, AskEachPointInAsManyScansAsThereMayBe) {
  constexpr std::size_t scans = 30, most = 16;
  std::vector<std::pair<std::size_t, std::size_t>> all;
  for (std::size_t i = 0; i < scans; ++i)
    for (std::size_t j = i + 1; j < scans; ++j) all.emplace_back(i, j);
  const auto couples = joint_couples(all, scans, most);
  EXPECT_EQ(couples.size(), scans * (scans - 1));
  std::set<std::pair<std::size_t, std::size_t>> directed;
  std::vector<std::vector<int>> asked(scans, std::vector<int>(1000, 0));
  for (const JointCouple& couple : couples) {
    EXPECT_TRUE(directed.emplace(couple.source, couple.target).second);
    ASSERT_LT(couple.first, couple.stride);
    for (std::size_t p = couple.first; p < 1000; p += couple.stride) ++asked[couple.source][p];
  }
  for (const auto& counts : asked) {
    EXPECT_GE(*std::min_element(counts.begin(), counts.end()), int(scans - 1) / 2);
    EXPECT_LE(*std::max_element(counts.begin(), counts.end()), int(most));
  }
}

TEST(JointCouples, FewPartnersAreAskedForEveryPoint) {
  const std::vector<std::pair<std::size_t, std::size_t>> overlapping = {{0, 1}, {1, 2}};
  for (const JointCouple& couple : joint_couples(overlapping, 3, 16)) {
    EXPECT_EQ(couple.stride, 1u);
    EXPECT_EQ(couple.first, 0u);
  }
}

}  // namespace
}  // namespace scan
