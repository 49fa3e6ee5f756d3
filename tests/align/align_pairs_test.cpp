// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Pairs of scans aligned one by one (scan_edges.h).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libscan/align/scan_edges.h"
#include "tests/align/simulated_views.h"

namespace scan::test {
namespace {

const Eigen::Vector3d middle(3, 0, 0);
constexpr double width_m = 0.6;

// A patch of side x side points of a height over the plane, three metres off its frame's origin.
template <class Height>
PointCloud patch(Height&& height_m, int side, std::uint64_t seed) {
  const double spacing_m = width_m / side;
  const auto place = [&](double x, double y) {
    return Eigen::Vector3d(middle + Eigen::Vector3d(x, y, height_m(x, y)));
  };
  PointCloud cloud;
  RandomStream random(seed, 0, 0);
  for (int i = 0; i < side * side; ++i) {
    const double x = (i % side + random.uniform() - side / 2.0) * spacing_m;
    const double y = (i / side + random.uniform() - side / 2.0) * spacing_m;
    const double h = 1e-6;
    cloud.points.push_back(place(x, y));
    cloud.normals.push_back(
        (place(x + h, y) - place(x - h, y)).cross(place(x, y + h) - place(x, y - h)).normalized());
  }
  return cloud;
}

// All from different guesses of one pair.
std::vector<ScanEdge> aligned_from(const std::vector<Pose>& guesses, const PointCloud& target,
                                   const PointCloud& source) {
  MultiviewOptions options;
  options.thin_m = width_m / 1000;  // none
  const std::vector<PointCloud> clouds = {source, target};
  std::vector<EdgeTask> tasks;
  for (const Pose& guess : guesses) tasks.push_back({0, 1, guess});
  return align_pairs(prepare_scans(clouds, options), tasks, options, {});
}

ScanEdge aligned_alone(const PointCloud& target, const PointCloud& source, const Pose& guess) {
  return aligned_from({guess}, target, source)[0];
}

// How far it carries the middle of the patch, and turns it, both in metres at its rim.
double off_m(const Pose& pose) {
  return (pose * middle - middle).norm() + 0.3 * rotation_distance_rad(pose, Pose::Identity());
}

// Waves that nearly fit themselves a period farther, from guesses nearer to that: what is tried
// from around them, shifts both ways of one to four of the wider spacings (13 mm; four of the other
// are 27 mm, where half a period and 30 mm are to go), finds the right place. Of several pairs each
// is left to the others.
TEST(AlignPairs, TriesAPairThatStandsAloneFromShiftsAround) {
  const auto waves = [](double x, double) {
    const double turn = 2 * std::numbers::pi * x;
    return 0.02 * std::sin(turn / 0.16) + 0.01 * std::sin(turn / 0.6);
  };
  const PointCloud coarse = patch(waves, 30, 1), fine = patch(waves, 60, 2);
  for (const double off : {-0.11, 0.11}) {
    const Pose guess(Eigen::Translation3d(off, 0, 0));
    for (const bool coarse_first : {true, false}) {
      const ScanEdge edge =
          aligned_alone(coarse_first ? coarse : fine, coarse_first ? fine : coarse, guess);
      EXPECT_LT(off_m(edge.target_from_source), 2e-3) << off;
      EXPECT_EQ(edge.target_from_source_guess.translation().x(), off);
    }
    EXPECT_GT(off_m(aligned_from({guess, guess}, coarse, fine)[0].target_from_source), 0.1);
  }
}

// Eight lobes that nearly fit themselves an eighth of a turn farther, from guesses nearer to that
// (0.785 rad): at the wrong rest, too, most points have partners, but these do not agree.
TEST(AlignPairs, TriesAPairThatStandsAloneFromTurnsAround) {
  const auto lobes = [](double x, double y) {
    const double square = (x * x + y * y) / 0.09, angle = std::atan2(y, x);
    return 0.02 * square * (std::sin(8 * angle) + std::cos(2 * angle));
  };
  const Eigen::Translation3d there(middle), back(-middle);
  for (const double off_rad : {-0.5, 0.5}) {
    const Pose guess(there * Eigen::AngleAxisd(off_rad, Eigen::Vector3d::UnitZ()) * back);
    const ScanEdge edge = aligned_alone(patch(lobes, 30, 1), patch(lobes, 30, 2), guess);
    EXPECT_LT(off_m(edge.target_from_source), 2e-3) << off_rad;
    // About the middle of the points, 1 mm off the patch's.
    EXPECT_GT(rotation_distance_rad(edge.path.front(), guess), 0.1);
    EXPECT_LT((edge.path.front() * middle - guess * middle).norm(), 2e-3);
  }
}

// A third of the target lies 15 cm above what the source saw there, eleven spacings: nobody expects
// these points to agree, and of the others all but some beside the step do.
TEST(AlignPairs, ExpectNothingOfPointsFarApart) {
  const auto low = [](double x, double y) { return 0.05 * std::sin(20 * x) * std::cos(15 * y); };
  const auto stepped = [&](double x, double y) { return low(x, y) + (x > 0.1 ? 0.15 : 0); };
  const ScanEdge edge = aligned_alone(patch(stepped, 30, 1), patch(low, 30, 2), Pose::Identity());
  EXPECT_LT(off_m(edge.target_from_source), 2e-3);
  EXPECT_GT(edge.agreement, 0.9);
}

// Of several pairs each is aligned from its guess alone; its path says by which poses.
TEST(AlignPairs, TellHowTheyCameToRest) {
  const SimulatedViews views = simulated_views(ScannerNoise::lidar, 32, 1);
  MultiviewOptions options;
  const PreparedScans scans = prepare_scans(views.clouds, options);
  std::vector<EdgeTask> tasks;
  for (const auto& [source, target] : {std::pair<std::size_t, std::size_t>(0, 1), {0, 2}})
    tasks.push_back({source, target, views.guesses[target].inverse() * views.guesses[source]});
  std::vector<ScanEdge> told;
  options.on_edge = [&](const ScanEdge& edge) { told.push_back(edge); };
  const std::vector<ScanEdge> edges = align_pairs(scans, tasks, options, {});
  EXPECT_EQ(told.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(edges[k].target, tasks[k].target);
    const Pose truth = views.truth[tasks[k].target].inverse() * views.truth[0];
    EXPECT_LT((edges[k].target_from_source * truth.inverse()).translation().norm(), 0.01);
    ASSERT_GT(edges[k].path.size(), 2u);
    EXPECT_EQ(edges[k].path.front().matrix(), tasks[k].target_from_source_guess.matrix());
    EXPECT_EQ(edges[k].path.back().matrix(), edges[k].target_from_source.matrix());
  }
}

// Of the edges of an earlier call only that of this source, target and guess is taken, as it is.
TEST(AlignPairs, TakeWhatIsKnown) {
  const SimulatedViews views = simulated_views(ScannerNoise::lidar, 32, 1);
  MultiviewOptions options;
  const PreparedScans scans = prepare_scans(views.clouds, options);
  const Pose guess = views.guesses[1].inverse() * views.guesses[0];
  const std::vector<EdgeTask> tasks = {{0, 1, guess},
                                       {0, 2, guess},
                                       {3, 1, guess},
                                       {0, 1, Eigen::Translation3d(0, 0, 1e-9) * guess}};
  const ScanEdge known{.source = 0, .target = 1, .target_from_source_guess = guess, .overlap = 7};
  options.known_edges = {known};
  int told = 0, iterations = 0;
  options.on_edge = [&](const ScanEdge&) { ++told; };
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const auto edges = align_pairs(scans, std::span(tasks).subspan(k, 1), options, {});
    EXPECT_EQ(edges[0].overlap == 7, k == 0) << k;
    EXPECT_EQ(told, int(k));
  }
  options.icp.on_iteration = [&](int, const Pose&) { ++iterations; };
  const auto edges = align_pairs(scans, std::span(tasks).last(1), options, {});
  EXPECT_EQ(iterations, int(edges[0].path.size()) - 1);  // one that ends well is not tried again
}

}  // namespace
}  // namespace scan::test
