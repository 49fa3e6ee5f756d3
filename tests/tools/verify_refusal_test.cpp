// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Files and options that `scan verify` cannot have been meant to take.
#include <gtest/gtest.h>

#include "tests/tools/judged_cube.h"
#include "tests/tools/small_run.h"

namespace scan::test {
namespace {

constexpr int usage = 2, input = 3, output = 5;

// What a failed reconstruction leaves is no cloud that lies well; one that is can be made so.
TEST(VerifyInput, AMeshWithoutFacesIsNotTakenForACloud) {
  const Folder folder;
  spill(folder / "truth.off", cube_off(1, 0));
  spill(folder / "empty.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
        "property double z\nelement face 0\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n1 1 1\n");
  const std::string empty = (folder / "empty.ply").string(),
                    truth = (folder / "truth.off").string(),
                    cloud = (folder / "cloud.ply").string();
  const Outcome outcome = run_scan({"verify", empty, "--truth", truth});
  EXPECT_EQ(outcome.exit_code, input) << outcome.out;
  EXPECT_TRUE(says(outcome, "empty.ply: is a mesh without a face")) << outcome.err;
  EXPECT_EQ(run_scan({"convert", empty, cloud}).exit_code, 0);
  EXPECT_EQ(run_scan({"verify", cloud, "--truth", truth}).exit_code, 0);
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
