// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// A run made by several processes, or in several goes, is the run made by one.
#include <gtest/gtest.h>

#include <map>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

const std::string recipe = LIBSCAN_SOURCE_DIR "/tests/tools/small_run.json";  // eight scans

Outcome simulate(const std::filesystem::path& run, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"simulate", recipe, run.string()});
  return run_scan(more);
}

// All that a run left behind but its seconds.
std::map<std::string, std::string> contents(const std::filesystem::path& run) {
  std::map<std::string, std::string> files;
  for (const std::string& name : files_below(run))
    if (!name.starts_with("timings")) files[name] = slurp(run / name);
  return files;
}

TEST(Shard, SeveralPartsInAnyOrderMakeTheSameRun) {
  const Folder folder;
  ASSERT_EQ(simulate(folder / "whole").exit_code, 0);
  for (const char* part : {"3/3", "1/3"}) {
    const Outcome outcome = simulate(folder / "parts", {"--shard", part});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("still to come"), std::string::npos) << outcome.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "parts" / "stages.json"));
  }
  const Outcome last = simulate(folder / "parts", {"--shard", "2/3"});
  EXPECT_NE(last.out.find("8 scans"), std::string::npos) << last.out;
  EXPECT_EQ(contents(folder / "parts"), contents(folder / "whole"));
}

TEST(Shard, AnInterruptedRunKeepsTheScansThatItHas) {
  const Folder folder;
  const auto run = folder / "run";
  ASSERT_EQ(simulate(run).exit_code, 0);
  const auto before = contents(run);
  const auto written = std::filesystem::last_write_time(run / "scans" / "002.ply");
  // What an interruption in the sixth scan leaves behind.
  for (const char* name : {"stages.json", "simulation.json", "simulation/005.json",
                           "simulation/006.json", "simulation/007.json", "scans/006.ply",
                           "scans/007.ply", "truth/005.ply", "truth/poses.tum"})
    ASSERT_TRUE(std::filesystem::remove(run / name)) << name;
  ASSERT_EQ(simulate(run, {"--resume"}).exit_code, 0);
  EXPECT_EQ(contents(run), before);
  EXPECT_EQ(std::filesystem::last_write_time(run / "scans" / "002.ply"), written);
}

// A scan that the same inputs did not make is no part of the run.
TEST(Shard, AScanOfOtherInputsIsMadeAnew) {
  const Folder folder;
  const auto run = folder / "run";
  ASSERT_EQ(simulate(run).exit_code, 0);
  const auto before = contents(run);
  spill(run / "simulation" / "003.json", "{\"inputs\": \"others\", \"paths\": 1}");
  spill(run / "scans" / "003.ply", "of another recipe");
  std::filesystem::remove(run / "stages.json");
  ASSERT_EQ(simulate(run, {"--resume"}).exit_code, 0);
  EXPECT_EQ(contents(run), before);
}

TEST(Shard, MustBeAPartOfSeveral) {
  const Folder folder;
  for (const char* part : {"0/3", "4/3", "2", "1/", "/2", "1/2/3", "a/b", "-1/2"}) {
    const Outcome outcome = simulate(folder / "run", {"--shard", part});
    EXPECT_EQ(outcome.exit_code, 2) << part;
    EXPECT_NE(outcome.err.find("such as 1/4 to 4/4"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(simulate(folder / "run", {"--shard", "1/2", "--force"}).exit_code, 2);
  EXPECT_EQ(simulate(folder / "run", {"--shard", "1/2", "--check"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

TEST(Shard, OfAnotherRecipeIsRefused) {
  const Folder folder;
  ASSERT_EQ(simulate(folder / "run", {"--shard", "1/2"}).exit_code, 0);
  const Outcome outcome = simulate(folder / "run", {"--shard", "2/2", "--seed", "9"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("another recipe"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace scan::test
