// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan acquire: what it leaves behind when nothing comes out, and outputs that cannot be meant.
#include <gtest/gtest.h>

#include "libscan/core/random.h"
#include "libscan/io/image_file.h"
#include "tests/tools/program.h"

namespace scan::test {
namespace {

constexpr int usage = 2, computation = 4, output = 5;

// A rectified pair; the right picture is the left one moved by 5 px, or both are grey all over.
void write_pair(const Folder& folder, bool with_texture) {
  Image<std::uint8_t> left(64, 48), right(64, 48);
  for (int y = 0; y < left.height; ++y)
    for (int x = 0; x < left.width; ++x) {
      const auto brightness = [&](int column) {
        if (!with_texture) return std::uint8_t{128};
        RandomStream random(1, static_cast<std::uint32_t>(y), static_cast<std::uint64_t>(column));
        return static_cast<std::uint8_t>(255 * random.uniform());
      };
      left(x, y) = brightness(x);
      right(x, y) = brightness(x + 5);
    }
  write_png(folder / "left.png", left);
  write_png(folder / "right.png", right);
  spill(folder / "calib.txt",
        "cam0=[50 0 32; 0 50 24; 0 0 1]\ncam1=[50 0 32; 0 50 24; 0 0 1]\ndoffs=0\nbaseline=100\n"
        "width=64\nheight=48\nndisp=16\n");
}

Outcome acquire(const Folder& folder, const std::string& out, const std::string& disparity) {
  return run_scan({"acquire", "stereo", (folder / "left.png").string(),
                   (folder / "right.png").string(), (folder / out).string(), "--calibration",
                   (folder / "calib.txt").string(), "--disparity", (folder / disparity).string()});
}

const std::vector<std::string> inputs = {"calib.txt", "left.png", "right.png"};

TEST(Acquire, OfAPairWithoutTextureLeavesNothingBehind) {
  const Folder folder;
  write_pair(folder, false);
  const Outcome outcome = acquire(folder, "points.ply", "disparity.pfm");
  EXPECT_EQ(outcome.exit_code, computation) << outcome.err;
  EXPECT_NE(outcome.err.find("no ray gave a point; nothing written"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(files_below(folder.path()), inputs);
}

TEST(Acquire, WritesPointsAndDisparity) {
  const Folder folder;
  write_pair(folder, true);
  const Outcome outcome = acquire(folder, "points.ply", "disparity.pfm");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Image<float> disparity = read_float_image(folder / "disparity.pfm");
  EXPECT_NEAR(disparity(40, 24), 5, 0.1);
  EXPECT_TRUE(std::filesystem::exists(folder / "points.ply"));
}

TEST(Acquire, RefusesOutputsThatCannotBeMeant) {
  const Folder folder;
  write_pair(folder, true);
  EXPECT_EQ(acquire(folder, "points.ply", "disparity.png").exit_code, output);
  EXPECT_EQ(acquire(folder, "points.ply", "gone/disparity.pfm").exit_code, output);
  const Outcome other =
      run_scan({"acquire", "phase", folder.path().string(), (folder / "points.ply").string(),
                "--calibration", (folder / "calib.txt").string(), "--disparity",
                (folder / "disparity.pfm").string()});
  EXPECT_EQ(other.exit_code, usage) << other.err;
  EXPECT_NE(other.err.find("--disparity goes with stereo"), std::string::npos) << other.err;
  for (const auto& [option, value] :
       {std::pair("--peak", "centroid"), std::pair("--pulse", "leading-edge")}) {
    const Outcome unused =
        run_scan({"acquire", "stereo", (folder / "left.png").string(),
                  (folder / "right.png").string(), (folder / "points.ply").string(),
                  "--calibration", (folder / "calib.txt").string(), option, value});
    EXPECT_EQ(unused.exit_code, usage) << unused.err;
    EXPECT_NE(unused.err.find(option), std::string::npos) << unused.err;
  }
  EXPECT_EQ(files_below(folder.path()), inputs);
}

}  // namespace
}  // namespace scan::test
