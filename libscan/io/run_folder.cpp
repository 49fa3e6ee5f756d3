// SPDX-FileCopyrightText: 2026 The libscan authors
// SPDX-License-Identifier: Apache-2.0
#include "libscan/io/run_folder.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "libscan/core/error.h"
#include "libscan/io/atomic_file.h"
#include "libscan/io/json_reader.h"

namespace scan {
namespace {

constexpr const char* record_name = "stages.json";
constexpr std::array<const char*, 20> run_names = {record_name,
                                                   "recipe.json",
                                                   "effects.json",
                                                   "simulation",
                                                   "simulation.json",
                                                   "timings",
                                                   "timings.json",
                                                   "scans",
                                                   "raw",
                                                   "truth",
                                                   "poses.tum",
                                                   "alignment.json",
                                                   "aligned.ply",
                                                   "pose_trace.json",
                                                   "surface.ply",
                                                   "reconstruction.json",
                                                   "verdict.json",
                                                   "report.html",
                                                   "report.json",
                                                   "report.csv"};

bool holds_run(const std::filesystem::path& path) {
  return std::any_of(run_names.begin(), run_names.end(),
                     [&](const char* name) { return std::filesystem::exists(path / name); });
}

void remove_run(const std::filesystem::path& path) {
  for (const char* name : run_names) {
    std::error_code error;
    std::filesystem::remove_all(path / name, error);
    if (error)
      throw Error(Trouble::output,
                  (path / name).string() + ": cannot be removed: " + error.message());
  }
}

std::vector<StageRecord> read_records(const std::filesystem::path& path) {
  std::vector<StageRecord> records;
  if (!std::filesystem::exists(path)) return records;
  const nlohmann::json document = read_json(path);
  JsonReader reader(document, path.string());
  for (JsonReader& entry : reader.objects("stages")) {
    StageRecord& record = records.emplace_back();
    record.stage = entry.text("stage");
    record.inputs = entry.text("inputs");
    JsonReader outputs = entry.object("outputs");
    for (const std::string& file : outputs.keys()) record.outputs[file] = outputs.text(file);
    entry.finish();
  }
  reader.finish();
  return records;
}

void write_records(const RunFolder& folder) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::array();
  for (const StageRecord& record : folder.stages)
    stages.push_back(
        {{"stage", record.stage}, {"inputs", record.inputs}, {"outputs", record.outputs}});
  const nlohmann::ordered_json document = {{"stages", stages}};
  write_file(folder.path / record_name, document.dump(1) + "\n");
}

bool is_unchanged(const std::filesystem::path& path, const std::string& hash) {
  return std::filesystem::is_regular_file(path) && fingerprint(read_file(path)) == hash;
}

}  // namespace

RunFolder open_run_folder(const std::filesystem::path& path, RunStart start) {
  make_folder(path);
  if (::access(path.c_str(), R_OK | W_OK | X_OK) != 0)
    throw Error(Trouble::output, path.string() + ": this folder cannot be written");
  if (start == RunStart::fresh && holds_run(path))
    throw Error(Trouble::output, path.string() + ": holds an earlier run",
                "--resume continues it, --force replaces it");
  if (start == RunStart::force) remove_run(path);
  return {path, read_records(path / record_name)};
}

bool is_done(const RunFolder& folder, std::string_view stage, std::string_view inputs) {
  const auto record = std::find_if(folder.stages.begin(), folder.stages.end(),
                                   [&](const StageRecord& r) { return r.stage == stage; });
  if (record == folder.stages.end() || record->inputs != inputs) return false;
  return std::all_of(record->outputs.begin(), record->outputs.end(), [&](const auto& output) {
    return is_unchanged(folder.path / output.first, output.second);
  });
}

void record_stage(RunFolder& folder, std::string_view stage, std::string_view inputs,
                  const std::vector<std::string>& outputs) {
  StageRecord record{std::string(stage), std::string(inputs), {}};
  for (const std::string& file : outputs)
    record.outputs[file] = fingerprint(read_file(folder.path / file));
  const auto earlier = std::find_if(folder.stages.begin(), folder.stages.end(),
                                    [&](const StageRecord& r) { return r.stage == stage; });
  folder.stages.erase(earlier, folder.stages.end());
  folder.stages.push_back(std::move(record));
  write_records(folder);
}

}  // namespace scan
