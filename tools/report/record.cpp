// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/record.h"

#include <initializer_list>

#include "libscan/core/error.h"
#include "libscan/io/surface_file.h"
#include "libscan/io/truth_file.h"
#include "libscan/verify/surface_error.h"
#include "tools/run_files.h"
#include "tools/verify_stage.h"

namespace scan {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json read_part(const fs::path& path) {
  try {
    return read_ordered_json(path);
  } catch (const Error& error) {
    const bool is_recipe = path.filename() == "recipe.json";  // without it nothing goes on
    throw Error(
        error.trouble(), error.what(),
        std::string("was the run cut short? scan run ") +
            (is_recipe ? "--force begins anew" : "--resume goes on with it, --force begins anew"));
  }
}

// Null, and a sentence in `missing`, if the file is not there.
ordered_json part_if_there(const fs::path& path, const std::string& tells, RunRecord& record) {
  if (fs::exists(path)) return read_part(path);
  record.missing.push_back(path.filename().string() + " is not there: " + tells);
  return nullptr;
}

// Of a file that holds each of these keys.
ordered_json optional_part(const fs::path& named, const fs::path& usual,
                           std::initializer_list<const char*> keys) {
  const fs::path path = named.empty() ? usual : named;
  if (named.empty() && !fs::exists(usual)) return nullptr;
  const ordered_json part = read_ordered_json(path);  // no stage of the run makes it
  for (const char* key : keys)
    if (!part.is_object() || !part.contains(key))
      throw Error(Trouble::input,
                  path.string() + ": is no such file: must hold " + std::string(key));
  return part;
}

void check_shape(const fs::path& run, const RunRecord& record) {
  const auto broken = [&](const char* file, const char* must) {
    throw Error(Trouble::input, (run / file).string() + ": is no such file: " + must);
  };
  const ordered_json& verdict = record.verdict;
  if (!verdict.is_null() &&
      !(verdict.is_object() && verdict.contains("measurements") && verdict.contains("pass")))
    broken("verdict.json", "must hold measurements and pass");
  if (!record.alignment.is_null() &&
      !(record.alignment.is_object() && record.alignment.contains("scans")))
    broken("alignment.json", "must hold scans");
  if (!record.effects.is_null() && !record.effects.is_array())
    broken("effects.json", "must be a list");
}

void read_scans(const fs::path& run, RunRecord& record) {
  if (!fs::exists(scan_path(run, 0)))
    return record.missing.push_back("scans/000.ply is not there: no points to show");
  record.scans = read_run_scans(run);
  if (!fs::exists(run / "poses.tum"))
    return record.missing.push_back("poses.tum is not there: the scans were not aligned");
  record.world_from_scan = read_run_poses(run);
  if (record.world_from_scan.size() != record.scans.size())
    throw Error(Trouble::input, (run / "poses.tum").string() + ": has " +
                                    std::to_string(record.world_from_scan.size()) + " poses for " +
                                    std::to_string(record.scans.size()) + " scans");
}

void read_steps(const fs::path& run, RunRecord& record) {
  if (!fs::exists(run / "pose_trace.json")) return;
  const ordered_json trace = read_part(run / "pose_trace.json");
  record.steps = steps_from(trace);
  for (const PoseStep& step : record.steps)
    if (step.world_from_scan.size() != record.scans.size())
      throw Error(Trouble::input, (run / "pose_trace.json").string() + ": step " + step.step +
                                      " has " + std::to_string(step.world_from_scan.size()) +
                                      " poses for " + std::to_string(record.scans.size()) +
                                      " scans");
}

void move_world(const Pose& new_from_old, RunRecord& record) {
  record.surface = transformed(new_from_old, record.surface);
  for (Pose& pose : record.world_from_scan) pose = new_from_old * pose;
  for (PoseStep& step : record.steps)
    for (Pose& pose : step.world_from_scan) pose = new_from_old * pose;
}

// Into the true world; deviations where there is a surface.
void hold_against_truth(const fs::path& run, RunRecord& record) {
  if (!fs::exists(truth_path(run)))
    return record.missing.push_back("truth is not there: no deviation can be told");
  if (record.world_from_scan.empty()) return;
  const Truth truth = read_truth(truth_path(run));
  if (truth.scans.size() != record.scans.size())
    throw Error(Trouble::input, truth_path(run).string() + ": knows " +
                                    std::to_string(truth.scans.size()) + " scans of " +
                                    std::to_string(record.scans.size()));
  const RunResult result{.scans = record.scans, .world_from_scan = record.world_from_scan};
  record.pose_errors = run_pose_errors(result, truth);
  move_world(true_world_from_world(result, truth), record);
  if (!record.surface.empty())
    record.deviations_m = deviations_m(record.surface.vertices, truth.surface);
}

void read_parts(const fs::path& run, RunRecord& record) {
  read_scans(run, record);
  if (!record.world_from_scan.empty()) read_steps(run, record);
  if (fs::exists(run / "surface.ply")) {
    SupportedMesh surface = read_supported_mesh(run / "surface.ply");
    record.surface = std::move(surface.mesh);
    record.support_m = std::move(surface.support_m);
  } else {
    record.missing.push_back("surface.ply is not there: no map of deviations can be drawn");
  }
  hold_against_truth(run, record);
}

}  // namespace

RunRecord read_record(const fs::path& run, const fs::path& artefacts, const fs::path& tradeoff) {
  if (!fs::exists(recipe_path(run)))
    throw Error(Trouble::input, run.string() + ": holds no recipe.json; is it a run folder?");
  RunRecord record;
  record.recipe = read_part(recipe_path(run));
  record.title = record.recipe.value("name", run.filename().string());
  record.effects = part_if_there(run / "effects.json", "the effects are unknown", record);
  record.alignment = part_if_there(run / "alignment.json", "the scans were not aligned", record);
  record.reconstruction =
      part_if_there(run / "reconstruction.json", "no surface was reconstructed", record);
  record.verdict = part_if_there(run / "verdict.json", "nothing was verified", record);
  record.timings = part_if_there(run / "timings.json", "what it cost is unknown", record);
  record.artefacts = optional_part(artefacts, run / "artefacts.json", {"measurements"});
  record.tradeoff =
      optional_part(tradeoff, run / "tradeoff.json", {"figure", "unit", "runs", "cases"});
  check_shape(run, record);
  read_of_run([&] { read_parts(run, record); });
  return record;
}

}  // namespace scan
