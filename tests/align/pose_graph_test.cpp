// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/pose_graph.h"

#include <gtest/gtest.h>

#include "libscan/core/error.h"
#include "tests/align/pose_graphs.h"

namespace scan {
namespace {

std::vector<Pose> far_starts(const std::vector<Pose>& truth) {
  std::vector<Pose> starts(truth.size(), Pose::Identity());
  starts[0] = truth[0];
  return starts;
}

TEST(PoseGraph, ConsistentEdgesGiveTheTruth) {
  const std::vector<Pose> truth = ring(12);
  std::vector<PoseEdge> edges;
  for (std::size_t i = 0; i < 12; ++i)
    for (std::size_t step : {1, 2, 5})
      edges.push_back(
          {i, (i + step) % 12, truth[(i + step) % 12].inverse() * truth[i], usual_information()});
  const PoseGraph graph = solve_pose_graph(far_starts(truth), edges, 0);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_TRUE(graph.world_from_scan[i].isApprox(truth[i], 1e-9)) << i;
  EXPECT_TRUE(graph.world_from_scan[0].isApprox(truth[0], 0));
}

// One of 24 equal edges misses by 2.4 mm along z: each takes a 24th of that. Turns are held by 1e12
// rad^-2; the 5.8 that chi-square could save at most pays for turns of 2.4e-6, over 0.26 m an edge
// and 24 edges 1.5e-5 m; what is gained by the first of them is lost by the next.
TEST(PoseGraph, SpreadsTheErrorOfALoopEvenly) {
  std::vector<Pose> truth;
  for (int i = 0; i < 24; ++i)
    truth.push_back(
        make_pose(Eigen::Matrix3d::Identity(), {std::cos(i * 0.2618), std::sin(i * 0.2618), 0}));
  Matrix6 information = usual_information();
  information.topLeftCorner<3, 3>().diagonal().setConstant(1e12);
  std::vector<PoseEdge> edges;
  for (std::size_t i = 0; i < 24; ++i)
    edges.push_back({i, (i + 1) % 24, truth[(i + 1) % 24].inverse() * truth[i], information});
  edges[0].target_from_source.translation().z() += 2.4e-3;
  const PoseGraph graph = solve_pose_graph(far_starts(truth), edges, 0);
  for (std::size_t i = 1; i < 24; ++i)
    EXPECT_NEAR(graph.world_from_scan[i].translation().z(),
                -2.3e-3 + 1e-4 * static_cast<double>(i - 1), 1.5e-5);
}

// Rejected are the wrong edges, and no others but the thousandth that chance exceeds its limit.
TEST(PoseGraph, FindsTheWrongEdges) {
  RandomStream random(7, 0, 0);
  const std::vector<Pose> truth = ring(24);
  std::vector<PoseEdge> edges;
  std::vector<bool> right;
  for (std::size_t i = 0; i < 24; ++i)
    for (std::size_t step = 1; step <= 3; ++step) {
      right.push_back(random.uniform() >= 0.3);
      edges.push_back(right.back()
                          ? measured_edge(truth, i, (i + step) % 24, usual_information(), random)
                          : wrong_edge(truth, i, (i + step) % 24, usual_information(), random));
    }
  const PoseGraph graph = solve_pose_graph(far_starts(truth), edges, 0);
  EXPECT_EQ(graph.accepted, right);
  for (std::size_t i = 0; i < 24; ++i) {
    ASSERT_TRUE(graph.covariance[i]);
    Vector6 error;
    error << log(make_pose(graph.world_from_scan[i].linear() * truth[i].linear().transpose(),
                           Eigen::Vector3d::Zero()))
                 .head<3>(),
        graph.world_from_scan[i].translation() - truth[i].translation();
    if (i == 0) continue;
    // 99.99 % quantile of chi-square with 6 degrees of freedom, for 23 scans that hang together.
    EXPECT_LT(error.dot(graph.covariance[i]->ldlt().solve(error)), 27.9) << i;
  }
}

// Mean of the normalised squared error over draws of the edges: chi-square with 6 degrees of
// freedom, mean 6, variance 12; of 300 draws the mean's sigma is 0.2, and 4 sigma are allowed.
TEST(PoseGraph, CovarianceIsThatOfTheDraws) {
  const std::vector<Pose> truth = ring(6);
  Matrix6 information = usual_information();
  information(0, 4) = information(4, 0) = 2e5;  // correlated
  constexpr int draws = 300;
  double sum = 0;
  for (int draw = 0; draw < draws; ++draw) {
    RandomStream random(8, 0, static_cast<std::uint64_t>(draw));
    std::vector<PoseEdge> edges;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t step : {1, 2})
        edges.push_back(measured_edge(truth, i, (i + step) % 6, information, random));
    const PoseGraph graph = solve_pose_graph(far_starts(truth), edges, 0);
    Vector6 error;
    error << log(make_pose(graph.world_from_scan[3].linear() * truth[3].linear().transpose(),
                           Eigen::Vector3d::Zero()))
                 .head<3>(),
        graph.world_from_scan[3].translation() - truth[3].translation();
    sum += error.dot(graph.covariance[3]->ldlt().solve(error));
  }
  EXPECT_NEAR(sum / draws, 6, 4 * std::sqrt(12.0 / draws));
}

TEST(PoseGraph, ScansWithoutEdgesKeepTheirStart) {
  RandomStream random(9, 0, 0);
  const std::vector<Pose> truth = ring(5);
  const std::vector<PoseEdge> edges{measured_edge(truth, 1, 0, usual_information(), random),
                                    measured_edge(truth, 2, 1, usual_information(), random),
                                    measured_edge(truth, 4, 3, usual_information(), random)};
  const PoseGraph graph = solve_pose_graph(truth, edges, 0);
  EXPECT_EQ(graph.tied, (std::vector<bool>{true, true, true, false, false}));
  EXPECT_TRUE(graph.world_from_scan[4].isApprox(truth[4], 0));
  EXPECT_FALSE(graph.covariance[4]);
  EXPECT_TRUE(graph.covariance[2]);
}

// An edge that leaves a slide open gives no covariance; a second one that fixes it does.
TEST(PoseGraph, AnOpenMotionHasNoCovariance) {
  RandomStream random(10, 0, 0);
  const std::vector<Pose> truth = ring(2);
  PoseEdge slides = measured_edge(truth, 1, 0, usual_information(), random);
  slides.information.row(3).setZero();
  slides.information.col(3).setZero();
  EXPECT_FALSE(solve_pose_graph(truth, std::vector{slides}, 0).covariance[1]);
  PoseEdge holds = slides;
  holds.information = usual_information();
  holds.information.row(4).setZero();
  holds.information.col(4).setZero();
  const PoseGraph graph = solve_pose_graph(truth, std::vector{slides, holds}, 0);
  ASSERT_TRUE(graph.covariance[1]);
  EXPECT_EQ(chi_square_limit(slides.information), 20.515);
}

TEST(PoseGraph, RefusesEdgesThatCannotBe) {
  const std::vector<Pose> starts(3, Pose::Identity());
  EXPECT_THROW(solve_pose_graph(starts, std::vector{PoseEdge{.source = 3, .target = 0}}, 0), Error);
  EXPECT_THROW(solve_pose_graph(starts, std::vector{PoseEdge{.source = 1, .target = 1}}, 0), Error);
  PoseEdge broken{.source = 1, .target = 0};
  broken.information(0, 0) = std::nan("");
  EXPECT_THROW(solve_pose_graph(starts, std::vector{broken}, 0), Error);
  EXPECT_THROW(solve_pose_graph(starts, {}, 3), Error);
}

}  // namespace
}  // namespace scan
