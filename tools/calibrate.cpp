// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan calibrate: pictures of a chessboard to the calibration that scan acquire reads.
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/calibration_json.h"
#include "libscan/io/image_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "tools/commands.h"
#include "tools/inputs.h"

namespace scan {
namespace {

using nlohmann::ordered_json;
using Files = std::vector<std::string>;

struct Arguments {
  std::string what;
  Files paths;
  std::string board = "9x6";
  double square_m = 0;
  long distortion = 4;
  std::string camera;
  std::string steps;
  double nearest_m = 0;
  double farthest_m = 0;
};

// "9x6": columns and rows of inner corners.
Board board_of(const Arguments& arguments, Console& console) {
  Board board{.square_m = arguments.square_m};
  int used = 0;
  const bool read =
      std::sscanf(arguments.board.c_str(), "%4dx%4d%n", &board.columns, &board.rows, &used) == 2;
  if (!read || static_cast<std::size_t>(used) != arguments.board.size())
    throw Error(Trouble::usage,
                "--board: '" + arguments.board + "' is not a count of inner corners, such as 9x6");
  if (board.square_m == 0)
    throw Error(Trouble::usage, "--square: is missing, the side of the board's squares");
  check(board);
  if (board.square_m >= 1)
    console.warn("--square: a square of " + readable_length(board.square_m) +
                 "? A bare number is metres; millimetres are written as 20mm");
  return board;
}

std::string rounded(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::vector<BoardSighting> find_boards(const Files& files, const Board& board) {
  std::vector<BoardSighting> seen;
  for (const std::string& file : files) seen.push_back(find_board(read_grey8(file), board));
  return seen;
}

// The first half of the files and the second: boards and stripes, left and right.
std::pair<Files, Files> halves(const Files& files, const char* what) {
  if (files.size() % 2 != 0)
    throw Error(Trouble::usage, std::to_string(files.size()) + " pictures: " + what);
  const auto middle = files.begin() + static_cast<std::ptrdiff_t>(files.size() / 2);
  return {{files.begin(), middle}, {middle, files.end()}};
}

// Warns of pictures that were left out, and returns all of them.
ordered_json pictures_json(const Files& files, const std::vector<PictureUse>& uses,
                           Console& console) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < uses.size(); ++i) {
    list.push_back({{"file", files[i]}, {"rms_px", uses[i].rms_px}, {"left_out", nullptr}});
    if (uses[i].left_out.empty()) {
      console.detail(files[i] + ": rms " + rounded(uses[i].rms_px, 3) + " px");
    } else {
      list.back()["left_out"] = uses[i].left_out;
      console.warn(files[i] + ": left out, " + uses[i].left_out);
    }
  }
  return list;
}

// Says the camera with a standard deviation for each of its numbers.
ordered_json camera_figures(const std::string& name, const Camera& c,
                            const CameraCovariance& covariance, Console& console) {
  constexpr const char* names[] = {"fx_px", "fy_px", "cx_px", "cy_px", "k1",
                                   "k2",    "p1",    "p2",    "k3"};
  const double values[] = {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
  ordered_json figures;
  for (int i = 0; i < 9; ++i) {
    const double sigma = std::sqrt(covariance(i, i));
    figures[names[i]] = {{"value", values[i]}, {"sigma", sigma}};
    if (sigma == 0) continue;  // held
    const int digits = i < 4 ? 3 : 6;
    console.say("  " + name + names[i] + " " + rounded(values[i], digits) + " +- " +
                rounded(sigma, digits));
  }
  return figures;
}

void warn_of_coverage(const std::string& name, double coverage, double ray_sigma_px,
                      Console& console) {
  if (coverage >= 0.5) return;
  console.warn(name + ": the boards cover " + rounded(100 * coverage, 0) +
               " % of the picture; beyond them the calibration is extrapolated, a ray known to " +
               rounded(ray_sigma_px, 2) + " px at worst");
}

ordered_json calibrate_camera_files(const Files& files, const std::string& output,
                                    const Arguments& arguments, Console& console) {
  const Board board = board_of(arguments, console);
  const CameraCalibration found =
      calibrate_camera(board, find_boards(files, board),
                       {.distortion_terms = static_cast<int>(arguments.distortion)});
  ordered_json pictures = pictures_json(files, found.pictures, console);
  warn_of_coverage("camera", found.coverage, found.ray_sigma_px, console);
  write_json(output, calibration_json(found));
  console.say(output + ": " + std::to_string(found.camera_from_board.size()) + " of " +
              std::to_string(files.size()) + " pictures, rms " + rounded(found.rms_px, 3) + " px");
  return {{"rms_px", found.rms_px},
          {"coverage", found.coverage},
          {"ray_sigma_px", found.ray_sigma_px},
          {"camera", camera_figures("", found.camera, found.covariance, console)},
          {"pictures", std::move(pictures)}};
}

// Depths to look for: a little more than the boards' unless told otherwise.
std::pair<double, double> depths_of(const Arguments& arguments, const RigCalibration& found) {
  return {arguments.nearest_m > 0 ? arguments.nearest_m : 0.8 * found.nearest_m,
          arguments.farthest_m > 0 ? arguments.farthest_m : 1.25 * found.farthest_m};
}

// Says the rig, and how far its pictures bear it.
ordered_json rig_figures(const RigCalibration& found, Console& console) {
  const CameraCovariance sides[] = {found.covariance.block<9, 9>(0, 0),
                                    found.covariance.block<9, 9>(9, 9)};
  warn_of_coverage("left camera", found.coverage_left,
                   calibrating::largest_ray_sigma_px(found.rig.left, sides[0]), console);
  warn_of_coverage("right camera", found.coverage_right,
                   calibrating::largest_ray_sigma_px(found.rig.right, sides[1]), console);
  return {{"rms_px", found.rms_px},
          {"epipolar_rms_px", found.epipolar_rms_px},
          {"baseline_m", found.baseline_m},
          {"baseline_sigma_m", found.baseline_sigma_m},
          {"coverage", {found.coverage_left, found.coverage_right}},
          {"left", camera_figures("left ", found.rig.left, sides[0], console)},
          {"right", camera_figures("right ", found.rig.right, sides[1], console)}};
}

ordered_json calibrate_stereo_files(const Files& files, const std::string& output,
                                    const Arguments& arguments, Console& console) {
  const Board board = board_of(arguments, console);
  const auto [left, right] = halves(files, "as many right pictures as left ones are needed");
  const auto left_seen = find_boards(left, board), right_seen = find_boards(right, board);
  std::vector<BoardPair> pairs;
  for (std::size_t i = 0; i < left.size(); ++i) pairs.push_back({left_seen[i], right_seen[i]});
  console.log(std::to_string(left.size()) + " pairs, from " + left.front() + " with " +
              right.front() + " to " + left.back() + " with " + right.back());
  const RigCalibration found =
      calibrate_stereo(board, pairs, {.distortion_terms = static_cast<int>(arguments.distortion)});
  ordered_json pictures = pictures_json(left, found.pairs, console);
  const auto [nearest_m, farthest_m] = depths_of(arguments, found);
  const Rectification turned = rectify(found.rig, nearest_m, farthest_m);  // throws if it is none
  write_json(output, calibration_json(found, nearest_m, farthest_m));
  console.say(output + ": rms " + rounded(found.rms_px, 3) + " px, off the epipolar lines " +
              rounded(found.epipolar_rms_px, 3) + " px, baseline " +
              rounded(1e3 * found.baseline_m, 4) + " +- " +
              rounded(1e3 * found.baseline_sigma_m, 4) + " mm, depths " +
              readable_length(nearest_m) + " to " + readable_length(farthest_m));
  ordered_json result = rig_figures(found, console);
  result["disparities_px"] = turned.calibration.disparities_px;
  result["pictures"] = std::move(pictures);
  return result;
}

// The poses of the steps at which a part will be scanned, or the camera's own frame for one image.
std::vector<Pose> steps_of(const std::string& path) {
  if (path.empty()) return {Pose::Identity()};
  std::vector<Pose> steps;
  for (const NamedPose& step : read_poses(path)) steps.push_back(step.pose);
  return steps;
}

// Says the plane n . x = offset, camera frame, with a standard deviation for each of its numbers.
ordered_json plane_figures(const LightPlaneCalibration& found, Console& console) {
  const auto say = [&](const std::string& name, double value, int row, double scale, int digits) {
    const double sigma = std::sqrt(found.covariance(row, row));
    console.say("  " + name + " " + rounded(scale * value, digits) + " +- " +
                rounded(scale * sigma, digits));
  };
  for (int i = 0; i < 3; ++i) say(std::string("normal ") + "xyz"[i], found.normal[i], 9 + i, 1, 6);
  say("offset_mm", found.offset_m, 12, 1e3, 4);
  return {{"points", found.points},
          {"rms_m", found.rms_m},
          {"misfit", found.misfit},
          {"normal", {found.normal.x(), found.normal.y(), found.normal.z()}},
          {"offset_m", found.offset_m},
          {"offset_sigma_m", std::sqrt(found.covariance(12, 12))}};
}

ordered_json calibrate_light_plane_files(const Files& files, const std::string& output,
                                         const Arguments& arguments, Console& console) {
  const Board board = board_of(arguments, console);
  if (arguments.camera.empty())
    throw Error(Trouble::usage, "--camera: is missing, a camera.json of scan calibrate camera");
  const auto [boards, stripes] = halves(files, "as many of stripes as of boards are needed");
  console.log(std::to_string(boards.size()) + " boards, from " + boards.front() + " with stripe " +
              stripes.front() + " to " + boards.back() + " with " + stripes.back());
  const CameraSetup camera = read_camera_calibration(arguments.camera);
  if (!camera.sensor)
    console.warn(arguments.camera +
                 ": holds no \"sensor\"; one electron a digital number is taken, so that the "
                 "points' noise is a guess");
  LaserLineSetup setup{{.camera = camera.camera, .sensor = camera.sensor.value_or(Sensor{})},
                       steps_of(arguments.steps)};
  const auto seen = find_boards(boards, board);
  std::vector<StripeOnBoard> places;
  for (std::size_t i = 0; i < seen.size(); ++i)
    places.push_back(
        {seen[i], find_stripe_pixels(read_grey16(stripes[i]), setup.calibration.sensor)});
  const LightPlaneCalibration found =
      calibrate_light_plane(board, camera.camera, camera.covariance, places);
  setup.calibration.plane_normal = found.normal;
  setup.calibration.plane_offset_m = found.offset_m;
  ordered_json pictures = pictures_json(boards, found.pictures, console);
  write_json(output, calibration_json(setup, found));
  console.say(output + ": " + std::to_string(found.points) + " points, rms " +
              readable_length(found.rms_m) + " from the plane, misfit " + rounded(found.misfit, 2));
  ordered_json result = plane_figures(found, console);
  result["pictures"] = std::move(pictures);
  return result;
}

int calibrate_files(const Arguments& arguments, Console& console) {
  const auto [inputs, output] = split_output(arguments.paths);
  check_output(output);
  if (!output.ends_with(".json"))
    throw Error(Trouble::usage, output + ": the calibration is written last, as a .json file");
  const Stopwatch watch;
  ordered_json result = arguments.what == "camera"
                            ? calibrate_camera_files(inputs, output, arguments, console)
                        : arguments.what == "stereo"
                            ? calibrate_stereo_files(inputs, output, arguments, console)
                            : calibrate_light_plane_files(inputs, output, arguments, console);
  console.time("calibrate", watch.seconds());
  result["file"] = output;
  console.finish("calibrate", "ok", result);
  return 0;
}

}  // namespace

Action calibrate_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.choice("WHAT", arguments->what, {"camera", "stereo", "light-plane"}, "what is calibrated");
  line.inputs("INPUT... OUT", arguments->paths,
              "pictures of the board (stereo: all left ones, then all right ones; light-plane: all "
              "boards, then all stripes); last the calibration to write (.json)");
  line.option("--board", arguments->board,
              "inner corners, columns x rows: 10 x 7 squares have 9x6");
  line.length("--square", arguments->square_m, "side of a square");
  line.whole("--distortion", arguments->distortion, 0, 5,
             "how many of k1, k2, p1, p2, k3 are sought");
  line.option("--camera", arguments->camera, "light-plane: the camera's calibration");
  line.option("--steps", arguments->steps,
              "light-plane: poses of the camera at each step of a scan");
  line.length("--nearest", arguments->nearest_m, "stereo: least depth to look for");
  line.length("--farthest", arguments->farthest_m, "stereo: largest depth to look for");
  return [arguments](Console& console) { return calibrate_files(*arguments, console); };
}

}  // namespace scan
