// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Files and options that `scan verify` cannot have been meant to take.
#include <gtest/gtest.h>

#include "tests/tools/judged_cube.h"
#include "tests/tools/small_run.h"

namespace scan::test {
namespace {

constexpr int usage = 2, input = 3, output = 5;

// Two places of the unit cube, with an empty list of faces as mesh programs write beside points.
std::string faceless_ply(const std::string& more_properties, const std::string& rows,
                         int vertices = 2) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty double x\nproperty double y\nproperty double z\n" + more_properties +
         "element face 0\nproperty list uchar int vertex_indices\nend_header\n" + rows;
}

TEST(VerifyInput, ACloudWithAnEmptyListOfFacesIsMeasuredAsACloud) {
  const Folder folder;
  spill(folder / "truth.off", cube_off(1, 0));
  spill(folder / "cloud.ply", faceless_ply("", "0 0 0\n0.5 0.5 1.25\n"));
  const std::string cloud = (folder / "cloud.ply").string();
  const Outcome outcome =
      run_scan({"verify", cloud, "--truth", (folder / "truth.off").string(), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(says(outcome, "cloud.ply: lists no face")) << outcome.err;
  for (const auto& m : nlohmann::json::parse(outcome.out).at("measurements")) {
    EXPECT_NE(m.at("name"), "components") << "a cloud has none";
    if (m.at("name") != "accuracy_max") continue;
    EXPECT_EQ(m.at("value"), 0.25);
    EXPECT_EQ(m.at("over"), "measured points");
  }
  const Outcome info = run_scan({"info", cloud, "--json"});
  EXPECT_EQ(nlohmann::json::parse(info.out).at("kind"), "points");
  const Outcome as_truth = run_scan({"verify", (folder / "truth.off").string(), "--truth", cloud});
  EXPECT_EQ(as_truth.exit_code, input);
  EXPECT_TRUE(says(as_truth, "the truth must be a surface")) << as_truth.err;
}

// What a failed reconstruction leaves is no cloud that lies well.
TEST(VerifyInput, ASurfaceWithoutFacesIsNotTakenForACloud) {
  const Folder folder;
  spill(folder / "truth.off", cube_off(1, 0));
  spill(folder / "emptied.ply", faceless_ply("property double support_m\n", "0 0 0 0\n1 1 1 0\n"));
  spill(folder / "none.ply", faceless_ply("", "", 0));
  const std::string truth = (folder / "truth.off").string();
  for (const char* name : {"emptied.ply", "none.ply"}) {
    const Outcome outcome = run_scan({"verify", (folder / name).string(), "--truth", truth});
    EXPECT_EQ(outcome.exit_code, input) << outcome.out;
    EXPECT_TRUE(says(outcome, std::string(name) + ": is a surface without a face")) << outcome.err;
  }
  spill(folder / "empty.obj", "v 0 0 0\nv 1 0 0\n");
  const Outcome obj = run_scan({"info", (folder / "empty.obj").string()});
  EXPECT_EQ(obj.exit_code, input);
  EXPECT_TRUE(says(obj, "empty.obj: holds no triangle")) << obj.err;
}

// Triangles and points that tell nothing are left out, and that is said.
TEST(VerifyInput, WhatIsLeftOutOfFilesIsSaid) {
  const Folder folder;
  const Judged flat = judged(folder, cube_off(1, 0, "3 0 0 1\n3 2 2 2\n", 2));
  EXPECT_EQ(flat.outcome.exit_code, 0) << flat.outcome.err;
  EXPECT_TRUE(says(flat.outcome, "measured.off: 2 of 14 triangles have no area"));
  const Outcome info = run_scan({"info", (folder / "measured.off").string(), "--json"});
  EXPECT_EQ(nlohmann::json::parse(info.out).at("triangles_without_area"), 2);
  EXPECT_FALSE(says(judged(folder, cube_off(1, 0)).outcome, "no area"));
  spill(folder / "cloud.xyz", "0 0 0\n1 0 0\nnan 0 0\n");
  const std::string cloud = (folder / "cloud.xyz").string(), words = "1 points are not finite";
  EXPECT_TRUE(says(run_scan({"verify", cloud, "--truth", (folder / "truth.off").string()}), words));
  EXPECT_TRUE(says(run_scan({"convert", cloud, (folder / "cloud.ply").string()}), words));
}

TEST(VerifyInput, FoldersAndEndingsThatCannotBeMeant) {
  const Folder folder;
  spill(folder / "truth.off", cube_off(1, 0));
  const std::string truth = (folder / "truth.off").string();
  const Outcome is_folder = run_scan({"verify", truth, "--truth", folder.path().string()});
  EXPECT_EQ(is_folder.exit_code, input);
  EXPECT_TRUE(says(is_folder, "truth/surface.json")) << is_folder.err;
  const Outcome jpeg =
      run_scan({"verify", truth, "--truth", truth, "--picture", (folder / "p.jpg").string()});
  EXPECT_EQ(jpeg.exit_code, output);
  EXPECT_FALSE(std::filesystem::exists(folder / "p.jpg"));
}

// A run whose effects cannot be read has no verdict that could say what it leaves out.
TEST(VerifyInput, BrokenEffectsOfARunAreNamed) {
  const Folder folder;
  std::filesystem::copy(small_run(), folder / "run", std::filesystem::copy_options::recursive);
  for (const char* content : {"[1, 2]", "[ {"}) {
    spill(folder / "run/effects.json", content);
    const Outcome outcome = run_scan({"verify", (folder / "run").string()});
    EXPECT_EQ(outcome.exit_code, input) << outcome.err;
    EXPECT_TRUE(says(outcome, "run/effects.json: ")) << outcome.err;
  }
}

// What a recipe says is not said a second time, and a cloud has no picture.
TEST(VerifyInput, OptionsThatWouldBePassedOverAreRefused) {
  const Folder folder;
  std::filesystem::create_directory(folder / "run");
  spill(folder / "truth.off", cube_off(1, 0));
  spill(folder / "cloud.xyz", "0 0 0\n1 0 0\n");
  const std::string run = (folder / "run").string(), truth = (folder / "truth.off").string(),
                    cloud = (folder / "cloud.xyz").string();
  const std::vector<std::vector<std::string>> unused = {
      {run, "--limits", "limits.json"},
      {run, "--truth", truth},
      {run, "--threshold", "1mm"},
      {run, "--picture", "p.png"},
      {truth, "--truth", truth, "--doffs", "3"},
      {cloud, "--truth", truth, "--picture", "p.png"}};
  for (std::vector<std::string> words : unused) {
    const std::string option = words[words.size() - 2];
    words.insert(words.begin(), "verify");
    const Outcome outcome = run_scan(words);
    EXPECT_EQ(outcome.exit_code, usage) << option << outcome.err;
    EXPECT_TRUE(says(outcome, option)) << outcome.err;
  }
}

}  // namespace
}  // namespace scan::test
