// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/icp.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/icp_methods.h"
#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;
using test::icp_methods;

double pose_difference(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).norm();
}

// The same points before and after the motion: zero residual at the truth, so it is met to
// rounding.
TEST(Icp, RecoversANoiseFreeMotionExactly) {
  const PointCloud source = test::bumpy_surface(2000, 1);
  RandomStream random(2, 0, 0);
  const Pose truth = test::random_pose(random, 1, 2);
  const PointCloud target = transformed(truth, source);
  for (const IcpMethod method : icp_methods) {
    // The start is off by less than half a spacing of 0.045 m, so most first partners are right.
    const Pose guess = truth * test::random_pose(random, 0.01, 0.01);
    const IcpResult result = icp(source, target, guess, {.method = method});
    EXPECT_EQ(result.stop, Stop::converged) << name_of(method);
    EXPECT_LT(pose_difference(result.target_from_source, truth), 1e-12);
    EXPECT_LT(result.rms_m, 1e-13);
    EXPECT_TRUE(result.weak_directions.empty());
  }
}

// Halves of one cloud share no point. A partner is off by about half a spacing h along the surface;
// a plane through it is then off by curvature times h^2 / 8, here 3 / m * (0.02 m)^2 / 8 = 0.15 mm,
// which averages over the pairs.
TEST(Icp, JoinsCloudsWithoutCommonPoints) {
  const auto [source, other] = test::split(test::bumpy_surface(20000, 3), 4);
  RandomStream random(5, 0, 0);
  const Pose truth = test::random_pose(random, 0.5, 1);
  const IcpResult result =
      icp(source, transformed(truth, other), truth * test::random_pose(random, 0.05, 0.05));
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_LT(translation_distance_m(result.target_from_source, truth), 0.15e-3);
  EXPECT_LT(rotation_distance_rad(result.target_from_source, truth), 0.15e-3);
}

TEST(Icp, PartialOverlapDoesNotPullTheCloudsTogether) {
  PointCloud all = test::bumpy_surface(20000, 6);
  const auto [a, b] = test::split(all, 7);
  const auto part = [](const PointCloud& cloud, double from, double to) {
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
      if (cloud.points[i].x() >= from && cloud.points[i].x() <= to) kept.push_back(i);
    return subset(cloud, kept);
  };
  RandomStream random(8, 0, 0);
  // 1.3 m of 2 m each: 46 % of the source's points have a counterpart.
  const IcpResult result =
      icp(part(a, -1, 0.3), part(b, -0.3, 1), test::random_pose(random, 0.03, 0.03));
  EXPECT_EQ(result.stop, Stop::converged);
  EXPECT_LT(translation_distance_m(result.target_from_source, Pose::Identity()), 1e-3);
  EXPECT_LT(rotation_distance_rad(result.target_from_source, Pose::Identity()), 1e-3);
  EXPECT_LT(result.inlier_fraction_of_source, 0.5);
  // The same pose, but not to be trusted where more overlap was asked for.
  const IcpResult refused =
      icp(part(a, -1, 0.3), part(b, -0.3, 1), result.target_from_source, {.min_overlap = 0.6});
  EXPECT_EQ(refused.stop, Stop::low_overlap);
  EXPECT_LT(translation_distance_m(refused.target_from_source, Pose::Identity()), 1e-3);
}

TEST(Icp, EverySearchGivesTheSamePose) {
  const auto [source, target] = test::split(test::bumpy_surface(4000, 9), 10);
  RandomStream random(11, 0, 0);
  const Pose guess = test::random_pose(random, 0.03, 0.03);
  for (const IcpMethod method : icp_methods) {
    const IcpResult first = icp(source, target, guess, {.method = method});
    for (const SearchMethod search : {SearchMethod::octree, SearchMethod::brute_force,
                                      SearchMethod::flann, SearchMethod::pcl_octree}) {
      const IcpResult other = icp(source, target, guess, {.method = method, .search = search});
      EXPECT_EQ(other.target_from_source.matrix(), first.target_from_source.matrix())
          << name_of(search);
    }
  }
}

// Seen from another origin it is the same, about the same place.
TEST(Icp, InformationDoesNotDependOnTheOrigin) {
  PointCloud source = test::bumpy_surface(3000, 12), target = source;
  test::add_noise(source, 0.002, 13);
  const IcpResult result = icp(source, target, Pose::Identity());
  EXPECT_EQ(result.information, result.information.transpose());
  const Vector3d c(10, -20, 5);
  for (Vector3d& x : source.points) x += c;
  for (Vector3d& x : target.points) x += c;
  const IcpResult far = icp(source, target, Pose::Identity());
  EXPECT_LT((far.centre - c - result.centre).norm(), 1e-9);
  EXPECT_LT((far.information - result.information).norm(), 1e-6 * result.information.norm());
}

// A start far off makes full steps overshoot.
TEST(Icp, TheObjectiveNeverRises) {
  const auto [source, target] = test::split(test::bumpy_surface(3000, 18), 19);
  RandomStream random(20, 0, 0);
  for (const IcpMethod method : icp_methods) {
    std::size_t compared = 0;
    for (const double off : {0.05, 0.3, 0.6, 1.0, 1.2, 1.5}) {
      const IcpResult result = icp(source, target, test::random_pose(random, off, off),
                                   {.method = method, .max_normal_angle_rad = std::numbers::pi});
      for (std::size_t i = 1; i < result.history.size(); ++i) {
        const IcpState &before = result.history[i - 1], &now = result.history[i];
        EXPECT_LE(now.scale_m, before.scale_m);
        if (now.scale_m != before.scale_m) continue;
        EXPECT_LE(now.objective_m2, before.objective_m2) << name_of(method) << " " << off;
        ++compared;
      }
    }
    EXPECT_GE(compared, 5u) << name_of(method);
  }
}

// Noise of a third of the spacing: the nearest points change along the surface and among the noise,
// so that a motion shows in its residuals by a small share only, and steps are as much too short.
// Where they lead is reached all the same, soon: by steps alone plane-to-plane took ten iterations
// and more. From an answer there is no way to go on: each end is off the gradient's zero by 0.3
// standard errors, and the partners' jumps let it vanish in several places; within one standard
// error both.
TEST(Icp, RestsWhereNoiseHidesMostOfAMotion) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto [source, target] = test::split(test::bumpy_surface(40000, 30 + seed), 40 + seed);
    source.normals.clear();
    target.normals.clear();
    test::add_noise(source, 0.005, 50 + seed);
    test::add_noise(target, 0.005, 60 + seed);
    const PreparedCloud a = prepare(source), b = prepare(target);
    RandomStream random(70, seed, 0);
    const Pose guess = test::random_pose(random, 0.03, 0.03);
    for (const IcpMethod method :
         {IcpMethod::point_to_plane, IcpMethod::symmetric, IcpMethod::plane_to_plane}) {
      const IcpResult first = icp(a, b, guess, {.method = method});
      const IcpResult again = icp(a, b, first.target_from_source, {.method = method});
      EXPECT_EQ(first.stop, Stop::converged) << name_of(method);
      EXPECT_LE(first.iterations, 8) << name_of(method);
      const Vector6 off =
          log(Eigen::Translation3d(-first.centre) * again.target_from_source *
              first.target_from_source.inverse() * Eigen::Translation3d(first.centre));
      EXPECT_LT(off.dot(first.information * off), 1) << name_of(method);
    }
  }
}

// Every fourth column of a scanner's rows, as many points as a large source begins with, reads 2 cm
// too far. A sample that takes each fourth point takes those alone, and its pose, once it fits them
// to their noise, lets no others count; among all points they are the fewer ones. The offset of
// 0.02 m against 1e-3 m: noise of 1 mm over some thousand points leaves 0.05 mm.
TEST(Icp, BeginsWithASampleOutOfStepWithTheRows) {
  constexpr int side = 80;
  PointCloud source, target = test::bumpy_surface(20000, 80);
  const PointCloud readings = test::bumpy_surface(side * side, 81);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    RandomStream random(82, 0, i);
    source.points.push_back(readings.points[i] +
                            ((i % 4 == 0 ? 0.02 : 0) + 1e-3 * random.normal()) * Vector3d::UnitZ());
  }
  target.normals.clear();
  const IcpResult result = icp(source, target, Pose::Identity());
  EXPECT_LT(std::abs(result.target_from_source.translation().z()), 1e-3);
}

TEST(Icp, TellsEachIteration) {
  const auto [source, target] = test::split(test::bumpy_surface(2000, 14), 15);
  int calls = 0;
  Pose last;
  const IcpResult result = icp(source, target, make_pose(Eigen::Matrix3d::Identity(), {0.02, 0, 0}),
                               {.on_iteration = [&](int iteration, const Pose& pose) {
                                 EXPECT_EQ(iteration, ++calls);
                                 last = pose;
                               }});
  EXPECT_EQ(calls, result.iterations);
  EXPECT_EQ(result.history.size(), std::size_t(result.iterations));
  EXPECT_EQ(last.matrix(), result.target_from_source.matrix());
}

// The sample that a large source begins with is chosen by the points' places in the cloud, so a
// turned one has the same: its scale differs by rounding. Another sample of 1,250 points would have
// another median, by the share 1.25 / sqrt(1250) = 4 % of the spread.
TEST(Icp, BeginsWithTheSameSampleInEveryFrame) {
  const auto [source, target] = test::split(test::bumpy_surface(10000, 18), 19);
  RandomStream random(22, 0, 0);
  const Pose turn = test::random_pose(random, 1, 1), guess = test::random_pose(random, 0.03, 0.03);
  const IcpResult straight = icp(source, target, guess);
  const IcpResult turned = icp(transformed(turn, source), target, guess * turn.inverse());
  ASSERT_FALSE(straight.history.empty());
  EXPECT_NEAR(turned.history[0].scale_m / straight.history[0].scale_m, 1, 1e-6);
}

TEST(Icp, NormalsAreFittedWhereTheCloudsHaveNone) {
  auto [source, target] = test::split(test::bumpy_surface(8000, 16), 17);
  source.normals.clear();
  target.normals.clear();
  RandomStream random(21, 0, 0);
  const Pose guess = test::random_pose(random, 0.03, 0.03);
  for (const IcpMethod method : icp_methods) {
    // Point-to-point creeps: rounding decides whether the usual 60 are enough.
    const IcpResult result = icp(source, target, guess, {.method = method, .max_iterations = 200});
    EXPECT_EQ(result.stop, Stop::converged) << name_of(method) << result.iterations;
    // Fits over 16 points at a spacing of 0.016 m miss the surface by its curvature times the
    // square of their reach, 3 / m * (0.036 m)^2 / 8 = 0.5 mm; point-to-point is held by the
    // points.
    const double limit_m = method == IcpMethod::point_to_point ? 8e-3 : 0.5e-3;
    EXPECT_LT(translation_distance_m(result.target_from_source, Pose::Identity()), limit_m);
  }
}

// A plate of 2 m with one groove, a twentieth of it, that alone fixes the slide across: a sample
// that takes the groove's points first (after Gelfand et al. 2003) is better than one of as many at
// random, and all points are no worse than either. Errors of equal noise, no weighing of them has a
// smaller variance than that by their information, which all points together are (Gauss, Markov).
TEST(Icp, AllPointsAreNoWorseThanAStableSample) {
  const auto plate = [](std::uint64_t seed) {
    PointCloud cloud;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      RandomStream random(seed, 5, i);
      const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1;
      const double groove = -0.05 * std::exp(-400 * x * x);
      cloud.points.emplace_back(x, y, groove + 0.001 * random.normal());
      cloud.normals.push_back(Vector3d(800 * x * groove, 0, 1).normalized());
    }
    return cloud;
  };
  const auto part = [](const PreparedCloud& whole, const auto& takes) {
    PreparedCloud some{.origin = whole.origin,
                       .oriented = whole.oriented,
                       .spacing_m = whole.spacing_m,
                       .radius_m = whole.radius_m};
    for (std::size_t i = 0; i < whole.size(); ++i) {
      if (!takes(i)) continue;
      some.points.push_back(whole.points[i]);
      some.index.push_back(static_cast<std::uint32_t>(some.index.size()));
      some.normals.push_back(whole.normals[i]);
      some.fits.push_back(whole.fits[i]);
    }
    return some;
  };
  double stable_m2 = 0, random_m2 = 0, all_m2 = 0;
  constexpr int draws = 30;
  for (std::uint64_t seed = 1; seed <= draws; ++seed) {
    const PreparedCloud source = prepare(plate(2 * seed)), target = prepare(plate(2 * seed + 1));
    const auto slide2_m2 = [&](const PreparedCloud& some) {
      const Pose guess(Eigen::Translation3d(0.01, 0, 0.002));
      return std::pow(icp(some, target, guess).target_from_source.translation().x(), 2) / draws;
    };
    const auto in_groove = [&](std::size_t i) { return std::abs(source.normals[i].x()) > 0.1; };
    std::size_t steep = 0;
    for (std::size_t i = 0; i < source.size(); ++i) steep += in_groove(i);
    const double rest = (800.0 - double(steep)) / double(source.size() - steep);
    const auto draw = [&](std::size_t i) { return RandomStream(seed, 6, i).uniform(); };
    stable_m2 += slide2_m2(part(source, [&](auto i) { return in_groove(i) || draw(i) < rest; }));
    random_m2 += slide2_m2(part(source, [&](auto i) { return draw(i) < 0.2; }));
    all_m2 += slide2_m2(source);
  }
  // The random sample has a fifth of the groove's points: 2.2 times the error. Rms of 30 draws err
  // by 1 / sqrt(60) each, their ratio by 0.18.
  EXPECT_LT(std::sqrt(stable_m2), 0.7 * std::sqrt(random_m2));
  EXPECT_LT(std::sqrt(all_m2), 1.36 * std::sqrt(stable_m2));
}

// Prepared once, used twice, in either role.
TEST(Icp, PreparedCloudsGiveTheSame) {
  const auto [source, target] = test::split(test::bumpy_surface(4000, 22), 23);
  const PreparedCloud a = prepare(source), b = prepare(target);
  const Pose guess = Pose(Eigen::Translation3d(0.01, 0.02, 0));
  const Pose once = icp(a, b, guess).target_from_source;
  icp(b, a, guess);
  EXPECT_EQ(icp(a, b, guess).target_from_source.matrix(), once.matrix());
  EXPECT_EQ(icp(source, target, guess).target_from_source.matrix(), once.matrix());
}

}  // namespace
}  // namespace scan
