// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pairs.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/align/test_shapes.h"

namespace scan {
namespace {

using Eigen::Vector3d;

struct Problem {
  Problem(const PointCloud& from, const PointCloud& to, IcpOptions with = {})
      : source(prepare(from)), target(prepare(to)), options(with), finder(source, target, options) {
    sample.resize(source.size());
    std::iota(sample.begin(), sample.end(), 0u);
  }
  std::vector<Match> find(const Pose& target_from_source) const {
    std::vector<Match> matches;
    finder.find(local_pose(target_from_source, source, target), sample, matches);
    return matches;
  }
  PreparedCloud source, target;
  IcpOptions options;
  PairFinder finder;
  std::vector<std::uint32_t> sample;
};

Pose shift(double x, double y, double z) {
  return Pose(Eigen::Translation3d(x, y, z));
}

// Two sheets, the source twice as wide: what lies beyond the rim has no partner, however near the
// sheets are; within it all have. The reach of 16 neighbours is 0.16 m at 200 points per m^2.
// A corner's fit reaches over a quarter of a disc of 16 points, 4.5 spacings: with half of that,
// 0.16 m, for the gate nothing farther out has a partner. Inside, no place is farther from its
// nearest point than half a diagonal, 0.7 spacings, while the fits reach over 2.2.
TEST(PairFinder, PointsBeyondTheRimHaveNoPartner) {
  PointCloud target;
  for (int i = 0; i <= 140; ++i)
    for (int j = 0; j <= 140; ++j) {
      target.points.emplace_back(i / 14.0 - 5, j / 14.0 - 5, 0);
      target.normals.push_back(Vector3d::UnitZ());
    }
  PointCloud source = test::plane(20000, 3);
  for (Vector3d& x : source.points) x.head<2>() *= 2;
  const Problem problem(source, target);
  const std::vector<Match> matches = problem.find(shift(0, 0, 0.02));
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Vector3d at = problem.source.points[i] + problem.source.origin;
    const double out = at.head<2>().cwiseAbs().maxCoeff();
    if (out > 5.17) {
      EXPECT_EQ(matches[i].residual_m, unlimited_m) << at.transpose();
    } else if (out < 5) {
      EXPECT_NEAR(matches[i].residual_m, 0.02, 1e-12) << at.transpose();
    }
  }
}

TEST(PairFinder, GuessesChangeNothing) {
  const auto [source, target] = test::split(test::bumpy_surface(4000, 4), 5);
  const Problem problem(source, target);
  std::vector<Match> warm = problem.find(shift(0.1, 0, 0));
  const Pose pose = local_pose(shift(0.01, 0.02, 0), problem.source, problem.target);
  problem.finder.find(pose, problem.sample, warm);
  const std::vector<Match> cold = problem.find(shift(0.01, 0.02, 0));
  for (std::size_t i = 0; i < cold.size(); ++i) {
    EXPECT_EQ(warm[i].target, cold[i].target);
    EXPECT_EQ(warm[i].residual_m, cold[i].residual_m);
  }
}

// Partners kept without a search are still the nearest: through motions of all sizes, to and fro,
// at coordinates far from zero and small.
TEST(PairFinder, AWayInManyStepsChangesNothing) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    auto [source, target] = test::split(test::bumpy_surface(3000, 4), 5);
    for (PointCloud* cloud : {&source, &target})
      for (Vector3d& x : cloud->points) x *= scale;
    const Problem problem(source, target);
    std::vector<Match> warm;
    double step_m = 0.1 * scale;
    for (int k = 0; k < 40; ++k, step_m *= -0.8) {
      const Pose pose =
          local_pose(shift(step_m, 0.3 * step_m, 0.1 * step_m), problem.source, problem.target);
      problem.finder.find(pose, problem.sample, warm);
      std::vector<Match> cold;
      problem.finder.find(pose, problem.sample, cold);
      for (std::size_t i = 0; i < cold.size(); ++i) {
        ASSERT_EQ(warm[i].target, cold[i].target) << k << " " << i;
        ASSERT_EQ(warm[i].residual_m, cold[i].residual_m) << k << " " << i;
      }
    }
  }
}

// The sheet's points beyond the rim pair within the opening, wherever they lie; the other way round
// none does, and closed again all is as before.
TEST(PairFinder, OpenGatesTakeWhatLiesWithin) {
  PointCloud source = test::plane(5000, 3);
  const PointCloud target = test::plane(5000, 4);
  Problem problem(source, target);
  const std::vector<Match> before = problem.find(shift(3, 0, 0));
  problem.finder.open_gates(2);
  const std::vector<Match> open = problem.find(shift(3, 0, 0));
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Vector3d at = problem.source.points[i] + problem.source.origin + Vector3d(3, 0, 0);
    const double off_m =
        (at - problem.target.points[open[i].target] - problem.target.origin).norm();
    EXPECT_EQ(open[i].residual_m < unlimited_m, off_m <= 2) << at.transpose();
  }
  problem.finder.open_gates(0);
  const std::vector<Match> closed = problem.find(shift(3, 0, 0));
  for (std::size_t i = 0; i < closed.size(); ++i)
    EXPECT_EQ(closed[i].residual_m, before[i].residual_m);
  for (Vector3d& normal : source.normals) normal = -normal;
  Problem turned(source, target);
  turned.finder.open_gates(2);
  for (const Match& match : turned.find(shift(3, 0, 0))) EXPECT_EQ(match.residual_m, unlimited_m);
}

TEST(PairFinder, NormalsThatDisagreeDoNotPair) {
  const PointCloud cloud = test::plane(500, 6);
  PointCloud flipped = cloud;
  for (Vector3d& n : flipped.normals) n = -n;
  for (const Match& match : Problem(flipped, cloud).find(Pose::Identity()))
    EXPECT_EQ(match.residual_m, unlimited_m);
  // Without signs to go by they do.
  Problem unsigned_normals(flipped, cloud);
  unsigned_normals.source.oriented = false;
  for (const Match& match : unsigned_normals.find(Pose::Identity()))
    EXPECT_LT(match.residual_m, 1e-14);
}

TEST(PairFinder, DistanceIsLimitedWhereTheOptionsSay) {
  const PointCloud cloud = test::plane(500, 6);
  const Problem problem(cloud, cloud, {.max_pair_distance_m = 0.1});
  for (const Match& match : problem.find(shift(0, 0, 0.11)))
    EXPECT_EQ(match.residual_m, unlimited_m);
  for (const Match& match : problem.find(shift(0, 0, 0.09)))
    EXPECT_NEAR(match.residual_m, 0.09, 1e-12);
}

TEST(PairFinder, ObjectiveIsTheMeanLossAndNoPairCostsMost) {
  const PointCloud cloud = test::plane(500, 6);
  const Problem problem(cloud, cloud);
  const Weighing weighing{.loss = {.scale_m = 0.5}, .limit_m = 2};
  std::vector<Match> matches(4);
  matches[0].residual_m = 0;
  matches[1].residual_m = 0.5;
  matches[2].residual_m = 3;  // counts as 2
  const double expected_m2 = (0.25 * (1 - std::exp(-0.5)) + 2 * 0.25 * (1 - std::exp(-8.0))) / 4;
  EXPECT_NEAR(problem.finder.objective_m2(matches, weighing), expected_m2, 1e-15);
  EXPECT_EQ(problem.finder.kept(std::vector<std::uint32_t>{0, 1, 2, 3}, matches, weighing).size(),
            2u);
}

// What the nearest of a plane's points, scattered at random with normal noise across, shows of a
// query's height h: those nearer than d lie in a volume whose mean number of points N(d) is an
// integral over their heights z, and the nearest lies at d with a chance of exp(-N) dN.
double mean_pull_m(double height_m, double from_m, const WelschLoss& loss, double per_m2,
                   double sigma_m) {
  constexpr int steps = 400;
  const double most_m = 6 * sigma_m + 4 / std::sqrt(per_m2), dd = most_m / steps;
  double number = 0, mean_m = 0;
  for (int i = 0; i < steps; ++i) {
    const double d = (i + 0.5) * dd;
    double ring = 0, pull_m = 0;  // of the growth of N, and its sum of pulls
    const double dz = 2 * d / steps;
    for (int k = 0; k < steps; ++k) {
      const double z = height_m - d + (k + 0.5) * dz;
      const double density = std::exp(-0.5 * z * z / (sigma_m * sigma_m)) /
                             (sigma_m * std::sqrt(2 * std::numbers::pi));
      const double part = per_m2 * 2 * std::numbers::pi * d * density * dz * dd;
      const double residual_m = from_m - z;
      ring += part;
      pull_m += part * loss.weight(residual_m) * residual_m;
    }
    mean_m += std::exp(-number - 0.5 * ring) * pull_m;
    number += ring;
  }
  return mean_m;
}

// The probe against that integral: 512 pairs of 1,024 whose share varies by about one half, three
// sigma.
TEST(PairFinder, AMotionShowsLessWhereNoiseChoosesThePartners) {
  constexpr double per_m2 = 2500, sigma_m = 0.01;
  PointCloud target, source;
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    RandomStream random(11, 0, i);
    const double x = 2 * random.uniform() - 1, y = 2 * random.uniform() - 1;
    target.points.emplace_back(x, y, sigma_m * random.normal());
    target.normals.push_back(Vector3d::UnitZ());
  }
  for (std::uint64_t i = 0; i < 1024; ++i) {
    RandomStream random(11, 1, i);
    const double x = 1.6 * random.uniform() - 0.8, y = 1.6 * random.uniform() - 0.8;
    source.points.emplace_back(x, y, 0);
    source.normals.push_back(Vector3d::UnitZ());
  }
  const Problem problem(source, target, {.method = IcpMethod::point_to_plane});
  const Weighing weighing{.loss = {.scale_m = 2 * sigma_m}};
  const auto couples =
      problem.finder.kept(problem.sample, problem.find(Pose::Identity()), weighing);
  ASSERT_GE(couples.size(), 1000u);
  const double step_m = 0.3 * weighing.loss.scale_m;
  const auto mean_m = [&](double height_m, double from_m) {
    return mean_pull_m(height_m, from_m, weighing.loss, per_m2, sigma_m);
  };
  const double expected = (mean_m(step_m, step_m) - mean_m(-step_m, -step_m)) /
                          (mean_m(0, step_m) - mean_m(0, -step_m));
  ASSERT_LT(expected, 0.8);
  const double share = problem.finder.shown_share(
      local_pose(Pose::Identity(), problem.source, problem.target), couples, weighing.loss);
  EXPECT_NEAR(share, expected, 3 * 0.5 / std::sqrt(512.0));
  // Of squares the probe goes 0.3 radii of 0.82 m; chance can pick no farther partner than the
  // largest of 10,000 errors, 4.5 sigma of 1 cm: a fifth of that.
  const double of_squares =
      problem.finder.shown_share(local_pose(Pose::Identity(), problem.source, problem.target),
                                 couples, {.scale_m = unlimited_m});
  EXPECT_GT(of_squares, 0.8);
  EXPECT_LT(of_squares, 1);
}

// Parallel planes of equal noise: the distance across, and next to nothing along.
TEST(PairFinder, MetricOfPlaneToPlaneMeasuresAcrossThePlanes) {
  const PointCloud cloud = test::plane(2000, 7);
  const Problem problem(cloud, cloud, {.method = IcpMethod::plane_to_plane});
  const Eigen::Matrix3d metric = problem.finder.metric(Pose::Identity(), {5, 5});
  EXPECT_NEAR(metric(2, 2), 1, 1e-9);
  EXPECT_NEAR(metric(0, 0), 1e-3, 1e-5);  // the square of the usual thickness
  EXPECT_NEAR(metric(0, 1), 0, 1e-12);
}

// Whatever the angle between the planes: the inverse of the sum of Segal et al., section III.B,
// each s^2 (1 - n n^T) + e^2 n n^T with e = 0.0316 s, times 2 e^2. Conditioned by 1 / 0.0316^2 =
// 1,000.
TEST(PairFinder, MetricOfPlaneToPlaneIsTheInverseOfBothCovariances) {
  const PointCloud cloud = test::bumpy_surface(2000, 8);
  const Problem problem(cloud, cloud, {.method = IcpMethod::plane_to_plane});
  RandomStream random(8, 0, 0);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Pose pose = test::random_pose(random, 3, 1);
    const Couple couple{i, 1000 + i};
    const auto covariance_in_spreads2 = [](const Eigen::Vector3d& n) -> Eigen::Matrix3d {
      return Eigen::Matrix3d::Identity() + (0.0316 * 0.0316 - 1) * n * n.transpose();
    };
    const Eigen::Matrix3d sum =
        covariance_in_spreads2(problem.target.normals[couple.target]) +
        covariance_in_spreads2(pose.linear() * problem.source.normals[couple.source]);
    const Eigen::Matrix3d metric = problem.finder.metric(pose, couple);
    EXPECT_TRUE((metric * sum / (2 * 0.0316 * 0.0316)).isApprox(Eigen::Matrix3d::Identity(), 1e-9));
  }
}

// Sigma of 3 cm across the source and 4 cm across the target: 5 cm together, and the scale of the
// usual noise is the larger of the two, twice: r^2 = 2 * 16 / 25 d^2.
TEST(PairFinder, MetricOfPlaneToPlaneFollowsTheScansNoise) {
  PointCloud source = test::plane(2000, 8), target = source;
  source.covariances.assign(2000, Vector3d(0, 0, 9e-4).asDiagonal());
  target.covariances.assign(2000, Vector3d(0, 0, 16e-4).asDiagonal());
  const Problem problem(source, target, {.method = IcpMethod::plane_to_plane});
  EXPECT_NEAR(problem.finder.metric(Pose::Identity(), {5, 5})(2, 2), 32.0 / 25, 1e-2);
}

}  // namespace
}  // namespace scan
