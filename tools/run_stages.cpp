// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/run_stages.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_output.h"
#include "libscan/io/poses.h"
#include "libscan/io/scan_file.h"
#include "libscan/io/truth_file.h"
#include "tools/align_starts.h"
#include "tools/inputs.h"
#include "tools/pose_trace.h"
#include "tools/run_files.h"
#include "tools/surface_stage.h"
#include "tools/verify_stage.h"

namespace scan {
namespace {

using nlohmann::ordered_json;

// Enough to see how the poses come to rest; of many scans fewer steps are kept.
constexpr std::size_t least_steps = 8, most_traced_poses = 2000;

void check_is_run(const std::filesystem::path& run) {
  if (!std::filesystem::exists(recipe_path(run)))
    throw Error(Trouble::input, run.string() + ": holds no recipe.json; is it a run folder?");
}

void check_stage_ran(const std::filesystem::path& run, const char* file, const char* stage) {
  if (!std::filesystem::exists(run / file))
    throw Error(Trouble::input,
                run.string() + ": holds no " + file + "; the run ended before " + stage,
                "scan run --resume goes on with it");
}

RunResult read_result(const std::filesystem::path& run) {
  check_stage_ran(run, "poses.tum", "align was done");
  check_stage_ran(run, "surface.ply", "reconstruct was done");
  RunResult result;
  read_of_run([&] {
    result = {.scans = read_run_scans(run),
              .world_from_scan = read_run_poses(run),
              .surface = read_supported_mesh(run / "surface.ply"),
              .stated_poses = read_run_stated_poses(run)};
    if (result.world_from_scan.size() != result.scans.size())
      throw Error(Trouble::input, (run / "poses.tum").string() + ": has " +
                                      std::to_string(result.world_from_scan.size()) +
                                      " poses for " + std::to_string(result.scans.size()) +
                                      " scans");
  });
  return result;
}

std::vector<std::string> scan_files(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("scans/" + scan_name(i) + ".ply");
  return names;
}

}  // namespace

void align_run(const std::filesystem::path& run, const Recipe& recipe, Console& console) {
  const auto scans = read_run_scans(run);
  std::vector<PointCloud> clouds;
  std::vector<Pose> guesses;
  for (const Scan& scan : scans) {
    clouds.push_back(scan.cloud);
    guesses.push_back(scan.world_from_scanner_guess);
  }
  MultiviewOptions options = recipe.align;
  options.guess_sigmas = guess_sigmas(scans);
  std::vector<std::vector<Pose>> joint;
  options.on_round = [&](std::span<const Pose> found) {
    joint.emplace_back(found.begin(), found.end());
  };
  const MultiviewResult result = align_scans(clouds, guesses, options, console.progress());
  console.time("align", result.cost.seconds);
  std::vector<NamedPose> poses;
  for (std::size_t i = 0; i < scans.size(); ++i)
    poses.push_back({scan_name(i), result.scans[i].world_from_scan});
  write_json(run / "alignment.json",
             alignment_json(scan_files(scans.size()), result, recipe.align.icp));
  const auto steps =
      pose_steps(guesses, result.edges, joint, static_cast<std::size_t>(options.anchor),
                 std::max(least_steps, most_traced_poses / scans.size()));
  write_json(run / "pose_trace.json", trace_json(steps));
  write_poses_tum(run / "poses.tum", poses);
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (!tell_of_pose("scan " + scan_name(i), result.scans[i], console))
      throw Error(Trouble::computation, "scan " + scan_name(i) + " could not be aligned: " +
                                            std::string(name_of(result.scans[i].stop)));
}

void reconstruct_run(const std::filesystem::path& run, const Recipe& recipe, Console& console) {
  const std::vector<Scan> scans = read_run_scans(run);
  const std::vector<Pose> poses = read_run_poses(run);
  const SurfaceResult result =
      make_surface(joined(scans, poses), joined_viewpoints(scans, poses),
                   common_errors(scans, read_run_stated_poses(run)), recipe.reconstruct, console);
  write_supported_mesh(run / "surface.ply", supported(result));
  write_json(run / "reconstruction.json", surface_json(result));
}

Verdict verify_run(const std::filesystem::path& run, Console&) {
  check_is_run(run);
  check_stage_ran(run, "truth", "simulate was done");
  const Recipe recipe = read_recipe(recipe_path(run));
  Truth truth;
  read_of_run([&] { truth = read_truth(truth_path(run)); });
  RunResult result = read_result(run);
  result.anchor = static_cast<std::size_t>(recipe.align.anchor);
  Verdict verdict = judge(measure_run(result, truth, recipe.verify), recipe.limits);
  write_json(run / "verdict.json", verdict_json(verdict));
  return verdict;
}

}  // namespace scan
