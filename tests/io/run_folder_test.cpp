// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/run_folder.h"

#include <gtest/gtest.h>

#include "tests/io/io_test_support.h"

namespace scan {
namespace {

TEST(RunFolder, KnowsAStageByItsInputsAndItsFiles) {
  const TemporaryFolder folder;
  const auto path = folder / "run";
  RunFolder run = open_run_folder(path, RunStart::fresh);
  EXPECT_FALSE(is_done(run, "align", "a"));
  write_file(path / "alignment.json", "{}");
  write_file(path / "poses.tum", "1");
  record_stage(run, "align", "a", {"alignment.json", "poses.tum"});
  const RunFolder again = open_run_folder(path, RunStart::resume);
  EXPECT_TRUE(is_done(again, "align", "a"));
  EXPECT_FALSE(is_done(again, "align", "b"));        // other inputs
  EXPECT_FALSE(is_done(again, "reconstruct", "a"));  // another stage
  write_file(path / "poses.tum", "2");               // changed since
  EXPECT_FALSE(is_done(again, "align", "a"));
  write_file(path / "poses.tum", "1");
  EXPECT_TRUE(is_done(again, "align", "a"));
  std::filesystem::remove(path / "poses.tum");
  EXPECT_FALSE(is_done(again, "align", "a"));
}

TEST(RunFolder, ForgetsWhatCameBehindAStageDoneAgain) {
  const TemporaryFolder folder;
  RunFolder run = open_run_folder(folder / "run", RunStart::fresh);
  record_stage(run, "simulate", "1", {});
  record_stage(run, "align", "2", {});
  record_stage(run, "reconstruct", "3", {});
  record_stage(run, "align", "4", {});
  EXPECT_TRUE(is_done(run, "simulate", "1"));
  EXPECT_TRUE(is_done(run, "align", "4"));
  EXPECT_FALSE(is_done(run, "reconstruct", "3"));
}

TEST(RunFolder, RefusesAnEarlierRunUnlessAsked) {
  const TemporaryFolder folder;
  const auto path = folder / "run";
  RunFolder run = open_run_folder(path, RunStart::fresh);
  open_run_folder(path, RunStart::fresh);  // nothing was run yet
  std::filesystem::create_directory(path / "scans");
  write_file(path / "notes.txt", "mine");
  record_stage(run, "simulate", "1", {});
  try {
    open_run_folder(path, RunStart::fresh);
    ADD_FAILURE() << "an earlier run was overwritten";
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::output);
    EXPECT_NE(error.hint().find("--resume"), std::string::npos);
    EXPECT_NE(error.hint().find("--force"), std::string::npos);
  }
  EXPECT_EQ(open_run_folder(path, RunStart::resume).stages.size(), 1u);
  EXPECT_TRUE(open_run_folder(path, RunStart::force).stages.empty());
  EXPECT_FALSE(std::filesystem::exists(path / "scans"));
  EXPECT_EQ(read_file(path / "notes.txt"), "mine");  // what is no part of a run stays
}

TEST(RunFolder, RefusesAPathThatCannotBeOne) {
  const TemporaryFolder folder;
  write_file(folder / "file", "");
  EXPECT_NE(error_of([&] { open_run_folder(folder / "file", RunStart::fresh); }, Trouble::output)
                .find("is a file"),
            std::string::npos);
  error_of([&] { open_run_folder(folder / "file" / "below", RunStart::fresh); }, Trouble::output);
  error_of([] { open_run_folder("/proc/no/run", RunStart::fresh); }, Trouble::output);
}

TEST(RunFolder, RefusesABrokenRecord) {
  const TemporaryFolder folder;
  write_file(folder / "stages.json", "{\"stages\": [{\"stage\": 1}]}");
  EXPECT_NE(
      error_of([&] { open_run_folder(folder.path(), RunStart::resume); }).find("stages/0/stage"),
      std::string::npos);
}

}  // namespace
}  // namespace scan
