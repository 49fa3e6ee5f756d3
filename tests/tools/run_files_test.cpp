// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What an alignment states of its poses comes back from the run folder.
#include "tools/run_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/json_output.h"
#include "tests/tools/program.h"

namespace scan {
namespace {

TEST(RunFiles, StatedPosesComeBackToTheBit) {
  const test::Folder folder;
  MultiviewResult result;
  result.scans.resize(3);
  Matrix6 covariance = Matrix6::Identity() / 3;
  covariance(0, 5) = covariance(5, 0) = 1e-7 / 7;
  result.scans[1].covariance = covariance;
  Matrix6 common = covariance;
  common(2, 4) = 1.0 / 7;  // needs not be symmetric
  result.covariances_between = {{1, 2, common}};
  result.scans[1].covariance_centre = Eigen::Vector3d(0.1, -1e6 / 3, 7);
  const std::vector<std::string> files{"a", "b", "c"};
  write_json(folder / "alignment.json", alignment_json(files, result, {}));
  const auto [stated, between] = read_run_stated_poses(folder.path());
  ASSERT_EQ(between.size(), 1u);
  EXPECT_EQ(std::pair(between[0].first, between[0].second),
            std::pair(std::size_t{1}, std::size_t{2}));
  EXPECT_EQ(between[0].covariance, common);
  ASSERT_EQ(stated.size(), 3u);
  EXPECT_FALSE(stated[0].has_value());
  ASSERT_TRUE(stated[1].has_value());
  EXPECT_EQ(stated[1]->covariance, covariance);
  EXPECT_EQ(stated[1]->centre, result.scans[1].covariance_centre);
  EXPECT_FALSE(stated[2].has_value());
}

// As they are looked up, in whatever order a file holds them.
TEST(RunFiles, CouplesComeBackInOrder) {
  const test::Folder folder;
  MultiviewResult result;
  result.scans.resize(3);
  result.covariances_between = {{1, 2, Matrix6::Identity()}, {0, 2, 2 * Matrix6::Identity()}};
  const std::vector<std::string> files{"a", "b", "c"};
  write_json(folder / "alignment.json", alignment_json(files, result, {}));
  const StatedPoses stated = read_run_stated_poses(folder.path());
  ASSERT_EQ(stated.between.size(), 2u);
  EXPECT_EQ(stated.between[0].first, 0u);
  EXPECT_EQ(stated.between[0].covariance, 2 * Matrix6::Identity());
  EXPECT_EQ(stated.between[1].first, 1u);
}

TEST(RunFiles, WithoutAnAlignmentNothingIsStated) {
  const test::Folder folder;
  EXPECT_TRUE(read_run_stated_poses(folder.path()).scans.empty());
  test::spill(folder / "alignment.json", R"({"scans": [{"file": "a"}]})");
  EXPECT_THROW(read_run_stated_poses(folder.path()), Error);
  test::spill(folder / "alignment.json", R"({"scans": [{"covariance": [[1]]}]})");
  EXPECT_THROW(read_run_stated_poses(folder.path()), Error);
}

}  // namespace
}  // namespace scan
