// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
// scan verify: figures against the truth, and the verdict.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/image_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/truth_file.h"
#include "libscan/verify/disparity_error.h"
#include "libscan/verify/pose_error.h"
#include "libscan/verify/surface_error.h"
#include "tools/artefact_stage.h"
#include "tools/commands.h"
#include "tools/inputs.h"
#include "tools/left_out.h"
#include "tools/report/picture.h"
#include "tools/run_stages.h"
#include "tools/verdict_text.h"
#include "tools/verify_stage.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  std::string measured, truth;
  std::string poses, true_poses;
  double threshold_m = 0;
  double doffs_px = 0;
  std::string limits;
  std::string picture;
  bool artefacts = false;
};

bool is_disparity(const std::string& path) {
  return std::filesystem::path(path).extension() == ".pfm";
}

// The poses of both files by name, or by order, with a warning, when the names do not match.
std::pair<std::vector<Pose>, std::vector<Pose>> matched_poses(const Arguments& arguments,
                                                              Console& console) {
  const auto estimated = read_poses(arguments.poses), truth = read_poses(arguments.true_poses);
  const auto stem = [](const std::string& name) {
    return std::filesystem::path(name).stem().string();
  };
  std::vector<Pose> a, b;
  for (const NamedPose& pose : estimated)
    for (const NamedPose& true_pose : truth)
      if (stem(pose.name) == stem(true_pose.name)) {
        a.push_back(pose.pose);
        b.push_back(true_pose.pose);
      }
  if (a.size() == estimated.size()) return {a, b};
  if (estimated.size() != truth.size())
    throw Error(Trouble::input, arguments.true_poses + ": has " + std::to_string(truth.size()) +
                                    " poses for " + std::to_string(estimated.size()) + " in " +
                                    arguments.poses + ", and the names do not match");
  console.warn(arguments.true_poses + ": its names are not those of " + arguments.poses +
               "; taken in their order (alignment.json has the scans' names)");
  a.clear(), b.clear();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    a.push_back(estimated[i].pose);
    b.push_back(truth[i].pose);
  }
  return {a, b};
}

// Pose errors, felt at the corners of the measured surface's box as each scanner saw it.
std::vector<Measurement> measure_poses(const Arguments& arguments,
                                       std::span<const Eigen::Vector3d> points_in_world,
                                       Console& console) {
  const auto [estimated, truth] = matched_poses(arguments, console);
  const auto targets = corners_of(bounds_of(points_in_world));
  std::vector<std::vector<Eigen::Vector3d>> felt;
  for (const Pose& world_from_scanner : truth) {
    auto& points = felt.emplace_back();
    for (const Eigen::Vector3d& target : targets)
      points.push_back(world_from_scanner.inverse() * target);
  }
  auto figures = summarise(pose_errors(estimated, truth, felt));
  add(figures, summarise_relative(relative_pose_errors(estimated, truth, felt)));
  add(figures, target_registration_error(estimated, truth, felt, targets));
  return figures;
}

void write_picture(const std::string& path, const Mesh& mesh, const TrueSurface& truth) {
  const auto deviations = deviations_m(mesh.vertices, truth);
  write_png(path, contact_sheet(
                      Portrait(mesh, deviations, deviation_limit_m(deviations)).six_views(400)));
}

std::vector<Measurement> measure_disparity(const Arguments& arguments) {
  const Image<float> measured = read_float_image(arguments.measured);
  const Image<float> truth = read_float_image(arguments.truth);
  auto measurements = disparity_error(measured, truth, arguments.doffs_px);
  if (!arguments.picture.empty()) write_png(arguments.picture, disparity_sheet(measured, truth));
  return measurements;
}

// Mesh programs write clouds with an empty list of faces; a surface that came out empty has none
// either, and must not be judged by what is left of it.
void tell_of_no_face(const std::string& path, Console& console) {
  if (is_emptied_surface(path))
    throw Error(Trouble::input, path + ": is a surface without a face (element face 0)");
  if (lists_no_face(path))
    console.warn(path + ": lists no face (element face 0); its points are measured, as a cloud");
}

std::vector<Measurement> measure_files(const Arguments& arguments, Console& console) {
  if (is_disparity(arguments.measured)) return measure_disparity(arguments);
  tell_of_no_face(arguments.measured, console);
  if (lists_no_face(arguments.truth))
    throw Error(Trouble::input, arguments.truth + ": holds no triangle",
                "the truth must be a surface; a cloud can only be measured");
  const TrueSurface truth = read_true_surface(arguments.truth);
  for (const Mesh& mesh : truth.meshes) warn_of_flat_triangles(arguments.truth, mesh, console);
  warn_of_holes(arguments.truth, truth, console);
  const SurfaceErrorOptions options{.f_score_threshold_m = arguments.threshold_m};
  std::vector<Measurement> measurements;
  std::vector<Eigen::Vector3d> points;
  if (holds_triangles(arguments.measured)) {
    const SupportedMesh surface = read_supported_mesh(arguments.measured);
    warn_of_flat_triangles(arguments.measured, surface.mesh, console);
    measurements = surface_error(surface.mesh, truth, options);
    add(measurements, measure_shape(surface, truth));
    if (!arguments.picture.empty()) write_picture(arguments.picture, surface.mesh, truth);
    points = surface.mesh.vertices;
  } else {
    if (!arguments.picture.empty())
      throw Error(Trouble::usage, "--picture: is for a mesh or a disparity");
    const Scan scan = read_scan(arguments.measured);
    warn_of_lost_points(arguments.measured, scan, console);
    measurements = cloud_error(scan.cloud, truth, options);
    points = scan.cloud.points;
  }
  warn_of_other_frame(arguments.measured, bounds_of(points), bounds_of(truth), console);
  if (!arguments.poses.empty()) add(measurements, measure_poses(arguments, points, console));
  return measurements;
}

ordered_json sheet_json(const std::vector<SheetLine>& sheet, const Verdict& verdict) {
  ordered_json json = verdict_json(verdict);
  for (auto& measurement : json.at("measurements"))
    for (const SheetLine& line : sheet)
      if (line.measured.name == measurement.at("name"))
        measurement["predicted"] = line.predicted
                                       ? ordered_json{line.predicted->low, line.predicted->high}
                                       : ordered_json();
  return json;
}

// The data sheet of a recipe's scanner, one line a figure.
int verify_artefacts(const Arguments& arguments, Console& console) {
  const Stopwatch watch;
  const Recipe recipe = read_recipe(arguments.measured);
  const auto sheet = artefact_sheet(recipe, console);
  std::vector<Measurement> measured;
  for (const SheetLine& line : sheet) measured.push_back(line.measured);
  const Verdict verdict = judge(std::move(measured), recipe.artefact_limits);
  console.time("verify", watch.seconds());
  const ordered_json json = sheet_json(sheet, verdict);
  say_verdict(json, console);
  console.finish("verify", verdict.pass ? "ok" : "failed", json);
  return verdict.pass ? 0 : 1;
}

// What was asked for and would be passed over.
void refuse_unused(const Arguments& arguments) {
  const auto refuse = [](bool is_given, const char* option, const char* why) {
    if (is_given) throw Error(Trouble::usage, std::string(option) + ": " + why);
  };
  if (arguments.artefacts || std::filesystem::is_directory(arguments.measured)) {
    const char* why = "is for files; a run folder and --artefacts have it from their recipe";
    refuse(!arguments.truth.empty(), "--truth", why);
    refuse(!arguments.limits.empty(), "--limits", why);
    refuse(!arguments.poses.empty(), "--poses", why);
    refuse(!arguments.true_poses.empty(), "--true-poses", why);
    refuse(arguments.threshold_m > 0, "--threshold", why);
    refuse(!arguments.picture.empty(), "--picture", "is for a mesh or a disparity");
  }
  refuse(arguments.doffs_px != 0 && !is_disparity(arguments.measured), "--doffs",
         "is for a disparity (.pfm)");
}

int verify(const Arguments& arguments, Console& console) {
  refuse_unused(arguments);
  if (!arguments.picture.empty()) {
    check_output(arguments.picture);
    if (std::filesystem::path(arguments.picture).extension() != ".png")
      throw Error(Trouble::output, "--picture: " + arguments.picture + ": must end in .png");
  }
  if (std::filesystem::is_directory(arguments.truth))
    throw Error(Trouble::input, arguments.truth + ": is a folder, --truth must be a file",
                "of a run it is truth/surface.json");
  if (arguments.artefacts) return verify_artefacts(arguments, console);
  const Stopwatch watch;
  const bool is_run = std::filesystem::is_directory(arguments.measured);
  Verdict verdict;
  if (is_run) {
    verdict = verify_run(arguments.measured, console);
  } else {
    if (!std::filesystem::exists(arguments.measured))
      throw Error(Trouble::input, arguments.measured + ": no such file or folder");
    if (arguments.truth.empty())
      throw Error(Trouble::usage, "--truth is needed unless MEASURED is a run folder");
    if (arguments.poses.empty() != arguments.true_poses.empty())
      throw Error(Trouble::usage, "--poses and --true-poses go together");
    const auto source =
        is_disparity(arguments.measured) ? FigureSource::disparity : FigureSource::surface_or_run;
    const auto limits =
        arguments.limits.empty() ? std::vector<Limit>{} : read_limits(arguments.limits, source);
    verdict = judge(measure_files(arguments, console), limits);
  }
  console.time("verify", watch.seconds());
  ordered_json json = verdict_json(verdict);
  if (is_run) tell_left_out(arguments.measured, json, console);
  say_verdict(json, console);
  console.finish("verify", verdict.pass ? "ok" : "failed", json);
  return verdict.pass ? 0 : 1;
}

}  // namespace

Action verify_command(CommandLine& line) {
  auto arguments = std::make_shared<Arguments>();
  line.input(
      "MEASURED", arguments->measured,
      "a mesh, a cloud (also a PLY with `element face 0`), a disparity (.pfm), a run folder, or "
      "a recipe with --artefacts");
  line.option("--truth", arguments->truth,
              "the reference: a mesh, a run's truth/surface.json, or a disparity");
  line.option("--poses", arguments->poses, "estimated poses");
  line.option("--true-poses", arguments->true_poses, "the poses they are held against");
  line.flag("--artefacts", arguments->artefacts,
            "scan the recipe's calibrated bodies and write its scanner's data sheet");
  line.length("--threshold", arguments->threshold_m,
              "distance that counts as right in the F-score");
  line.number("--doffs", arguments->doffs_px, -1e6, 1e6,
              "disparity: difference of the principal points in px, for the depth error");
  line.option("--limits", arguments->limits, "JSON list of limits, as in a recipe");
  line.option("--picture", arguments->picture,
              "six views coloured by deviation; disparity: it, the truth, the error (.png)");
  return [arguments](Console& console) { return verify(*arguments, console); };
}

}  // namespace scan
