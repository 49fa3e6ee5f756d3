// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/pose_trace.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace scan {
namespace {

Pose turned(double angle_rad, double x_m) {
  return make_pose(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix(),
                   {x_m, 2 * x_m, -x_m});
}

// Three scans that hang on one another in a row, the middle edge the wrong way round: 0 - 1 - 2.
struct Row {
  std::vector<Pose> guesses = {turned(0.1, 1), turned(0.2, 2), turned(0.3, 3)};
  std::vector<Pose> truth = {turned(0.1, 1), turned(0.25, 2.2), turned(0.33, 2.9)};
  std::vector<ScanEdge> edges;

  Row() {
    ScanEdge first{.source = 1, .target = 0, .accepted = true};
    first.path = {guesses[0].inverse() * guesses[1], truth[0].inverse() * truth[1]};
    ScanEdge second{.source = 1, .target = 2, .accepted = true};
    const Pose start = guesses[2].inverse() * guesses[1], end = truth[2].inverse() * truth[1];
    second.path = {start, turned(0.5, 0.5), end};
    ScanEdge rejected{.source = 0, .target = 2, .accepted = false};
    rejected.path = {turned(1, 1)};
    edges = {rejected, first, second};
  }
};

double distance(const Pose& a, const Pose& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(PoseSteps, BeginWithTheGuessesAndChainThePairs) {
  const Row row;
  const auto steps = pose_steps(row.guesses, row.edges, {row.truth}, 0, 50);
  ASSERT_EQ(steps.size(), 4u);
  EXPECT_EQ(steps[0].step, "guess");
  EXPECT_EQ(steps[1].step, "pairs 1");
  EXPECT_EQ(steps[2].step, "pairs 2");
  EXPECT_EQ(steps[3].step, "joint 0");
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(distance(steps[0].world_from_scan[i], row.guesses[i]), 0);
    // The pairs' ends are exact here, so the chain ends at the truth but for rounding.
    EXPECT_LT(distance(steps[2].world_from_scan[i], row.truth[i]), 1e-14);
  }
  EXPECT_LT(distance(steps[1].world_from_scan[1], row.truth[1]), 1e-14);
  EXPECT_LT(distance(steps[1].world_from_scan[2], row.truth[1] * turned(0.5, 0.5).inverse()),
            1e-14);
}

TEST(PoseSteps, KeepTheFirstAndTheLastOfMany) {
  Row row;
  row.edges[1].path.assign(101, row.edges[1].path.back());
  const std::vector<std::vector<Pose>> joint(61, row.truth);
  const auto steps = pose_steps(row.guesses, row.edges, joint, 0, 20);
  EXPECT_LE(steps.size(), 21u);
  EXPECT_EQ(steps[1].step, "pairs 1");
  EXPECT_EQ(steps[10].step, "pairs 100");
  EXPECT_EQ(steps[11].step, "joint 0");
  EXPECT_EQ(steps.back().step, "joint 60");
}

TEST(PoseSteps, WithoutPairsAreTheGuesses) {
  const Row row;
  const auto steps = pose_steps(row.guesses, {}, {}, 0, 20);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].step, "guess");
}

TEST(TraceJson, ComesBack) {
  const Row row;
  const auto steps = pose_steps(row.guesses, row.edges, {row.truth}, 0, 50);
  const auto back = steps_from(nlohmann::ordered_json::parse(trace_json(steps).dump()));
  ASSERT_EQ(back.size(), steps.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    EXPECT_EQ(back[k].step, steps[k].step);
    for (std::size_t i = 0; i < 3; ++i)  // through a quaternion: a few roundings of 1
      EXPECT_LT(distance(back[k].world_from_scan[i], steps[k].world_from_scan[i]), 4e-15);
  }
}

}  // namespace
}  // namespace scan
