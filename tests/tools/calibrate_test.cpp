// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// From pictures of a board on disk to points: scan calibrate, then scan acquire with what it wrote.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "libscan/io/image_file.h"
#include "libscan/io/scan_file.h"
#include "tests/acquire/stereo_rig.h"
#include "tests/acquire/stripe_pictures.h"
#include "tests/tools/program.h"

namespace scan::test {
namespace {

using nlohmann::json;

const std::vector<std::string> board_words = {"--board", "9x6", "--square", "20mm"};

std::string name(const Folder& folder, const std::string& kind, std::size_t i) {
  return (folder / (kind + std::to_string(i) + ".png")).string();
}

Outcome calibrate(const std::string& what, std::vector<std::string> paths,
                  const std::vector<std::string>& words = board_words) {
  paths.insert(paths.begin(), {"calibrate", what});
  paths.insert(paths.end(), words.begin(), words.end());
  return run_scan(paths);
}

// Largest distance of the points' median from a wall, metres.
double median_off_m(const std::string& path, const Pose& scanner_from_wall) {
  std::vector<double> off_m;
  for (const Eigen::Vector3d& point : read_scan(path).cloud.points)
    off_m.push_back((scanner_from_wall.inverse() * point).z());
  std::nth_element(off_m.begin(), off_m.begin() + off_m.size() / 2, off_m.end());
  return off_m[off_m.size() / 2];
}

TEST(Calibrate, LeadsFromPicturesOfABoardToALaserScan) {
  const Folder folder;
  const Camera camera = bent_camera();
  std::vector<std::string> paths;
  const auto held = held_boards(camera, test_board, 11, 6);
  for (std::size_t i = 0; i < held.size(); ++i) {
    paths.push_back(name(folder, "board", i));
    write_png(paths.back(), picture_of(camera, test_board, held[i], 0.7, 2, i));
  }
  const std::string camera_file = (folder / "camera.json").string();
  paths.push_back(camera_file);
  const Outcome first = calibrate("camera", paths);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("6 of 6 pictures"), std::string::npos) << first.out;

  json content = json::parse(slurp(camera_file));
  content["sensor"] = {{"gain_e_per_dn", sensor.gain_e_per_dn},
                       {"read_noise_e", sensor.read_noise_e},
                       {"full_well_e", sensor.full_well_e},
                       {"bits", sensor.bits}};
  spill(camera_file, content.dump());
  const auto lit = boards_in_light();
  paths.clear();
  for (const std::string kind : {"board", "stripe"})
    for (std::size_t i = 0; i < 3; ++i) {
      paths.push_back(name(folder, "lit_" + kind, i));
      if (kind == "board")
        write_png(paths.back(), picture_of(camera, test_board, lit[i], 0.7, 2, 50 + i));
      else
        write_png(paths.back(), stripe_picture(
                                    lit[i],
                                    [](const Eigen::Vector2d& at) {
                                      return board_reflectance(test_board, at.x(), at.y());
                                    },
                                    i));
    }
  const std::string laser_file = (folder / "laser.json").string();
  paths.push_back(laser_file);
  std::vector<std::string> words = board_words;
  words.insert(words.end(), {"--camera", camera_file});
  const Outcome second = calibrate("light-plane", paths, words);
  ASSERT_EQ(second.exit_code, 0) << second.err;

  const Pose wall = held_board(camera, test_board, {395, 305}, 0.3, 0.4, 0.3);
  write_png(folder / "wall.png", stripe_picture(
                                     wall, [](const Eigen::Vector2d&) { return 0.8; }, 9));
  const std::string points = (folder / "points.ply").string();
  const Outcome third = run_scan({"acquire", "laser-line", (folder / "wall.png").string(), points,
                                  "--calibration", laser_file});
  ASSERT_EQ(third.exit_code, 0) << third.err;
  // calibrate_light_plane_test.cpp holds such an error to its sigma, 0.07 mm for 8 + 6 pictures
  EXPECT_LT(std::abs(median_off_m(points, wall)), 4e-4);
}

TEST(Calibrate, LeadsFromPairsOfPicturesToAStereoScan) {
  const Folder folder;
  const StereoRig rig = leaning_rig();
  std::vector<std::string> left, right;
  const auto boards = boards_in_sight_of_both(rig, 21, 5);
  for (std::size_t i = 0; i < boards.size(); ++i) {
    left.push_back(name(folder, "left", i));
    right.push_back(name(folder, "right", i));
    write_png(left.back(), picture_of(rig.left, test_board, boards[i], 0.7, 2, i));
    write_png(right.back(),
              picture_of(rig.right, test_board, rig.right_from_left * boards[i], 0.7, 2, 100 + i));
  }
  std::vector<std::string> paths = left;
  paths.insert(paths.end(), right.begin(), right.end());
  const std::string file = (folder / "stereo.json").string();
  paths.push_back(file);
  std::vector<std::string> words = board_words;
  words.push_back("--json");
  const Outcome first = calibrate("stereo", paths, words);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const json said = json::parse(first.out);
  EXPECT_NEAR(said["baseline_m"], rig.right_from_left.translation().norm(),
              4 * said["baseline_sigma_m"].get<double>());

  const Pose wall = held_board(rig.left, test_board, {420, 300}, 0.32, 0.3, 1);
  write_png(folder / "l.png", wavy_wall(rig.left, wall));
  write_png(folder / "r.png", wavy_wall(rig.right, rig.right_from_left * wall));
  const std::string points = (folder / "points.ply").string();
  const Outcome second = run_scan({"acquire", "stereo", (folder / "l.png").string(),
                                   (folder / "r.png").string(), points, "--calibration", file});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const Rectification turned = rectify(rig, 0.2, 0.6);
  const Pose scanner_from_wall =
      make_pose(turned.rectified_from_left, Eigen::Vector3d::Zero()) * wall;
  // calibrate_stereo_test.cpp holds such an error to its sigma, 0.11 mm for six pairs; the frame is
  // the calibration's own, whose turn of less than 0.1 px is 0.03 mm
  EXPECT_LT(std::abs(median_off_m(points, scanner_from_wall)), 6e-4);
}

TEST(Calibrate, NamesWhatPicturesShowAndWhatTheyLeaveOpen) {
  const Folder folder;
  const std::string flat = name(folder, "flat", 0), out = (folder / "camera.json").string();
  const Pose pose = held_board(bent_camera(), test_board, {395, 305}, 0.3, 0, 0);
  write_png(flat, picture_of(bent_camera(), test_board, pose, 0.7, 2, 1));
  const Outcome wrong = calibrate("camera", {flat, out}, {"--board", "10x7", "--square", "20mm"});
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_NE(wrong.err.find("shows a board of 9x6 inner corners, not 10x7"), std::string::npos)
      << wrong.err;
  const Outcome open = calibrate("camera", {flat, out});
  EXPECT_EQ(open.exit_code, 4);
  EXPECT_NE(open.err.find("undetermined"), std::string::npos) << open.err;
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(calibrate("camera", {flat, out}, {"--square", "20mm", "--board", "9by6"}).exit_code, 2);
  EXPECT_EQ(calibrate("camera", {flat, out}, {}).exit_code, 2);
  EXPECT_EQ(calibrate("stereo", {flat, out}).exit_code, 2);
  EXPECT_EQ(calibrate("camera", {flat, (folder / "camera.txt").string()}).exit_code, 2);
  EXPECT_EQ(calibrate("light-plane", {flat, flat, out}).exit_code, 2);
  const Outcome metres = calibrate("camera", {flat, out}, {"--board", "9x6", "--square", "20"});
  EXPECT_NE(metres.err.find("--square: a square of 20 m?"), std::string::npos) << metres.err;
  const Outcome slip = calibrate("camra", {flat, out});
  EXPECT_EQ(slip.exit_code, 2);
  EXPECT_NE(slip.err.find("'camra' is none of camera,stereo,light-plane; did you mean 'camera'?"),
            std::string::npos)
      << slip.err;
}

}  // namespace
}  // namespace scan::test
