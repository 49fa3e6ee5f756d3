// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/align/spanning_tree.h"

#include <gtest/gtest.h>

#include "tests/align/pose_graphs.h"

namespace scan {
namespace {

// A complete graph of four scans has four loops of three; every edge is in two of them.
TEST(ClosedLoops, CountsEachLoopOnce) {
  RandomStream random(1, 0, 0);
  const std::vector<Pose> truth = ring(4);
  std::vector<PoseEdge> edges;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      edges.push_back(measured_edge(truth, a, b, usual_information(), random));
  EXPECT_EQ(closed_loops(edges, 4), std::vector<int>(6, 2));
  std::swap(edges[2].source, edges[2].target);  // an edge may be walked both ways
  edges[2].target_from_source = edges[2].target_from_source.inverse();
  EXPECT_EQ(closed_loops(edges, 4), std::vector<int>(6, 2));
}

TEST(ClosedLoops, AWrongEdgeOpensItsLoops) {
  RandomStream random(2, 0, 0);
  const std::vector<Pose> truth = ring(4);
  std::vector<PoseEdge> edges;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      edges.push_back(measured_edge(truth, a, b, usual_information(), random));
  edges[0] = wrong_edge(truth, 0, 1, usual_information(), random);
  // Loops 0-2-3 and 1-2-3 are left.
  EXPECT_EQ(closed_loops(edges, 4), (std::vector<int>{0, 1, 1, 1, 1, 2}));
}

// The share of right loops that are refused is one in a thousand: of 4000, 4 are expected and more
// than 12 have a probability of 3e-4 (Poisson).
TEST(ClosedLoops, RefusesOneRightLoopInAThousand) {
  RandomStream random(3, 0, 0);
  const std::vector<Pose> truth = ring(3);
  int refused = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::vector<PoseEdge> edges;
    for (std::size_t i = 0; i < 3; ++i)
      edges.push_back(measured_edge(truth, i, (i + 1) % 3, usual_information(), random));
    refused += closed_loops(edges, 3)[0] == 0 ? 1 : 0;
  }
  EXPECT_LE(refused, 12);
  EXPECT_GE(refused, 1);  // none has a probability of 2 %, but the seed is fixed
}

TEST(SpanningTree, GoesRoundAWrongEdge) {
  RandomStream random(4, 0, 0);
  const std::vector<Pose> truth = ring(5);
  std::vector<PoseEdge> edges{wrong_edge(truth, 1, 0, usual_information(), random)};
  for (const auto& [a, b] : {std::pair{1, 2}, {0, 2}, {2, 3}, {1, 3}, {0, 3}, {3, 4}})
    edges.push_back(measured_edge(truth, a, b, usual_information(), random));
  std::vector<Pose> starts(5, Pose::Identity());
  starts[0] = truth[0];
  const SpanningTree tree = spanning_tree(starts, edges, 0);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(tree.reached[i]);
    // Three edges of 0.1 degrees and 1 mm each over arms of up to 4 m: 10 mm is 4 sigma or more.
    EXPECT_LT(translation_distance_m(tree.world_from_scan[i], truth[i]), 0.05);
  }
}

// Each join moves all that is joined already: its rounding must not double each time. Of 100 joins
// it adds up to 1e-14.
TEST(SpanningTree, ALongChainStaysMadeOfRotations) {
  RandomStream random(6, 0, 0);
  const std::vector<Pose> truth = ring(100);
  std::vector<PoseEdge> edges;
  for (std::size_t i = 0; i + 1 < truth.size(); ++i)
    edges.push_back(measured_edge(truth, i, i + 1, usual_information(), random));
  const SpanningTree tree = spanning_tree(truth, edges, 0);
  for (const Pose& pose : tree.world_from_scan)
    EXPECT_LT((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-13);
}

TEST(SpanningTree, LeavesWhatNoEdgeReaches) {
  RandomStream random(5, 0, 0);
  const std::vector<Pose> truth = ring(4);
  const std::vector<PoseEdge> edges{measured_edge(truth, 1, 0, usual_information(), random),
                                    measured_edge(truth, 2, 3, usual_information(), random)};
  const SpanningTree tree = spanning_tree(truth, edges, 0);
  EXPECT_EQ(tree.reached, (std::vector<bool>{true, true, false, false}));
  EXPECT_EQ(tree.depth, 1u);
  EXPECT_TRUE(tree.world_from_scan[3].isApprox(truth[3], 0));
}

}  // namespace
}  // namespace scan
