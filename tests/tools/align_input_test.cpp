// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// What `scan align` makes of scans, poses and interruptions that are not as they should be.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "tests/tools/program.h"

namespace scan::test {
namespace {

constexpr int input = 3, interrupted = 130;

// A lump's points; `unit` in metres per number, `phase` shifts the points along the surface.
std::string lump_ply(int count, double unit, double phase) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                     "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), a = 2.399963 * i + phase;
    const double x = r * std::cos(a), y = r * std::sin(a);
    const double radius = (1 + 0.3 * std::sin(3 * x + 1) * std::cos(2 * y) + 0.2 * x * z) / unit;
    char line[120];
    std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", radius * x, radius * y, radius * z);
    text += line;
  }
  return text;
}

std::vector<std::string> spill_lumps(const Folder& folder, int scans, int points) {
  std::vector<std::string> files;
  for (int i = 0; i < scans; ++i) {
    files.push_back((folder / (std::to_string(i) + ".ply")).string());
    spill(files.back(), lump_ply(points, 1, 0.1 * i));
  }
  return files;
}

Outcome align(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.begin(), "align");
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_scan(arguments);
}

TEST(AlignInput, AnotherUnitIsSuspectedWithItsFactor) {
  const Folder folder;
  std::vector<std::string> files = spill_lumps(folder, 3, 800);
  spill(files[2], lump_ply(800, 1e-3, 0.2));
  const Outcome outcome = align(files, {(folder / "out").string()});
  EXPECT_NE(outcome.err.find("2.ply: its size is"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("scale it by 0.001"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("1.ply: its size is"), std::string::npos) << outcome.err;
}

TEST(AlignInput, PosesThatAreNoMotionsAreRefused) {
  const Folder folder;
  const auto files = spill_lumps(folder, 1, 300);
  const auto said = [&](const std::string& matrix) {
    spill(folder / "init.txt", matrix);
    const Outcome outcome =
        align(files, {(folder / "out").string(), "--init", (folder / "init.txt").string()});
    EXPECT_EQ(outcome.exit_code, input) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(said("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n").find("left-handed"), std::string::npos);
  EXPECT_NE(said("1 0 0.00001 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n").find("away from a rotation"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(AlignInput, AConfThatNamesOtherFilesIsToldOf) {
  const Folder folder;
  const auto files = spill_lumps(folder, 2, 800);
  spill(folder / "all.conf",
        "bmesh 0.ply 0 0 0 0 0 0 1\nbmesh 1.ply 0 0 0 0 0 0 1\n"
        "bmesh lost.ply 0 0 0 0 0 0 1\n");
  const Outcome outcome =
      align(files, {(folder / "out").string(), "--init", (folder / "all.conf").string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("names lost.ply"), std::string::npos) << outcome.err;
  spill(folder / "few.conf", "bmesh 0.ply 0 0 0 0 0 0 1\n");
  const Outcome few =
      align(files, {(folder / "out").string(), "--init", (folder / "few.conf").string()});
  EXPECT_EQ(few.exit_code, input) << few.err;
  EXPECT_NE(few.err.find("has no pose for"), std::string::npos) << few.err;
}

TEST(AlignInput, OneScanIsAlignedWithItself) {
  const Folder folder;
  const Outcome outcome = align(spill_lumps(folder, 1, 300), {(folder / "out").string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "out/aligned.ply"));
}

// There is no noise: to the iteration's end, a millionth of the size of 2 m.
TEST(AlignInput, IdenticalScansComeToLieOnEachOther) {
  const Folder folder;
  std::vector<std::string> files = spill_lumps(folder, 1, 2000);
  for (int i = 1; i < 4; ++i) {
    files.push_back((folder / (std::to_string(i) + ".ply")).string());
    std::filesystem::copy_file(files[0], files.back());
  }
  spill(folder / "off.conf",
        "bmesh 0.ply 0 0 0 0 0 0 1\nbmesh 1.ply 0.03 0 0 0 0 0 1\n"
        "bmesh 2.ply 0 -0.02 0.02 0 0 0 1\nbmesh 3.ply 0 0 0 0 0 0.01 0.99995\n");
  const Outcome outcome =
      align(files, {(folder / "out").string(), "--init", (folder / "off.conf").string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("its size is"), std::string::npos) << outcome.err;
  std::istringstream poses(slurp(folder / "out/poses.tum"));
  std::string comment;
  std::getline(poses, comment);
  int found = 0;
  for (double index, x, y, z, qx, qy, qz, qw; poses >> index >> x >> y >> z >> qx >> qy >> qz >> qw;
       ++found)
    EXPECT_LT(std::hypot(std::hypot(x, y, z), std::hypot(qx, qy, qz)), 1e-5) << index;
  EXPECT_EQ(found, 4);
}

// Starts the program and sends it Ctrl-C once it has opened its folder, before its many pairs can
// be done.
int interrupt(const std::vector<std::string>& files, const Folder& folder) {
  std::string command = "cd / && exec " + quoted(LIBSCAN_BINARY_DIR "/scan") + " align";
  for (const std::string& file : files) command += " " + quoted(file);
  command += " " + quoted((folder / "out").string()) + " --threads 1 >/dev/null 2>&1";
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  while (!std::filesystem::exists(folder / "out") && kill(child, 0) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(AlignInput, AnInterruptedCallKeepsItsPairsAndGoesOn) {
  const Folder folder;
  const auto files = spill_lumps(folder, 8, 6000);
  EXPECT_EQ(interrupt(files, folder), interrupted);
  EXPECT_EQ(files_below(folder / "out"), std::vector<std::string>{"pairs.json"});
  const Outcome rest = align(files, {(folder / "out").string(), "--resume"});
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  const Outcome whole = align(files, {(folder / "whole").string()});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  for (const char* name : {"poses.tum", "alignment.json", "pairs.json"})
    EXPECT_EQ(slurp((folder / "out") / name), slurp((folder / "whole") / name)) << name;
  // Other scans are not continued.
  spill(files[0], lump_ply(500, 1, 0));
  const Outcome other = align(files, {(folder / "out").string(), "--resume"});
  EXPECT_EQ(other.exit_code, input) << other.err;
  EXPECT_NE(other.err.find("other scans or settings"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace scan::test
