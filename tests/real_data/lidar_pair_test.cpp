// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// Two outdoor lidar scans half a metre apart. Two published motions between them differ by 1.9 cm
// and 0.23 degrees, and three programs' generalised ICP agrees with point-to-plane at 0.68 to 0.77
// degrees from the one held against here: the truth is worth 2 cm and 0.8 degrees.
#include "libscan/core/units.h"
#include "libscan/io/poses.h"
#include "tests/real_data/real_data.h"

namespace scan::test {
namespace {

const fs::path folder = data_folder("lidar-small_gicp");

Pose published() {
  return read_poses(folder / "T_target_source.txt").front().pose;
}

struct Result {
  std::string stop;
  double rotation_off_deg = 0;
  double translation_off_m = 0;
};

// The target is the anchor and keeps its pose, so the source's pose is target_from_source.
Answer align_into(const Folder& out, const Pose& target_from_source_guess,
                  const std::vector<std::string>& options = {}) {
  std::ostringstream guesses;
  guesses.precision(17);
  guesses << Pose::Identity().matrix() << "\n" << target_from_source_guess.matrix() << "\n";
  spill(out / "guesses.txt", guesses.str());
  std::vector<std::string> arguments{"align",
                                     (folder / "target.ply").string(),
                                     (folder / "source.ply").string(),
                                     (out / "aligned").string(),
                                     "--init",
                                     (out / "guesses.txt").string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return ask_scan(arguments);
}

nlohmann::json alignment(const Folder& out) {
  return nlohmann::json::parse(slurp(out / "aligned/alignment.json"));
}

Result align(const Pose& target_from_source_guess, const std::vector<std::string>& options = {}) {
  const Folder out;
  align_into(out, target_from_source_guess, options);
  const auto source = alignment(out).at("scans").at(1);
  const Pose found = read_poses(out / "aligned/alignment.json").at(1).pose;
  const Result result{source.at("stop"), deg_from_rad(rotation_distance_rad(found, published())),
                      translation_distance_m(found, published())};
  std::cout << "  " << result.stop << ", " << result.rotation_off_deg << " deg and "
            << result.translation_off_m << " m off, rms " << source.at("rms_m") << " m, inliers "
            << source.at("inlier_fraction_of_source") << "\n";
  return result;
}

bool is_right(const Result& result) {
  return result.translation_off_m <= 0.02 && result.rotation_off_deg <= 0.8;
}

TEST(LidarPair, NearStartEndsAtThePublishedMotion) {
  SKIP_WITHOUT(folder);
  Vector6 twist;
  twist << rad_from_deg(0.3), rad_from_deg(-0.3), rad_from_deg(0.3), 0.03, -0.03, 0.03;
  EXPECT_TRUE(is_right(align(exp(twist) * published())));
}

// Half a metre and 0.8 degrees off: within reach when pairs of that distance count.
TEST(LidarPair, IdentityEndsAtThePublishedMotionWithAWideGate) {
  SKIP_WITHOUT(folder);
  EXPECT_TRUE(is_right(align(Pose::Identity(), {"--max-distance", "1m"})));
}

// With the gate found from the data a start at identity ends in another minimum: that may be, but
// not be called a success.
TEST(LidarPair, WrongMinimumIsNotCalledConverged) {
  SKIP_WITHOUT(folder);
  const Result result = align(Pose::Identity());
  EXPECT_TRUE(is_right(result) || result.stop != "converged");
}

// A kilometre apart nothing overlaps: exit code 4 (computation) and one JSON object that says so.
TEST(LidarPair, NoOverlapIsAnError) {
  SKIP_WITHOUT(folder);
  const Folder out;
  const Answer answer = align_into(out, Pose(Eigen::Translation3d(1000, 0, 0)));
  EXPECT_EQ(answer.exit_code, 4) << answer.err;
  ASSERT_TRUE(answer.json.is_object());
  EXPECT_EQ(answer.json.at("status"), "error");
  EXPECT_EQ(alignment(out).at("scans").at(1).at("stop"), "no correspondences");
}

}  // namespace
}  // namespace scan::test
